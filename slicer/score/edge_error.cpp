// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/edge_error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

// Row r is 1 where rows r - 1 and r of the layer differ: the edges on the line between them.
RunLayer edges_between_rows(const RunLayer& layer) {
  RunLayer edges(layer.width());
  edges.reserve(layer.height() + 1, layer.flip_count());
  std::vector<int> row;
  for (int y = 0; y <= layer.height(); ++y) {
    rows::difference(layer.row(y - 1), layer.row(y), row);
    edges.append_row(row);
  }
  return edges;
}

// The edges of one printed layer, to be asked for the nearest to a place.
class PrintedEdges {
 public:
  PrintedEdges(const RunLayer& printed, const Grid& grid)
      : printed_(printed),
        between_(edges_between_rows(printed)),
        voxel_x_mm_(grid.voxel_mm(0)),
        voxel_y_mm_(grid.voxel_mm(1)) {}

  // The distance from (x, y), in voxels, to the nearest edge, at most EdgeErrors::kMaxMm. Rows
  // are asked outwards from the place's own until they lie farther off than what was found.
  double nearest_mm(double x, double y) const {
    double best = EdgeErrors::kMaxMm;
    const int own = static_cast<int>(std::floor(y));
    for (int step = 0; (step - 1) * voxel_y_mm_ < best; ++step) {
      if (step > 0) look_at_row(own - step, x, y, best);
      look_at_row(own + step, x, y, best);
      if (step > 0) look_at_line(own - step, x, y, best);
      look_at_line(own + step, x, y, best);
    }
    return best;
  }

 private:
  // The edges that end the runs of row `row`: each as high as the row.
  void look_at_row(int row, double x, double y, double& best) const {
    const double away_y = std::max({0.0, row - y, y - (row + 1)}) * voxel_y_mm_;
    if (away_y >= best) return;
    const auto flips = printed_.row(row);
    const auto next = std::lower_bound(flips.begin(), flips.end(), x);
    if (next != flips.end()) best = std::min(best, std::hypot(away_x(*next, x), away_y));
    if (next != flips.begin()) best = std::min(best, std::hypot(away_x(*(next - 1), x), away_y));
  }
  // The edges on the line below row `row`.
  void look_at_line(int row, double x, double y, double& best) const {
    const double away_y = std::abs(row - y) * voxel_y_mm_;
    if (away_y >= best) return;
    const auto flips = between_.row(row);
    const auto next = std::lower_bound(flips.begin(), flips.end(), x);
    if ((next - flips.begin()) % 2 == 1) best = away_y;
    // The ends of these edges are ends of edges beside them, which look_at_row() finds.
  }
  double away_x(int flip, double x) const { return std::abs(flip - x) * voxel_x_mm_; }

  const RunLayer& printed_;
  RunLayer between_;
  double voxel_x_mm_;
  double voxel_y_mm_;
};

}  // namespace

void EdgeErrors::add(double distance_mm) {
  ++of_um_[static_cast<std::size_t>(std::lround(distance_mm * 1e3))];
  ++edges_;
  const std::int64_t nm = std::llround(distance_mm * 1e6);
  sum_nm_ += nm;
  max_nm_ = std::max(max_nm_, nm);
}

EdgeErrors& EdgeErrors::operator+=(const EdgeErrors& other) {
  for (std::size_t i = 0; i < of_um_.size(); ++i) of_um_[i] += other.of_um_[i];
  edges_ += other.edges_;
  sum_nm_ += other.sum_nm_;
  max_nm_ = std::max(max_nm_, other.max_nm_);
  return *this;
}

double EdgeErrors::mean_mm() const {
  return edges_ == 0 ? 0 : static_cast<double>(sum_nm_) * 1e-6 / static_cast<double>(edges_);
}

double EdgeErrors::p95_mm() const {
  std::int64_t within = 0;
  for (std::size_t um = 0; um < of_um_.size(); ++um) {
    within += of_um_[um];
    if (within * 100 >= edges_ * 95) return static_cast<double>(um) * 1e-3;
  }
  return kMaxMm;
}

EdgeErrors edge_errors(const VoxelLayer& target, const RunLayer& printed, const Grid& grid) {
  EdgeErrors errors;
  const PrintedEdges edges(printed, grid);
  std::vector<int> across;
  for (const RunLayer& slice : target.slices) {
    for (int y = 0; y <= slice.height(); ++y) {
      for (const int x : slice.row(y)) errors.add(edges.nearest_mm(x, y + 0.5));
      rows::difference(slice.row(y - 1), slice.row(y), across);
      for (std::size_t i = 0; i < across.size(); i += 2) {
        for (int x = across[i]; x < across[i + 1]; ++x) errors.add(edges.nearest_mm(x + 0.5, y));
      }
    }
  }
  return errors;
}

}  // namespace binderjet
