// SPDX-License-Identifier: GPL-3.0-or-later
// A job's layers on their way through the inverse solver, printed, from volumes that a test makes.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/enhance/inverse/search/search_model.h"
#include "tests/support/volume.h"

namespace binderjet::whole {

struct InverseScene {
  SearchModel model;

  // `target` has every slice, `masks` one a layer; the plain masks are those of the target.
  InverseScene(std::span<const PrinterModel> window, const Grid& grid, const MaskRules& rules,
               const Volume& target, const Volume& masks)
      : model(window, rules, grid), reach_(2 * model.printer.window_reach() + 2) {
    const auto voxels = voxel_stream(target, grid.detail_vx[2], {0, masks.nz})->next(masks.nz);
    const Volume plain = whole::masks(target, grid);
    const auto beyond = static_cast<std::size_t>(reach_);
    layers_.resize(beyond);
    for (int k = 0; k < masks.nz; ++k) {
      layers_.push_back(std::make_shared<const InverseLayer>(InverseLayer{
          voxels[static_cast<std::size_t>(k)], std::make_shared<const RunLayer>(slice(plain, k)),
          std::make_shared<const RunLayer>(slice(masks, k)), k}));
    }
    layers_.resize(layers_.size() + beyond);
    for (int k = 0; k < masks.nz; ++k) {
      InverseLayer layer = around(k).middle();
      layer.printed =
          std::make_shared<const RunLayer>(print_with(around(k), 0, model.printer, *layer.mask));
      layers_[beyond + static_cast<std::size_t>(k)] =
          std::make_shared<const InverseLayer>(std::move(layer));
    }
  }
  // The same, beginning with the plain masks.
  InverseScene(std::span<const PrinterModel> window, const Grid& grid, const MaskRules& rules,
               const Volume& target)
      : InverseScene(window, grid, rules, target, whole::masks(target, grid)) {}

  // The layers around layer k, which may be any of the job.
  LayerWindow around(int k) const {
    const auto count = static_cast<std::size_t>(2 * reach_ + 1);
    return {std::span(layers_).subspan(static_cast<std::size_t>(k), count),
            LayerReach::both_sides(reach_)};
  }

 private:
  int reach_;
  std::vector<Shared<InverseLayer>> layers_;  // with null layers below and above
};

// All pixels of a layer.
inline RunLayer all_of(int width, int height) {
  RunLayer out(width);
  const int row[] = {0, width};
  for (int y = 0; y < height; ++y) out.append_row(row);
  return out;
}

}  // namespace binderjet::whole
