// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/paper_rule.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "slicer/enhance/bit_count.h"
#include "slicer/vector_clones.h"

namespace binderjet {
namespace {

// The rule runs on tiles, one 64-bit word a row: 62 columns and one on each side, 32 rows and one
// above and below. Only tiles that hold boundary voxels of V are drawn, so the cost is the
// boundary's.
constexpr int kColumns = 62;
constexpr int kRows = 32;
constexpr int kDrawnRows = kRows + 2;
using Words = std::array<std::uint64_t, kDrawnRows>;

// The slices of a layer and one slice below and above: [0] is below, [rz + 1] above.
using Slab = std::vector<const RunLayer*>;

Slab slab(const VoxelLayer* below, const VoxelLayer& layer, const VoxelLayer* above) {
  Slab out{below == nullptr ? nullptr : &below->slices.back()};
  for (const RunLayer& slice : layer.slices) out.push_back(&slice);
  out.push_back(above == nullptr ? nullptr : &above->slices.front());
  return out;
}

// Finds the tiles of a band of rows that hold its boundary voxels.
class ActiveTiles {
 public:
  explicit ActiveTiles(int width) : width_(width) {}

  // The first columns of the tiles, ascending; each begins where there is something to see.
  const std::vector<int>& find(const Slab& volume, int y) {
    ranges_.clear();
    for (std::size_t s = 0; s < volume.size(); ++s) {
      for (int row = y - 1; row <= y + kRows; ++row) {
        const std::span<const int> here = row_of(volume[s], row);
        widen(here);
        // Rows with as many flips differ only between flips of the same rank, and those are seen
        // to by widen; others are compared where they meet.
        const std::span<const int> before = row_of(volume[s], row - 1);
        if (row >= y && before.size() != here.size()) add_difference(before, here);
        if (s == 0) continue;
        const std::span<const int> under = row_of(volume[s - 1], row);
        if (under.size() != here.size()) add_difference(under, here);
      }
    }
    flush();
    std::sort(ranges_.begin(), ranges_.end());
    tiles_.clear();
    int covered = 0;
    for (const auto& [first, last] : ranges_) {
      for (int x = std::max(first, covered); x <= std::min(last, width_ - 1); x = covered) {
        tiles_.push_back(x);
        covered = x + kColumns;
      }
    }
    return tiles_;
  }

 private:
  static std::span<const int> row_of(const RunLayer* slice, int row) {
    return slice == nullptr ? std::span<const int>() : slice->row(row);
  }

  // Rows with the same number of flips share one range per rank.
  void widen(std::span<const int> row) {
    if (row.size() != low_.size()) {
      flush();
      low_.assign(row.begin(), row.end());
      high_ = low_;
      return;
    }
    for (std::size_t i = 0; i < row.size(); ++i) {
      low_[i] = std::min(low_[i], row[i]);
      high_[i] = std::max(high_[i], row[i]);
    }
  }
  void flush() {
    for (std::size_t i = 0; i < low_.size(); ++i) ranges_.emplace_back(low_[i] - 1, high_[i]);
    low_.clear();
    high_.clear();
  }

  // Each row is the exclusive or of the half-lines from its flips, so two rows differ only between
  // flips of the same rank; what one row has more is taken as one.
  void add_difference(std::span<const int> a, std::span<const int> b) {
    const std::size_t both = std::min(a.size(), b.size());
    for (std::size_t i = 0; i < both; ++i) {
      if (a[i] != b[i]) ranges_.emplace_back(std::min(a[i], b[i]) - 1, std::max(a[i], b[i]));
    }
    const std::span<const int> rest = (a.size() > both ? a : b).subspan(both);
    if (!rest.empty()) ranges_.emplace_back(rest.front() - 1, rest.back());
  }

  int width_;
  std::vector<std::pair<int, int>> ranges_;  // columns, first to last
  std::vector<int> tiles_;
  std::vector<int> low_;  // per rank, over the rows of the same number of flips
  std::vector<int> high_;
};

// One layer's bits under the tiles of a band, each tile's words begin one column left of it.
class DrawnBand {
 public:
  const Words& operator[](std::size_t tile) const { return words_[tile]; }

  // Rows y to y + kDrawnRows - 1; outside the layer, and for no layer, all is powder.
  void draw(const RunLayer* layer, const std::vector<int>& tiles, int y) {
    words_.resize(tiles.size());
    for (Words& words : words_) words.fill(0);
    if (layer == nullptr) return;
    const int last = std::min(kDrawnRows, layer->height() - y);
    for (int r = std::max(0, -y); r < last; ++r) {
      const std::span<const int> row = layer->row(y + r);
      std::size_t next = 0;  // the first flip right of the tile's first column
      for (std::size_t tile = 0; tile < tiles.size() && !row.empty(); ++tile) {
        const int x = tiles[tile] - 1;
        while (next < row.size() && row[next] <= x) ++next;
        std::uint64_t word = next % 2 == 1 ? ~std::uint64_t{0} : 0;
        for (std::size_t i = next; i < row.size() && row[i] < x + 64; ++i) {
          word ^= ~std::uint64_t{0} << (row[i] - x);
        }
        words_[tile][static_cast<std::size_t>(r)] = word;
      }
    }
  }

 private:
  std::vector<Words> words_;
};

// Sums over 3 x 3 voxels of one slice, for the rows of a tile, as numbers of four bit planes.
struct Sums {
  std::array<std::array<std::uint64_t, kRows>, 4> plane;
};

BINDERJET_VECTOR_CLONES void sum_3x3(const Words& words, Sums& sums) {
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
BINDERJET_VECTOR_CLONES void apply_rule(const std::array<const Sums*, 3>& printed,
                                        const std::array<const Sums*, 3>& target,
                                        const Words& below, const Words& volume, const Words& above,
                                        std::uint64_t columns, Toggles& toggles) {
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

// One layer under the rule, band by band.
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
        volume_bits_(volume_.size()),
        target_bits_(target_.size()),
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
    tiles_ = &active_.find(volume_, y);
    for (std::size_t s = 0; s < volume_.size(); ++s) {
      volume_bits_[s].draw(volume_[s], *tiles_, y - 1);
      // In the first pass the volume is the target.
      if (target_[s] != volume_[s]) target_bits_[s].draw(target_[s], *tiles_, y - 1);
    }
    for (std::size_t k = 0; k < 3; ++k) printed_bits_[k].draw(printed_[k], *tiles_, y - 1);
    toggles_.resize(tiles_->size() * rz_);
    changed_.assign(rz_ * kRows, 0);
    for (std::size_t tile = 0; tile < tiles_->size(); ++tile) run_tile(tile);
  }

  void run_tile(std::size_t tile) {
    for (std::size_t s = 0; s < target_.size(); ++s) {
      const DrawnBand& bits = target_[s] == volume_[s] ? volume_bits_[s] : target_bits_[s];
      sum_3x3(bits[tile], target_sums_[s]);
    }
    for (std::size_t k = 0; k < 3; ++k) sum_3x3(printed_bits_[k][tile], printed_sums_[k]);
    const int columns = std::min(kColumns, width_ - (*tiles_)[tile]);
    const std::uint64_t core = columns <= 0 ? 0 : (~std::uint64_t{0} >> (64 - columns)) << 1;
    for (std::size_t s = 1; s <= rz_; ++s) {
      // All slices of a layer print alike; only the outermost see another layer.
      const std::array<const Sums*, 3> printed = {&printed_sums_[s == 1 ? 0 : 1], &printed_sums_[1],
                                                  &printed_sums_[s == rz_ ? 2 : 1]};
      Toggles& toggles = toggles_[tile * rz_ + s - 1];
      apply_rule(printed, {&target_sums_[s - 1], &target_sums_[s], &target_sums_[s + 1]},
                 volume_bits_[s - 1][tile], volume_bits_[s][tile], volume_bits_[s + 1][tile], core,
                 toggles);
      for (std::size_t r = 0; r < kRows; ++r) changed_[(s - 1) * kRows + r] |= toggles[r];
    }
  }

  // Row `row` of V with its changes: the exclusive or of two ascending lists of flips.
  void append_toggled(std::size_t s, int row, std::size_t r, RunLayer& out) const {
    const std::span<const int> flips = volume_[s + 1]->row(row);
    if (changed_[s * kRows + r] == 0) {
      out.append_row(flips);
      return;
    }
    std::size_t next = 0;
    const auto flip = [&](int x) {
      while (next < flips.size() && flips[next] <= x) out.flip(flips[next++]);
      out.flip(x);
    };
    for (std::size_t tile = 0; tile < tiles_->size(); ++tile) {
      std::uint64_t word = toggles_[tile * rz_ + s][r];
      const int x = (*tiles_)[tile] - 1;
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
  const std::vector<int>* tiles_ = nullptr;  // the first columns of the band's active tiles
  std::vector<DrawnBand> volume_bits_;
  std::vector<DrawnBand> target_bits_;
  std::array<DrawnBand, 3> printed_bits_;
  std::vector<Sums> target_sums_;
  std::array<Sums, 3> printed_sums_;
  std::vector<Toggles> toggles_;        // of each active tile, its rz slices
  std::vector<std::uint64_t> changed_;  // of each slice and row, whether any tile toggles
};

}  // namespace

VoxelLayer paper_rule(const PassLayer* below, const PassLayer& layer, const PassLayer* above) {
  return LayerRule(below, layer, above).run();
}

}  // namespace binderjet
