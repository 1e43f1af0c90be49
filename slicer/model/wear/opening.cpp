// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/wear/opening.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace binderjet {
namespace {

// Appends the row on which at least `least` of the layer's rows [first, last) are 1, each run with
// its end moved by `grow` (negative: what shrinks to nothing vanishes).
void append_combined(const RunLayer& in, int first, int last, int least, int grow, RunLayer& out) {
  std::vector<std::pair<int, int>> events;
  for (int y = first; y < last; ++y) {
    const std::span<const int> row = in.row(y);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      const int end = std::min(row[i + 1] + grow, in.width());
      if (end <= row[i]) continue;
      events.emplace_back(row[i], 1);
      events.emplace_back(end, -1);
    }
  }
  std::sort(events.begin(), events.end());
  int depth = 0;
  for (std::size_t i = 0; i < events.size();) {
    const bool was_solid = depth >= least;
    const int x = events[i].first;
    for (; i < events.size() && events[i].first == x; ++i) depth += events[i].second;
    if (was_solid != (depth >= least)) out.flip(x);
  }
  out.end_row();
}

}  // namespace

RunLayer opening(const RunLayer& layer, std::array<int, 2> size_vx) {
  // Erosion anchored at a box's lower corner, then dilation from that corner.
  const auto [nx, ny] = size_vx;
  RunLayer corners(layer.width());
  for (int y = 0; y < layer.height(); ++y) append_combined(layer, y, y + ny, ny, 1 - nx, corners);
  RunLayer opened(layer.width());
  for (int y = 0; y < layer.height(); ++y)
    append_combined(corners, y - ny + 1, y + 1, 1, nx - 1, opened);
  return opened;
}

}  // namespace binderjet
