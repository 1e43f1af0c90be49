// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a layer as words, lowest bit first, and the boundary of a volume within a row: of 64
// voxels at once those that are solid and have a face neighbor that is not.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "slicer/layers/run_layer.h"

namespace binderjet {

using RowBits = std::vector<std::uint64_t>;

inline std::size_t row_words(int width) { return static_cast<std::size_t>(width) / 64 + 1; }

// Sets `bits` to the row; rows and layers that are not there are powder.
inline void fill_row(const RunLayer* layer, int y, RowBits& bits) {
  std::fill(bits.begin(), bits.end(), 0);
  if (layer == nullptr) return;
  const std::span<const int> flips = layer->row(y);
  for (std::size_t i = 0; i + 1 < flips.size(); i += 2) {
    const auto first = static_cast<unsigned>(flips[i]);
    const auto last = static_cast<unsigned>(flips[i + 1]);  // one behind
    const std::uint64_t head = ~std::uint64_t{0} << (first % 64);
    const std::uint64_t tail = (std::uint64_t{1} << (last % 64)) - 1;
    if (first / 64 == last / 64) {
      bits[first / 64] |= head & tail;
      continue;
    }
    bits[first / 64] |= head;
    for (std::size_t w = first / 64 + 1; w < last / 64; ++w) bits[w] = ~std::uint64_t{0};
    bits[last / 64] |= tail;
  }
}

// One row with the four that touch it by a face.
struct RowNeighborhood {
  explicit RowNeighborhood(int width)
      : here(row_words(width)), left(here), right(here), below(here), above(here) {}

  // `under` and `over` are the layers below and above; null is powder.
  void fill(const RunLayer* under, const RunLayer& layer, const RunLayer* over, int y) {
    fill_row(&layer, y, here);
    fill_row(&layer, y - 1, left);
    fill_row(&layer, y + 1, right);
    fill_row(under, y, below);
    fill_row(over, y, above);
  }

  // The solid bits of word `w` with a face neighbor that is not.
  std::uint64_t boundary(std::size_t w) const {
    const std::uint64_t bits = here[w];
    if (bits == 0) return 0;
    const std::uint64_t before = bits << 1 | (w > 0 ? here[w - 1] >> 63 : 0);
    const std::uint64_t after = bits >> 1 | (w + 1 < here.size() ? here[w + 1] << 63 : 0);
    return bits & ~(before & after & left[w] & right[w] & below[w] & above[w]);
  }

  RowBits here, left, right, below, above;
};

// Calls use(x) for every set bit, in order.
template <class Use>
void for_each_bit(std::uint64_t bits, std::size_t word, Use use) {
  for (; bits != 0; bits &= bits - 1) {
    use(static_cast<int>(word * 64) + std::countr_zero(bits));
  }
}

}  // namespace binderjet
