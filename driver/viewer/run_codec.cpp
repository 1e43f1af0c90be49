// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/viewer/run_codec.h"

#include <cstdint>

namespace binderjet {
namespace {

void put_varint(std::uint32_t value, std::string& out) {
  for (; value >= 0x80; value >>= 7) out += static_cast<char>((value & 0x7f) | 0x80);
  out += static_cast<char>(value);
}

std::uint32_t zigzag(int value) {
  return static_cast<std::uint32_t>(value) << 1 ^ static_cast<std::uint32_t>(value >> 31);
}

}  // namespace

void encode_runs(const RunLayer& layer, const RunLayer& reference, std::string& out) {
  for (int y = 0; y < layer.height(); ++y) {
    const auto row = layer.row(y);
    const auto before = reference.row(y);
    if (row.size() == before.size()) {
      put_varint(0, out);
      for (std::size_t i = 0; i < row.size(); ++i) put_varint(zigzag(row[i] - before[i]), out);
      continue;
    }
    put_varint(static_cast<std::uint32_t>(row.size()) + 1, out);
    int last = 0;
    for (const int flip : row) {
      put_varint(static_cast<std::uint32_t>(flip - last), out);
      last = flip;
    }
  }
}

}  // namespace binderjet
