// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/job_masks.h"

#include <fmt/format.h>

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

// "3 islands of fewer than 4 pixels".
std::string regions(std::int64_t count, const char* word, int min_px) {
  return fmt::format("{} {}{} of fewer than {} pixels", count, word, count == 1 ? "" : "s", min_px);
}

}  // namespace

void RuleTally::add(const RuleChanges& of_layer) {
  changes.islands_erased += of_layer.islands_erased;
  changes.holes_filled += of_layer.holes_filled;
  layers += static_cast<std::int64_t>(of_layer.any());
}

std::string rule_warning(const RuleTally& tally, const MaskRules& rules) {
  if (!tally.changes.any()) return "";
  std::string what;
  if (tally.changes.islands_erased > 0) {
    what = "erased " + regions(tally.changes.islands_erased, "island", rules.min_island_px);
  }
  if (tally.changes.holes_filled > 0) {
    what += (what.empty() ? "filled " : ", filled ") +
            regions(tally.changes.holes_filled, "hole", rules.min_hole_px);
  }
  return fmt::format("the profile's mask minimum {} in {} layer{}", what, tally.layers,
                     tally.layers == 1 ? "" : "s");
}

Pipeline<MaskLayer> job_masks(const JobHeader& header, std::shared_ptr<const Mesh> mesh,
                              const Work& work) {
  const Pipeline<MaskLayer> masks =
      enhanced(header, voxel_layers(std::move(mesh), header.grid, header.box, work));
  return header.profile.mask.largest_px() > 1 ? obeying_masks(masks, header.profile.mask) : masks;
}

}  // namespace binderjet
