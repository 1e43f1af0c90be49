// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/mesh_scan_to_stack.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "slicer/base/error.h"
#include "slicer/mesh/read/read_mesh.h"
#include "slicer/stack/slice_stack.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {
namespace {

// Fine enough for any printer's voxels; edges are then found between samples.
constexpr double kPitchMm = 0.05;
// Larger than any printer's bed; what is larger still was measured in another unit.
constexpr double kMostMm = 2000;

}  // namespace

void write_scan_stack(const std::string& mesh, double layer_mm, const std::string& folder,
                      const Work& work) {
  MeshFile file = [&] {
    const Stage stage(work, "reading scan");
    return read_mesh(mesh);
  }();
  work.check();
  if (file.mesh.triangles.empty()) throw Error(ErrorKind::kBadInput, mesh, "holds no triangles");
  for (Point& point : file.mesh.points) {
    for (double& value : point) value *= file.unit_mm;
  }
  const Box box = bounding_box(file.mesh);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(box.size(axis) <= kMostMm && std::abs(box.min[static_cast<std::size_t>(axis)]) <= 1e6)) {
      throw Error(ErrorKind::kBadInput, mesh,
                  fmt::format("is {:.4g} mm large, more than any bed; if its numbers are "
                              "micrometers, scale the scan to millimeters first",
                              std::max({box.size(0), box.size(1), box.size(2)})));
    }
  }
  for (Point& point : file.mesh.points) {
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] -= box.min[axis];
  }
  const Grid grid{{kPitchMm, kPitchMm, layer_mm / 2}, {1, 1, 1}};
  const JobBox job = job_box({box.size(0), box.size(1), box.size(2)}, grid, {0, 0}, {0, 0});
  StackInfo info;
  info.kind = StackKind::kMeasured;
  info.size = job.size_px;
  info.pitch_mm = grid.pitch_mm;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int margin = axis < 2 ? job.margin_px[axis] : 0;
    info.origin_mm[axis] = box.min[axis] - margin * grid.pitch_mm[axis];
  }
  info.files = "measured_%06d.png";
  StackWriter stack(folder, info);
  const auto layers = voxelize(std::make_shared<const Mesh>(std::move(file.mesh)), grid, job,
                               LayerRange{0, job.size_px[2]});
  Stage stage(work, "slicing scan", job.size_px[2], "slices");
  for (int done = 0; layers->rest().size() > 0;) {
    const auto block = layers->next(kBlockLayers);
    oneapi::tbb::parallel_for(0, static_cast<int>(block.size()), [&](int i) {
      stack.write(done + i, block[static_cast<std::size_t>(i)]->slices.front());
    });
    done += static_cast<int>(block.size());
    stage.reach(done);
  }
  stack.finish();
}

}  // namespace binderjet
