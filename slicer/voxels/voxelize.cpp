// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/voxels/voxelize.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace binderjet {
namespace {

// Where the surface crosses a row: voxels from `x` on lie behind the crossing.
struct Crossing {
  int row;
  int x;
  int winding;  // +1 or -1
};

struct Point2 {
  double x;
  double y;
};

// Where the edge crosses the plane z. Both triangles of an edge compute it from its lower end, so
// that they agree to the last bit and no crack opens between them.
Point2 cut(const Point& a, const Point& b, double z) {
  const Point& low = a[2] <= z ? a : b;
  const Point& high = a[2] <= z ? b : a;
  const double t = (z - low[2]) / (high[2] - low[2]);
  return {low[0] + t * (high[0] - low[0]), low[1] + t * (high[1] - low[1])};
}

// The voxels of one axis: centers, and the first center at or above a place.
class Axis {
 public:
  Axis(const Grid& grid, int axis, int margin_vx, int size_vx)
      : voxel_mm_(grid.voxel_mm(axis)),
        per_mm_(1 / voxel_mm_),
        margin_vx_(margin_vx),
        size_vx_(size_vx) {}

  // In voxels of the job's box. Comparison with the center itself decides, so rounding in the
  // division cannot move a voxel across the surface.
  int first_center_at_or_above(double mm) const {
    int index = static_cast<int>(std::ceil(mm * per_mm_ - 0.5));
    if ((index + 0.5) * voxel_mm_ < mm) ++index;
    if ((index - 0.5) * voxel_mm_ >= mm) --index;
    return std::clamp(index + margin_vx_, 0, size_vx_);
  }
  double center_mm(int index) const { return (index - margin_vx_ + 0.5) * voxel_mm_; }
  int size_vx() const { return size_vx_; }

 private:
  double voxel_mm_;
  double per_mm_;
  int margin_vx_;
  int size_vx_;
};

// The rows that a segment of the plane cut crosses, each at its x.
void add_segment(Point2 from, Point2 to, const Axis& xs, const Axis& ys,
                 std::vector<Crossing>& crossings) {
  const int winding = from.y < to.y ? 1 : -1;
  if (winding < 0) std::swap(from, to);
  const int first = ys.first_center_at_or_above(from.y);
  const int last = ys.first_center_at_or_above(to.y);
  if (first >= last) return;
  const double slope = (to.x - from.x) / (to.y - from.y);
  for (int row = first; row < last; ++row) {
    const double x = from.x + (ys.center_mm(row) - from.y) * slope;
    crossings.push_back({row, xs.first_center_at_or_above(x), winding});
  }
}

// The crossings of the surface with the plane z, over the candidate triangles.
void cut_triangles(const Mesh& mesh, std::span<const int> candidates, double z, const Axis& xs,
                   const Axis& ys, std::vector<Crossing>& crossings) {
  for (const int index : candidates) {
    const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(index)];
    const Point* corner[3];
    int below = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      corner[c] = &mesh.points[static_cast<std::size_t>(triangle[c])];
      if ((*corner[c])[2] <= z) below |= 1 << c;
    }
    if (below == 0 || below == 7) continue;
    // One corner lies alone on its side of the plane; the cut runs between its two edges.
    const bool alone_below = below == 1 || below == 2 || below == 4;
    const int alone_bit = alone_below ? below : 7 - below;
    const int alone = alone_bit == 1 ? 0 : alone_bit == 2 ? 1 : 2;
    const Point2 after = cut(*corner[alone], *corner[(alone + 1) % 3], z);
    const Point2 before = cut(*corner[alone], *corner[(alone + 2) % 3], z);
    if (alone_below) {
      add_segment(after, before, xs, ys, crossings);
    } else {
      add_segment(before, after, xs, ys, crossings);
    }
  }
}

// The crossings as runs of non-zero winding number.
RunLayer runs_of(std::vector<Crossing>& crossings, int width, int height) {
  // Counting sort by row, then a short sort by x within each.
  std::vector<std::size_t> starts(static_cast<std::size_t>(height) + 1, 0);
  for (const Crossing& crossing : crossings) ++starts[static_cast<std::size_t>(crossing.row) + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Crossing> sorted(crossings.size());
  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  for (const Crossing& crossing : crossings) {
    sorted[next[static_cast<std::size_t>(crossing.row)]++] = crossing;
  }

  RunLayer layer(width);
  layer.reserve(height, crossings.size());
  for (std::size_t row = 0; row < static_cast<std::size_t>(height); ++row) {
    const auto first = sorted.begin() + static_cast<std::ptrdiff_t>(starts[row]);
    const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(starts[row + 1]);
    if (last - first == 2) {
      if (first->x > first[1].x) std::swap(*first, first[1]);
    } else {
      std::sort(first, last, [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
    }
    int winding = 0;
    for (auto crossing = first; crossing != last; ++crossing) {
      const bool was_inside = winding != 0;
      winding += crossing->winding;
      if (was_inside != (winding != 0)) layer.flip(crossing->x);
    }
    // A closed surface leaves no winding behind; an open one must not leak to the right.
    if (winding != 0) layer.flip(width);
    layer.end_row();
  }
  return layer;
}

class Voxelizer : public Stream<VoxelLayer> {
 public:
  Voxelizer(std::shared_ptr<const Mesh> mesh, const Grid& grid, const JobBox& box,
            LayerRange layers)
      : mesh_(std::move(mesh)),
        grid_(grid),
        xs_(grid, 0, box.margin_px[0] * grid.detail_vx[0], box.width_vx(grid)),
        ys_(grid, 1, box.margin_px[1] * grid.detail_vx[1], box.height_vx(grid)),
        rest_(layers) {
    const std::size_t count = mesh_->triangles.size();
    by_lowest_.resize(count);
    std::iota(by_lowest_.begin(), by_lowest_.end(), 0);
    std::vector<float> lowest(count);
    for (std::size_t i = 0; i < count; ++i) {
      // Rounded down, so that no triangle enters the active list too late.
      lowest[i] = std::nextafterf(static_cast<float>(low(mesh_->triangles[i])), -1e30F);
    }
    std::sort(by_lowest_.begin(), by_lowest_.end(), [&lowest](int a, int b) {
      return lowest[static_cast<std::size_t>(a)] < lowest[static_cast<std::size_t>(b)];
    });
  }

  LayerRange rest() const override { return rest_; }

  std::vector<Shared<VoxelLayer>> next(int count) override {
    const LayerRange block{rest_.first, std::min(rest_.last, rest_.first + count)};
    const int rz = grid_.detail_vx[2];
    activate(grid_.center_mm(2, block.first * rz), grid_.center_mm(2, block.last * rz - 1));
    std::vector<Shared<VoxelLayer>> out(static_cast<std::size_t>(block.size()));
    oneapi::tbb::parallel_for(block.first, block.last, [&](int layer) {
      auto voxels = std::make_shared<VoxelLayer>();
      std::vector<Crossing> crossings;
      for (int s = 0; s < rz; ++s) {
        crossings.clear();
        cut_triangles(*mesh_, active_, grid_.center_mm(2, layer * rz + s), xs_, ys_, crossings);
        voxels->slices.push_back(runs_of(crossings, xs_.size_vx(), ys_.size_vx()));
      }
      out[static_cast<std::size_t>(layer - block.first)] = std::move(voxels);
    });
    rest_.first = block.last;
    return out;
  }

 private:
  double corner_z(int point) const { return mesh_->points[static_cast<std::size_t>(point)][2]; }
  double low(const Triangle& t) const {
    return std::min({corner_z(t[0]), corner_z(t[1]), corner_z(t[2])});
  }
  double high(const Triangle& t) const {
    return std::max({corner_z(t[0]), corner_z(t[1]), corner_z(t[2])});
  }

  // Makes the active list hold every triangle that some plane in [first_z, last_z] cuts.
  void activate(double first_z, double last_z) {
    std::erase_if(active_, [&](int i) {
      return high(mesh_->triangles[static_cast<std::size_t>(i)]) <= first_z;
    });
    for (; waiting_ < by_lowest_.size(); ++waiting_) {
      const Triangle& triangle = mesh_->triangles[static_cast<std::size_t>(by_lowest_[waiting_])];
      if (low(triangle) > last_z) break;
      if (high(triangle) > first_z) active_.push_back(by_lowest_[waiting_]);
    }
  }

  std::shared_ptr<const Mesh> mesh_;
  Grid grid_;
  Axis xs_;
  Axis ys_;
  LayerRange rest_;
  std::vector<int> by_lowest_;  // triangles in order of their lowest point
  std::size_t waiting_ = 0;     // the first of them that no plane has reached
  std::vector<int> active_;
};

}  // namespace

std::unique_ptr<Stream<VoxelLayer>> voxelize(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                             const JobBox& box, LayerRange layers) {
  return std::make_unique<Voxelizer>(std::move(mesh), grid, box, layers);
}

Pipeline<VoxelLayer> voxel_layers(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                  const JobBox& box, const Work& work) {
  return {"voxelize",
          {0, box.size_px[2]},
          [mesh = std::move(mesh), grid, box](LayerRange layers) {
            return voxelize(mesh, grid, box, layers);
          },
          work};
}

}  // namespace binderjet
