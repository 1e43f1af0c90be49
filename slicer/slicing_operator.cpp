// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/slicing_operator.h"

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

}  // namespace

RunLayer slicing_operator(const VoxelLayer& voxels, const Grid& grid) {
  const auto [rx, ry, rz] = grid.detail_vx;
  const int width_px = voxels.slices.front().width() / rx;
  const int height_px = voxels.slices.front().height() / ry;
  const int half = (rx * ry * rz + 1) / 2;

  RunLayer mask(width_px);
  mask.reserve(height_px, voxels.slices.front().flip_count() / 2);
  std::vector<Event> events;
  for (int j = 0; j < height_px; ++j) {
    events.clear();
    for (const RunLayer& slice : voxels.slices) {
      for (int y = j * ry; y < (j + 1) * ry; ++y) add_events(slice.row(y), rx, events);
    }
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
