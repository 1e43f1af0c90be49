// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/band.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace binderjet {
namespace {

int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace

Band::Band(const RunLayer& open, const Rect& reach, std::array<int, 2> repeat) {
  int low = 0;
  int high = open.height();
  while (low < high && open.row(low).empty()) ++low;
  while (low < high && open.row(high - 1).empty()) --high;
  if (low == high) return;
  const auto [rx, ry] = repeat;
  first_row_ = low * ry + reach.y0;
  const int end = (high - 1) * ry + reach.y1;
  std::vector<std::pair<int, int>> reached;
  for (int v = first_row_; v < end; ++v) {
    // The pixel rows y with y ry + reach.y0 <= v < y ry + reach.y1.
    reached.clear();
    for (int y = floor_div(v - reach.y1, ry) + 1; y <= floor_div(v - reach.y0, ry); ++y) {
      const std::span<const int> row = open.row(y);
      for (std::size_t i = 0; i < row.size(); i += 2) {
        reached.emplace_back(row[i] * rx + reach.x0, (row[i + 1] - 1) * rx + reach.x1);
      }
    }
    std::sort(reached.begin(), reached.end());
    const std::size_t row_begin = runs_.size();
    for (const auto& [x0, x1] : reached) {
      if (runs_.size() > row_begin && x0 <= runs_.back().x1) {
        runs_.back().x1 = std::max(runs_.back().x1, x1);
      } else {
        runs_.push_back({x0, x1, 0});
      }
    }
    for (std::size_t i = row_begin; i < runs_.size(); ++i) {
      runs_[i].first = size_;
      size_ += static_cast<std::size_t>(runs_[i].x1 - runs_[i].x0);
    }
    row_ends_.push_back(runs_.size());
  }
}

std::span<const BandRun> Band::row(int y) const {
  if (y < first_row_ || y >= last_row()) return {};
  const auto at = static_cast<std::size_t>(y - first_row_);
  const std::size_t begin = at == 0 ? 0 : row_ends_[at - 1];
  return {runs_.data() + begin, row_ends_[at] - begin};
}

std::size_t Band::number(int x, int y) const {
  const std::span<const BandRun> runs = row(y);
  const auto after = std::upper_bound(runs.begin(), runs.end(), x,
                                      [](int value, const BandRun& run) { return value < run.x0; });
  assert(after != runs.begin() && x < std::prev(after)->x1);
  return std::prev(after)->first + static_cast<std::size_t>(x - std::prev(after)->x0);
}

}  // namespace binderjet
