// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/wear/morphology.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

// A row with each run made wider by `by` at both ends, or narrower where `by` is negative.
void grown(rows::Row row, int by, int width, std::vector<int>& out) {
  out.clear();
  for (std::size_t i = 0; i < row.size(); i += 2) {
    const int first = std::max(0, row[i] - by);
    const int last = std::min(width, row[i + 1] + by);
    if (first >= last) continue;
    if (!out.empty() && first <= out.back()) {
      out.back() = last;
    } else {
      out.push_back(first);
      out.push_back(last);
    }
  }
}

// A row that the ellipsoid reaches from its center, and how far it goes there to either side.
struct Neighbor {
  int dy;
  int dz;
  int half;
};

std::vector<Neighbor> neighbors(const Ellipsoid& by) {
  const auto [rx, ry, rz] = by.reach();
  std::vector<Neighbor> out;
  for (int dz = -rz; dz <= rz; ++dz) {
    for (int dy = -ry; dy <= ry; ++dy) {
      const int half = by.half_width(dy, dz);
      if (half >= 0) out.push_back({dy, dz, half});
    }
  }
  return out;
}

// The middle layer, each of whose rows takes in every row that the ellipsoid reaches from it:
// `take`(row so far, layer or null where there is none, y, half width of the ellipsoid there).
template <class Take>
RunLayer over_neighbors(const RunWindow& window, const Ellipsoid& by, const Take& take) {
  const std::vector<Neighbor> reached = neighbors(by);
  const RunLayer& middle = window.middle();
  RunLayer out(middle.width());
  std::vector<int> runs;
  for (int y = 0; y < middle.height(); ++y) {
    runs.assign(middle.row(y).begin(), middle.row(y).end());
    for (const auto& [dy, dz, half] : reached) take(runs, window.at(dz), y + dy, half);
    out.append_row(runs);
  }
  return out;
}

}  // namespace

Ellipsoid::Ellipsoid(double radius_mm, const Grid& grid)
    : radius_{radius_mm / grid.voxel_mm(0), radius_mm / grid.voxel_mm(1),
              radius_mm / grid.pitch_mm[2]} {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // A radius of whole voxels in decimal millimeters is that many but for rounding.
    constexpr double kRounding = 1e-9;
    reach_[axis] = static_cast<int>(std::floor(radius_[axis] + kRounding));
  }
}

Ellipsoid Ellipsoid::disc(double radius_mm, const Grid& grid) {
  Ellipsoid out(radius_mm, grid);
  out.reach_[2] = 0;
  return out;
}

int Ellipsoid::half_width(int dy, int dz) const {
  const double v = dy / radius_[1];
  const double w = dz / radius_[2];
  const double left = 1 - v * v - w * w;
  constexpr double kRounding = 1e-9;
  return left < -kRounding ? -1
                           : static_cast<int>(std::floor(
                                 radius_[0] * std::sqrt(std::max(0.0, left)) + kRounding));
}

RunLayer dilated(const RunWindow& window, const Ellipsoid& by) {
  std::vector<int> row;
  std::vector<int> next;
  return over_neighbors(window, by,
                        [&](std::vector<int>& runs, const RunLayer* layer, int y, int half) {
                          if (layer == nullptr || layer->row(y).empty()) return;
                          grown(layer->row(y), half, layer->width(), row);
                          rows::unite(runs, row, next);
                          std::swap(runs, next);
                        });
}

RunLayer dilated_within(const RunWindow& window, const Ellipsoid& by, const RunLayer& within) {
  std::vector<Neighbor> reached = neighbors(by);
  std::stable_sort(reached.begin(), reached.end(),
                   [](const Neighbor& a, const Neighbor& b) { return a.half > b.half; });
  RunLayer out(within.width());
  std::vector<int> left;  // voxels of the row that are not dilated so far
  std::vector<int> row;
  std::vector<int> next;
  for (int y = 0; y < within.height(); ++y) {
    left.assign(within.row(y).begin(), within.row(y).end());
    for (const auto& [dy, dz, half] : reached) {
      if (left.empty()) break;
      const RunLayer* layer = window.at(dz);
      if (layer == nullptr || layer->row(y + dy).empty()) continue;
      grown(layer->row(y + dy), half, within.width(), row);
      rows::subtract(left, row, next);
      std::swap(left, next);
    }
    rows::subtract(within.row(y), left, row);
    out.append_row(row);
  }
  return out;
}

RunLayer eroded(const RunWindow& window, const Ellipsoid& by, Beyond beyond) {
  const int width = window.middle().width();
  std::vector<int> row;
  std::vector<int> next;
  return over_neighbors(window, by,
                        [&](std::vector<int>& runs, const RunLayer* layer, int y, int half) {
                          if (runs.empty() || (layer == nullptr && beyond == Beyond::kSame)) return;
                          grown(layer == nullptr ? rows::Row{} : layer->row(y), -half, width, row);
                          rows::intersect(runs, row, next);
                          std::swap(runs, next);
                        });
}

}  // namespace binderjet
