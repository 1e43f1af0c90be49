// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/voxels/slicing_operator.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace binderjet {
namespace {

// At `pixel` the number of 1-voxels of a pixel changes by `change`.
using Event = std::pair<int, int>;

// A run [a, b) covers its first and last pixel in part; what it covers changes at four places.
void add_events(std::span<const int> row, int rx, std::vector<Event>& events) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    const int sign = i % 2 == 0 ? 1 : -1;
    const int pixel = row[i] / rx;
    const int inside = row[i] % rx;
    events.emplace_back(pixel, sign * (rx - inside));
    if (inside != 0) events.emplace_back(pixel + 1, sign * inside);
  }
}

// The common case: all voxel rows of a pixel row have the same runs but for a slope, and no pixel
// holds the slopes of two flips. Then each flip of the mask is where the count passes half.
bool add_edges(const std::vector<std::span<const int>>& rows, int rx, int half, RunLayer& mask) {
  const std::size_t flips = rows.front().size();
  const int all = rx * static_cast<int>(rows.size());
  for (const std::span<const int>& row : rows) {
    if (row.size() != flips) return false;
  }
  int next_pixel = 0;  // in voxels, where the pixels begin that no flip has touched
  for (std::size_t i = 0; i < flips; ++i) {
    int low = rows.front()[i];
    int high = low;
    for (const std::span<const int>& row : rows) {
      low = std::min(low, row[i]);
      high = std::max(high, row[i]);
    }
    if (low < next_pixel) return false;
    next_pixel = (high / rx + 1) * rx;
  }
  for (std::size_t i = 0; i < flips; ++i) {
    // Voxels of a pixel that lie behind the flip; a run's end leaves the others.
    const int needed = i % 2 == 0 ? half : all - half + 1;
    int pixel = rows.front()[i] / rx;
    const auto behind = [&](int p) {
      int count = 0;
      for (const std::span<const int>& row : rows)
        count += std::clamp((p + 1) * rx - row[i], 0, rx);
      return count;
    };
    while (behind(pixel) < needed) ++pixel;
    while (pixel > 0 && behind(pixel - 1) >= needed) --pixel;
    mask.flip(pixel);
  }
  return true;
}

}  // namespace

RunLayer slicing_operator(const VoxelLayer& voxels, const Grid& grid) {
  const auto [rx, ry, rz] = grid.detail_vx;
  const int width_px = voxels.slices.front().width() / rx;
  const int height_px = voxels.slices.front().height() / ry;
  const int half = (rx * ry * rz + 1) / 2;

  RunLayer mask(width_px);
  mask.reserve(height_px, voxels.slices.front().flip_count() / 2);
  std::vector<std::span<const int>> rows;
  std::vector<Event> events;
  for (int j = 0; j < height_px; ++j) {
    rows.clear();
    for (const RunLayer& slice : voxels.slices) {
      for (int y = j * ry; y < (j + 1) * ry; ++y) rows.push_back(slice.row(y));
    }
    if (add_edges(rows, rx, half, mask)) {
      mask.end_row();
      continue;
    }
    events.clear();
    for (const std::span<const int>& row : rows) add_events(row, rx, events);
    std::sort(events.begin(), events.end(),
              [](const Event& a, const Event& b) { return a.first < b.first; });
    int ones = 0;
    bool solid = false;
    for (std::size_t i = 0; i < events.size();) {
      const int pixel = events[i].first;
      for (; i < events.size() && events[i].first == pixel; ++i) ones += events[i].second;
      if ((ones >= half) != solid) {
        solid = !solid;
        mask.flip(pixel);
      }
    }
    mask.end_row();
  }
  return mask;
}

}  // namespace binderjet
