// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/paper_rule.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "slicer/enhance/bit_count.h"

namespace binderjet {
namespace {

// The rule runs on tiles, one 64-bit word a row: 62 columns and one on each side, 64 rows and one
// above and below. Only tiles that hold boundary voxels of V are drawn, so the cost is the
// boundary's.
constexpr int kColumns = 62;
constexpr int kRows = 64;
constexpr int kDrawnRows = kRows + 2;
using Words = std::array<std::uint64_t, kDrawnRows>;

// Columns [x, x + 64) of a row as bits, column x in the lowest.
std::uint64_t draw(std::span<const int> row, int x) {
  const auto next = std::upper_bound(row.begin(), row.end(), x);
  std::uint64_t word = (next - row.begin()) % 2 == 1 ? ~std::uint64_t{0} : 0;
  for (auto flip = next; flip != row.end() && *flip < x + 64; ++flip) {
    word ^= ~std::uint64_t{0} << (*flip - x);
  }
  return word;
}

void draw(const RunLayer* layer, int x, int y, Words& words) {
  if (layer == nullptr) {
    words.fill(0);
    return;
  }
  for (int r = 0; r < kDrawnRows; ++r) {
    words[static_cast<std::size_t>(r)] = draw(layer->row(y + r), x);
  }
}

// The slices of a layer and one slice below and above: [0] is below, [rz + 1] above.
using Slab = std::vector<const RunLayer*>;

Slab slab(const VoxelLayer* below, const VoxelLayer& layer, const VoxelLayer* above) {
  Slab out{below == nullptr ? nullptr : &below->slices.back()};
  for (const RunLayer& slice : layer.slices) out.push_back(&slice);
  out.push_back(above == nullptr ? nullptr : &above->slices.front());
  return out;
}

// Which tiles of a band of rows hold boundary voxels.
class ActiveTiles {
 public:
  explicit ActiveTiles(int width) : active_(static_cast<std::size_t>(width / kColumns) + 1) {}

  void clear() { std::fill(active_.begin(), active_.end(), false); }
  bool operator[](std::size_t tile) const { return active_[tile]; }
  std::size_t size() const { return active_.size(); }

  void mark_ends(std::span<const int> row) {
    for (const int flip : row) mark(flip - 1, flip);
  }
  // Where two rows differ. Each row is the exclusive or of the half-lines from its flips, so the
  // difference lies between flips of the same rank; what one row has more is taken as one.
  void mark_difference(std::span<const int> a, std::span<const int> b) {
    const std::size_t both = std::min(a.size(), b.size());
    for (std::size_t i = 0; i < both; ++i) {
      if (a[i] != b[i]) mark(std::min(a[i], b[i]), std::max(a[i], b[i]) - 1);
    }
    const std::span<const int> rest = (a.size() > both ? a : b).subspan(both);
    if (!rest.empty()) mark(rest.front(), rest.back() - 1);
  }

 private:
  void mark(int first, int last) {
    const int last_tile = std::min(last / kColumns, static_cast<int>(active_.size()) - 1);
    for (int tile = std::max(first, 0) / kColumns; tile <= last_tile; ++tile) {
      active_[static_cast<std::size_t>(tile)] = true;
    }
  }

  std::vector<char> active_;
};

// Sums over 3 x 3 voxels of one slice, for the rows of a tile, as numbers of four bit planes.
struct Sums {
  std::array<std::array<std::uint64_t, kRows>, 4> plane;
};

void sum_3x3(const Words& words, Sums& sums) {
  for (std::size_t r = 0; r < kRows; ++r) {
    const auto above = bits::add_neighbors(words[r]);
    const auto middle = bits::add_neighbors(words[r + 1]);
    const auto under = bits::add_neighbors(words[r + 2]);
    const auto sum = bits::add3(above, middle, under);
    for (std::size_t p = 0; p < 4; ++p) sums.plane[p][r] = sum[p];
  }
}

using Toggles = std::array<std::uint64_t, kRows>;

// What the rule changes in one slice of a tile.
void apply_rule(const std::array<const Sums*, 3>& printed, const std::array<const Sums*, 3>& target,
                const Words& below, const Words& volume, const Words& above, std::uint64_t columns,
                Toggles& toggles) {
  const auto number = [](const Sums& sums, std::size_t r) {
    return bits::Number<4>{sums.plane[0][r], sums.plane[1][r], sums.plane[2][r], sums.plane[3][r]};
  };
  for (std::size_t r = 0; r < kRows; ++r) {
    const bits::Number<5> is =
        bits::add3(number(*printed[0], r), number(*printed[1], r), number(*printed[2], r));
    const bits::Number<5> want =
        bits::add3(number(*target[0], r), number(*target[1], r), number(*target[2], r));
    const std::uint64_t more = bits::greater(is, want);
    const std::uint64_t less = bits::greater(want, is);

    const std::uint64_t v = volume[r + 1];
    const std::uint64_t left = v << 1;
    const std::uint64_t right = v >> 1;
    const std::uint64_t all =
        left & right & volume[r] & volume[r + 2] & below[r + 1] & above[r + 1];
    const std::uint64_t any =
        left | right | volume[r] | volume[r + 2] | below[r + 1] | above[r + 1];
    toggles[r] = ((v & ~all & more) | (~v & any & less)) & columns;
  }
}

// One layer's tiles: draws them, applies the rule, and keeps what it changes.
class LayerRule {
 public:
  LayerRule(const PassLayer* below, const PassLayer& layer, const PassLayer* above)
      : volume_(slab(below == nullptr ? nullptr : below->volume.get(), *layer.volume,
                     above == nullptr ? nullptr : above->volume.get())),
        target_(slab(below == nullptr ? nullptr : below->target.get(), *layer.target,
                     above == nullptr ? nullptr : above->target.get())),
        printed_{below == nullptr ? nullptr : &below->printed, &layer.printed,
                 above == nullptr ? nullptr : &above->printed},
        rz_(layer.volume->slices.size()),
        width_(layer.printed.width()),
        height_(layer.printed.height()),
        active_(width_),
        drawn_(volume_.size()),
        target_sums_(target_.size()) {}

  VoxelLayer run() {
    VoxelLayer out;
    for (std::size_t s = 0; s < rz_; ++s) {
      out.slices.emplace_back(width_);
      out.slices.back().reserve(height_, volume_[s + 1]->flip_count());
    }
    for (int y = 0; y < height_; y += kRows) {
      run_band(y);
      for (std::size_t s = 0; s < rz_; ++s) {
        for (int row = y; row < std::min(height_, y + kRows); ++row) {
          append_toggled(s, row, static_cast<std::size_t>(row - y), out.slices[s]);
        }
      }
    }
    return out;
  }

 private:
  void run_band(int y) {
    mark_active(y);
    tiles_.clear();
    toggles_.clear();
    for (std::size_t tile = 0; tile < active_.size(); ++tile) {
      if (!active_[tile]) continue;
      tiles_.push_back(static_cast<int>(tile) * kColumns);
      run_tile(tiles_.back(), y);
    }
  }

  void mark_active(int y) {
    active_.clear();
    const auto row_of = [](const RunLayer* slice, int row) {
      return slice == nullptr ? std::span<const int>() : slice->row(row);
    };
    for (int row = y; row < std::min(height_, y + kRows); ++row) {
      for (std::size_t s = 1; s <= rz_; ++s) {
        const std::span<const int> v = volume_[s]->row(row);
        active_.mark_ends(v);
        active_.mark_difference(v, volume_[s]->row(row - 1));
        active_.mark_difference(v, volume_[s]->row(row + 1));
        active_.mark_difference(v, row_of(volume_[s - 1], row));
        active_.mark_difference(v, row_of(volume_[s + 1], row));
      }
    }
  }

  // The tile of columns [x, x + kColumns) and rows [y, y + kRows); its words begin at x - 1.
  void run_tile(int x, int y) {
    for (std::size_t s = 0; s < volume_.size(); ++s) draw(volume_[s], x - 1, y - 1, drawn_[s]);
    Words words;
    for (std::size_t s = 0; s < target_.size(); ++s) {
      draw(target_[s], x - 1, y - 1, words);
      sum_3x3(words, target_sums_[s]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      draw(printed_[k], x - 1, y - 1, words);
      sum_3x3(words, printed_sums_[k]);
    }
    const int columns = std::min(kColumns, width_ - x);
    const std::uint64_t core = columns <= 0 ? 0 : (~std::uint64_t{0} >> (64 - columns)) << 1;
    for (std::size_t s = 1; s <= rz_; ++s) {
      // All slices of a layer print alike; only the outermost see another layer.
      const std::array<const Sums*, 3> printed = {&printed_sums_[s == 1 ? 0 : 1], &printed_sums_[1],
                                                  &printed_sums_[s == rz_ ? 2 : 1]};
      toggles_.emplace_back();
      apply_rule(printed, {&target_sums_[s - 1], &target_sums_[s], &target_sums_[s + 1]},
                 drawn_[s - 1], drawn_[s], drawn_[s + 1], core, toggles_.back());
    }
  }

  // Row `row` of V with its changes: the exclusive or of two ascending lists of flips.
  void append_toggled(std::size_t s, int row, std::size_t r, RunLayer& out) const {
    const std::span<const int> flips = volume_[s + 1]->row(row);
    std::size_t next = 0;
    const auto flip = [&](int x) {
      while (next < flips.size() && flips[next] <= x) out.flip(flips[next++]);
      out.flip(x);
    };
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
      std::uint64_t word = toggles_[tile * rz_ + s][r];
      const int x = tiles_[tile] - 1;
      while (word != 0) {
        const int first = std::countr_zero(word);
        const int length = std::countr_one(word >> first);
        flip(x + first);
        flip(x + first + length);
        word &= first + length == 64 ? 0 : ~std::uint64_t{0} << (first + length);
      }
    }
    while (next < flips.size()) out.flip(flips[next++]);
    out.end_row();
  }

  Slab volume_;
  Slab target_;
  std::array<const RunLayer*, 3> printed_;
  std::size_t rz_;
  int width_;
  int height_;
  ActiveTiles active_;
  std::vector<int> tiles_;        // where the active tiles of the band begin
  std::vector<Toggles> toggles_;  // of each active tile, its rz slices
  std::vector<Words> drawn_;
  std::vector<Sums> target_sums_;
  std::array<Sums, 3> printed_sums_;
};

}  // namespace

VoxelLayer paper_rule(const PassLayer* below, const PassLayer& layer, const PassLayer* above) {
  return LayerRule(below, layer, above).run();
}

}  // namespace binderjet
