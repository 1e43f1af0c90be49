// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/job_masks.h"

#include <utility>
#include <vector>

#include "slicer/enhance/inverse/inverse_solver.h"
#include "slicer/model/process_window.h"

namespace binderjet {
namespace {

Pipeline<MaskLayer> enhanced(const JobHeader& header, const Pipeline<VoxelLayer>& target) {
  if (header.enhance == Enhancement::kNone) return plain_masks(target, header.grid);
  const JobPlace place = place_of(header.box, header.grid);
  if (header.enhance == Enhancement::kInverse) {
    std::vector<PrinterModel> window = process_window(header.profile.effects, header.grid, place);
    if (!header.robust) window.resize(1, window.front());
    return inverse_masks(target, std::make_shared<const InverseSolver>(
                                     std::move(window), header.grid, header.profile.mask));
  }
  auto model = std::make_shared<const PrinterModel>(header.profile.effects, header.grid, place);
  return paper_masks(target, header.grid, model, header.passes);
}

}  // namespace

Pipeline<MaskLayer> job_masks(const JobHeader& header, std::shared_ptr<const Mesh> mesh) {
  return enhanced(header, voxel_layers(std::move(mesh), header.grid, header.box));
}

}  // namespace binderjet
