// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/paper/paper_rule.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "slicer/base/vector_clones.h"
#include "slicer/enhance/paper/bit_count.h"
#include "slicer/enhance/paper/boundary_words.h"

namespace binderjet {
namespace {

using Words = DrawnBand::Words;

Slab slab(const VoxelLayer* below, const VoxelLayer& layer, const VoxelLayer* above) {
  Slab out{below == nullptr ? nullptr : &below->slices.back()};
  for (const RunLayer& slice : layer.slices) out.push_back(&slice);
  out.push_back(above == nullptr ? nullptr : &above->slices.front());
  return out;
}

// Sums over 3 x 3 voxels of one slice, for the rows of a tile, as numbers of four bit planes.
struct Sums {
  std::array<std::array<std::uint64_t, kTileRows>, 4> plane;
};

BINDERJET_VECTOR_CLONES void sum_3x3(const Words& words, Sums& sums) {
  for (std::size_t r = 0; r < kTileRows; ++r) {
    const auto above = bits::add_neighbors(words[r]);
    const auto middle = bits::add_neighbors(words[r + 1]);
    const auto under = bits::add_neighbors(words[r + 2]);
    const auto sum = bits::add3(above, middle, under);
    for (std::size_t p = 0; p < 4; ++p) sums.plane[p][r] = sum[p];
  }
}

using Toggles = std::array<std::uint64_t, kTileRows>;

// What the rule changes in one slice of a tile.
BINDERJET_VECTOR_CLONES void apply_rule(const std::array<const Sums*, 3>& printed,
                                        const std::array<const Sums*, 3>& target,
                                        const Words& below, const Words& volume, const Words& above,
                                        std::uint64_t columns, Toggles& toggles) {
  const auto number = [](const Sums& sums, std::size_t r) {
    return bits::Number<4>{sums.plane[0][r], sums.plane[1][r], sums.plane[2][r], sums.plane[3][r]};
  };
  for (std::size_t r = 0; r < kTileRows; ++r) {
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
    for (int y = 0; y < height_; y += kTileRows) {
      run_band(y);
      for (std::size_t s = 0; s < rz_; ++s) append_band(s, y, out.slices[s]);
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
    changed_.assign(rz_, 0);
    for (std::size_t tile = 0; tile < tiles_->size(); ++tile) run_tile(tile);
  }

  void run_tile(std::size_t tile) {
    for (std::size_t s = 0; s < target_.size(); ++s) {
      const DrawnBand& bits = target_[s] == volume_[s] ? volume_bits_[s] : target_bits_[s];
      sum_3x3(bits[tile], target_sums_[s]);
    }
    for (std::size_t k = 0; k < 3; ++k) sum_3x3(printed_bits_[k][tile], printed_sums_[k]);
    const int columns = std::min(kTileColumns, width_ - (*tiles_)[tile]);
    const std::uint64_t core = columns <= 0 ? 0 : (~std::uint64_t{0} >> (64 - columns)) << 1;
    for (std::size_t s = 1; s <= rz_; ++s) {
      // All slices of a layer print alike; only the outermost see another layer.
      const std::array<const Sums*, 3> printed = {&printed_sums_[s == 1 ? 0 : 1], &printed_sums_[1],
                                                  &printed_sums_[s == rz_ ? 2 : 1]};
      Toggles& toggles = toggles_[tile * rz_ + s - 1];
      apply_rule(printed, {&target_sums_[s - 1], &target_sums_[s], &target_sums_[s + 1]},
                 volume_bits_[s - 1][tile], volume_bits_[s][tile], volume_bits_[s + 1][tile], core,
                 toggles);
      for (std::size_t r = 0; r < kTileRows; ++r) {
        changed_[s - 1] |= std::uint32_t{toggles[r] != 0} << r;
      }
    }
  }

  // The rows of V from `y` on with their changes.
  void append_band(std::size_t s, int y, RunLayer& out) const {
    const int last = std::min(height_, y + kTileRows);
    for (int row = y; row < last;) {
      const auto changed = static_cast<unsigned>(row - y);
      const int same =
          std::min(last - row, std::countr_zero(std::uint64_t{changed_[s]} >> changed));
      out.append_rows(*volume_[s + 1], row, row + same);
      row += same;
      if (row < last) append_toggled(s, row, static_cast<std::size_t>(row - y), out);
      ++row;
    }
  }

  // The exclusive or of two ascending lists of flips.
  void append_toggled(std::size_t s, int row, std::size_t r, RunLayer& out) const {
    const std::span<const int> flips = volume_[s + 1]->row(row);
    std::size_t next = 0;
    const auto flip = [&](int x) {
      while (next < flips.size() && flips[next] <= x) out.flip(flips[next++]);
      out.flip(x);
    };
    for (std::size_t tile = 0; tile < tiles_->size(); ++tile) {
      std::uint64_t word = toggles_[tile * rz_ + s][r];
      const int x = (*tiles_)[tile] - 1;
      while (word != 0) {
        // Adding the lowest bit carries through the lowest run of ones.
        const std::uint64_t after = word + (word & (~word + 1));
        flip(x + std::countr_zero(word));
        flip(x + std::countr_zero(after));
        word &= after;
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
  std::vector<Toggles> toggles_;  // of each active tile, its rz slices
  // Of each slice the rows that any tile toggles, a bit each.
  static_assert(kTileRows == 32);
  std::vector<std::uint32_t> changed_;
};

}  // namespace

VoxelLayer paper_rule(const PassLayer* below, const PassLayer& layer, const PassLayer* above) {
  return LayerRule(below, layer, above).run();
}

}  // namespace binderjet
