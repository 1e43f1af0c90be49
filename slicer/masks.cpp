// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/masks.h"

#include <utility>

#include "slicer/enhance/paper_rule.h"
#include "slicer/slicing_operator.h"

namespace binderjet {

std::unique_ptr<Stream<MaskLayer>> plain_masks(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                               const JobBox& box, LayerRange layers) {
  using Slicing = Step<VoxelLayer, MaskLayer>;
  return std::make_unique<Slicing>(
      voxelize(std::move(mesh), grid, box, layers), layers, 0, box.size_px[2],
      [grid](int, Slicing::Window window) {
        return MaskLayer{slicing_operator(*window[0], grid), window[0]};
      });
}

std::unique_ptr<Stream<MaskLayer>> paper_masks(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                               const JobBox& box, LayerRange layers,
                                               std::shared_ptr<const PrinterModel> model,
                                               int passes) {
  if (passes == 0) return plain_masks(std::move(mesh), grid, box, layers);
  const int job_layers = box.size_px[2];
  LayerRange range = grown(layers, passes, job_layers);

  using First = Step<VoxelLayer, PassLayer>;
  std::unique_ptr<Stream<PassLayer>> volume = std::make_unique<First>(
      voxelize(std::move(mesh), grid, box, range), range, 0, job_layers,
      [grid, model](int, First::Window window) {
        return PassLayer{window[0], window[0], model->print(slicing_operator(*window[0], grid))};
      });

  using Pass = Step<PassLayer, PassLayer>;
  for (int pass = 1; pass < passes; ++pass) {
    range = grown(layers, passes - pass, job_layers);
    volume = std::make_unique<Pass>(
        std::move(volume), range, 1, job_layers, [grid, model](int, Pass::Window window) {
          auto next = std::make_shared<const VoxelLayer>(
              paper_rule(window[0].get(), *window[1], window[2].get()));
          return PassLayer{window[1]->target, next, model->print(slicing_operator(*next, grid))};
        });
  }

  using Last = Step<PassLayer, MaskLayer>;
  return std::make_unique<Last>(
      std::move(volume), layers, 1, job_layers, [grid](int, Last::Window window) {
        const VoxelLayer last = paper_rule(window[0].get(), *window[1], window[2].get());
        return MaskLayer{slicing_operator(last, grid), window[1]->target};
      });
}

}  // namespace binderjet
