// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/layers/run_layer.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace binderjet {
namespace {

// Sets the bits [first, last) of a packed row.
void set_bits(std::byte* row, int first, int last) {
  const int first_byte = first / 8;
  const int last_byte = last / 8;
  const auto head = static_cast<std::byte>(0xff >> (first % 8));
  const auto tail = static_cast<std::byte>(0xff00 >> (last % 8));
  if (first_byte == last_byte) {
    row[first_byte] |= head & tail;
    return;
  }
  row[first_byte] |= head;
  std::memset(row + first_byte + 1, 0xff, static_cast<std::size_t>(last_byte - first_byte - 1));
  if (last % 8 != 0) row[last_byte] |= tail;
}

// Eight bytes as a number whose highest bit is the first voxel; short reads are padded with 0.
std::uint64_t load_word(const std::byte* bytes, std::size_t available) {
  std::uint64_t word = 0;
  if (available >= 8) {
    std::memcpy(&word, bytes, 8);
    if constexpr (std::endian::native == std::endian::little) word = __builtin_bswap64(word);
    return word;
  }
  for (std::size_t i = 0; i < available; ++i) {
    word |= std::to_integer<std::uint64_t>(bytes[i]) << (56 - 8 * i);
  }
  return word;
}

}  // namespace

std::size_t packed_row_bytes(int width) { return (static_cast<std::size_t>(width) + 7) / 8; }

std::vector<std::byte> pack(const RunLayer& layer) {
  const std::size_t stride = packed_row_bytes(layer.width());
  std::vector<std::byte> bits(stride * static_cast<std::size_t>(layer.height()));
  for (int y = 0; y < layer.height(); ++y) {
    const std::span<const int> row = layer.row(y);
    std::byte* out = bits.data() + stride * static_cast<std::size_t>(y);
    for (std::size_t i = 0; i < row.size(); i += 2) set_bits(out, row[i], row[i + 1]);
  }
  return bits;
}

RunLayer unpack(std::span<const std::byte> bits, int width, int height) {
  const std::size_t stride = packed_row_bytes(width);
  assert(bits.size() == stride * static_cast<std::size_t>(height));
  RunLayer layer(width);
  layer.reserve(height, 0);
  for (int y = 0; y < height; ++y) {
    const std::byte* row = bits.data() + stride * static_cast<std::size_t>(y);
    std::uint64_t state = 0;  // all ones while inside a run
    for (std::size_t offset = 0; offset < stride; offset += 8) {
      const std::uint64_t word = load_word(row + offset, stride - offset);
      std::uint64_t changes = word ^ state;
      while (changes != 0) {
        const int bit = std::countl_zero(changes);
        const int x = static_cast<int>(offset) * 8 + bit;
        if (x >= width) break;
        layer.flip(x);
        state = ~state;
        // Only what lies after this bit is still to be compared with the new state.
        const std::uint64_t rest = bit == 63 ? 0 : ~std::uint64_t{0} >> (bit + 1);
        changes = (word ^ state) & rest;
      }
    }
    if (state != 0) layer.flip(width);
    layer.end_row();
  }
  return layer;
}

RunLayer window(const RunLayer& layer, int x, int y, int width, int height) {
  RunLayer out(width);
  out.reserve(height, layer.flip_count());
  for (int row = 0; row < height; ++row) {
    for (const int flip : layer.row(y + row)) out.flip(std::clamp(flip - x, 0, width));
    out.end_row();
  }
  return out;
}

}  // namespace binderjet
