// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/masks.h"

#include <utility>
#include <vector>

#include "slicer/enhance/paper/paper_rule.h"
#include "slicer/voxels/slicing_operator.h"

namespace binderjet {
namespace {

using VoxelStream = std::unique_ptr<Stream<VoxelLayer>>;

// A layer of the current volume V with its mask.
struct SlicedLayer {
  Shared<VoxelLayer> target;
  Shared<VoxelLayer> volume;
  RunLayer mask;
};

// What the printer makes of each layer, which may take the masks around it.
std::unique_ptr<Stream<PassLayer>> with_print(std::unique_ptr<Stream<SlicedLayer>> sliced,
                                              LayerRange layers, int job_layers,
                                              const std::shared_ptr<const PrinterModel>& model) {
  using Print = Step<SlicedLayer, PassLayer>;
  return std::make_unique<Print>(
      std::move(sliced), layers, model->window_reach(), job_layers,
      [model](int layer, Print::Window window) {
        std::vector<const RunLayer*> masks;
        for (const Shared<SlicedLayer>& near : window) {
          masks.push_back(near == nullptr ? nullptr : &near->mask);
        }
        const SlicedLayer& here = *window[window.size() / 2];
        return PassLayer{here.target, here.volume, model->print(masks, layer)};
      });
}

// How many layers above and below a layer `passes` passes look at.
int target_reach(const PrinterModel& model, int passes) {
  return passes * (1 + model.window_reach());
}

}  // namespace

std::unique_ptr<Stream<MaskLayer>> plain_masks(VoxelStream target, const Grid& grid,
                                               LayerRange layers, int job_layers) {
  using Slicing = Step<VoxelLayer, MaskLayer>;
  return std::make_unique<Slicing>(
      std::move(target), layers, 0, job_layers, [grid](int, Slicing::Window window) {
        return MaskLayer{slicing_operator(*window[0], grid), window[0]};
      });
}

std::unique_ptr<Stream<MaskLayer>> paper_masks(const TargetFrom& target_from, const Grid& grid,
                                               LayerRange layers, int job_layers,
                                               const std::shared_ptr<const PrinterModel>& model,
                                               int passes) {
  if (passes == 0) return plain_masks(target_from(layers), grid, layers, job_layers);

  LayerRange range = grown(layers, target_reach(*model, passes), job_layers);
  using First = Step<VoxelLayer, SlicedLayer>;
  std::unique_ptr<Stream<SlicedLayer>> sliced = std::make_unique<First>(
      target_from(range), range, 0, job_layers, [grid](int, First::Window window) {
        return SlicedLayer{window[0], window[0], slicing_operator(*window[0], grid)};
      });

  using Pass = Step<PassLayer, SlicedLayer>;
  for (int left = passes - 1; left > 0; --left) {
    range = grown(layers, target_reach(*model, left), job_layers);
    auto printed = with_print(std::move(sliced), grown(range, 1, job_layers), job_layers, model);
    sliced = std::make_unique<Pass>(
        std::move(printed), range, 1, job_layers, [grid](int, Pass::Window window) {
          auto next = std::make_shared<const VoxelLayer>(
              paper_rule(window[0].get(), *window[1], window[2].get()));
          return SlicedLayer{window[1]->target, next, slicing_operator(*next, grid)};
        });
  }

  using Last = Step<PassLayer, MaskLayer>;
  return std::make_unique<Last>(
      with_print(std::move(sliced), grown(layers, 1, job_layers), job_layers, model), layers, 1,
      job_layers, [grid](int, Last::Window window) {
        const VoxelLayer last = paper_rule(window[0].get(), *window[1], window[2].get());
        return MaskLayer{slicing_operator(last, grid), window[1]->target};
      });
}

std::unique_ptr<Stream<MaskLayer>> plain_masks(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                               const JobBox& box, LayerRange layers) {
  return plain_masks(voxelize(std::move(mesh), grid, box, layers), grid, layers, box.size_px[2]);
}

std::unique_ptr<Stream<MaskLayer>> paper_masks(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                               const JobBox& box, LayerRange layers,
                                               const std::shared_ptr<const PrinterModel>& model,
                                               int passes) {
  return paper_masks([&](LayerRange range) { return voxelize(std::move(mesh), grid, box, range); },
                     grid, layers, box.size_px[2], model, passes);
}

std::unique_ptr<Stream<MaskLayer>> inverse_masks(
    std::shared_ptr<const Mesh> mesh, const Grid& grid, const JobBox& box, LayerRange layers,
    const std::shared_ptr<const InverseSolver>& solver) {
  return inverse_masks(
      [&](LayerRange range) { return voxelize(std::move(mesh), grid, box, range); }, layers,
      box.size_px[2], solver);
}

}  // namespace binderjet
