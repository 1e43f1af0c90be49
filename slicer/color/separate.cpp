// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/color/separate.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <utility>
#include <vector>

namespace binderjet {
namespace {

// Evenly spread in -1 to 1, the same wherever it is computed.
float noise(int x, int y, int salt) {
  std::uint32_t hash = static_cast<std::uint32_t>(x) * 0x9E3779B1u ^
                       static_cast<std::uint32_t>(y) * 0x85EBCA77u ^
                       static_cast<std::uint32_t>(salt) * 0xC2B2AE3Du;
  hash ^= hash >> 15;
  hash *= 0x2C1B3C6Du;
  hash ^= hash >> 12;
  hash *= 0x297A2D39u;
  hash ^= hash >> 15;
  return static_cast<float>(hash >> 8) / 8388608.0F - 1;
}

RunLayer diffuse(std::span<const std::byte> rgb, int width, int height, int channel, int salt) {
  constexpr float kThresholdNoise = 80;                   // of 255
  const auto size = static_cast<std::size_t>(width) + 2;  // one more on either side
  std::vector<float> errors(size, 0), next(size, 0);
  std::vector<bool> drops(size), was_ink(size, false), is_ink(size, false);
  RunLayer plane(width);
  for (int y = 0; y < height; ++y) {
    const std::byte* row =
        rgb.data() + 3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    const int step = y % 2 == 0 ? 1 : -1;
    for (int n = 0; n < width; ++n) {
      const int x = step > 0 ? n : width - 1 - n;
      const auto i = static_cast<std::size_t>(x) + 1;
      const std::byte level =
          row[3 * static_cast<std::size_t>(x) + static_cast<std::size_t>(channel)];
      const auto ink = static_cast<float>(255 - std::to_integer<int>(level));
      drops[i] = false;
      is_ink[i] = ink > 0;
      if (ink <= 0) continue;
      // Without a neighbor above nothing has told yet where the last drop was: chance says, with
      // the tone as its odds.
      const bool first = !was_ink[i];
      const float wanted = first ? ink + 127.5F * noise(x, y, salt + 1) : ink + errors[i];
      drops[i] = wanted > 127.5F + (first ? 0 : kThresholdNoise * noise(x, y, salt));
      const float error = wanted - (drops[i] ? 255.0F : 0.0F);
      const auto ahead = static_cast<std::size_t>(static_cast<int>(i) + step);
      const auto behind = static_cast<std::size_t>(static_cast<int>(i) - step);
      // Floyd and Steinberg's weights, shaken in pairs (Ulichney): light tones grow worms if not.
      const float most = 4.5F / 16 * noise(x, y, salt + 0x1000003);
      const float least = 1.0F / 16 * noise(x, y, salt + 0x2000003);
      errors[ahead] += error * (7.0F / 16 + most);
      next[i] += error * (5.0F / 16 - most);
      next[behind] += error * (3.0F / 16 + least);
      next[ahead] += error * (1.0F / 16 - least);
    }
    bool inside = false;
    for (int x = 0; x < width; ++x) {
      if (drops[static_cast<std::size_t>(x) + 1] == inside) continue;
      inside = !inside;
      plane.flip(x);
    }
    if (inside) plane.flip(width);
    plane.end_row();
    std::swap(errors, next);
    std::swap(was_ink, is_ink);
    std::fill(next.begin(), next.end(), 0.0F);
  }
  return plane;
}

}  // namespace

void whiten_outside(const RunLayer& mask, std::span<std::byte> rgb) {
  const auto row_bytes = 3 * static_cast<std::size_t>(mask.width());
  assert(rgb.size() == row_bytes * static_cast<std::size_t>(mask.height()));
  for (int y = 0; y < mask.height(); ++y) {
    const auto row = rgb.subspan(static_cast<std::size_t>(y) * row_bytes, row_bytes);
    std::size_t from = 0;
    const auto whiten_until = [&](std::size_t to) {
      std::fill(row.begin() + static_cast<std::ptrdiff_t>(from),
                row.begin() + static_cast<std::ptrdiff_t>(to), std::byte{255});
    };
    const std::span<const int> runs = mask.row(y);
    for (std::size_t i = 0; i + 1 < runs.size(); i += 2) {
      whiten_until(3 * static_cast<std::size_t>(runs[i]));
      from = 3 * static_cast<std::size_t>(runs[i + 1]);
    }
    whiten_until(row_bytes);
  }
}

std::array<RunLayer, 3> separate_cmy(std::span<const std::byte> rgb, int width, int height,
                                     int layer) {
  assert(rgb.size() == 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::array<RunLayer, 3> planes;
  for (int c = 0; c < 3; ++c) {
    planes[static_cast<std::size_t>(c)] = diffuse(rgb, width, height, c, 6 * layer + 2 * c);
  }
  return planes;
}

}  // namespace binderjet
