// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/hidden_printers/second_print.h"

#include <algorithm>
#include <utility>

#include "slicer/calibrate/calibrate.h"
#include "slicer/enhance/inverse/inverse_solver.h"
#include "slicer/enhance/masks.h"
#include "slicer/model/process_window.h"
#include "slicer/score/score.h"
#include "tests/support/vector_stream.h"

namespace binderjet::hidden {
namespace {

constexpr int kPaperPasses = 2;

// A part in a box that does not depend on the profile: where the printer is wrong is a place in the
// box.
struct Scene {
  Wanted wanted;
  Grid grid;
  JobBox box;
  JobPlace place;

  LayerRange layers() const { return {0, box.size_px[2]}; }
};

Scene scene_of(const Wanted& wanted) {
  constexpr double kMarginMm = 1.5;
  Scene scene{wanted, part("grid", {1, 1, 1}, 0).grid, {}, {}};
  const std::array<int, 2> margin_vx{pixels_for(kMarginMm, scene.grid.voxel_mm(0)),
                                     pixels_for(kMarginMm, scene.grid.voxel_mm(1))};
  scene.box = job_box(wanted.box.max, scene.grid, {0, 0}, margin_vx);
  scene.box.bed_px = {0, 0, 0};
  scene.place = place_of(scene.box, scene.grid);
  return scene;
}

std::vector<Shared<RunLayer>> masks_of(const Scene& scene, const std::string& enhance,
                                       const std::vector<EffectSpec>& effects,
                                       const MaskRules& rules) {
  const Pipeline<VoxelLayer> target = voxel_layers(scene.wanted.mesh, scene.grid, scene.box);
  const auto enhanced = [&]() -> Pipeline<MaskLayer> {
    if (enhance == "none") return plain_masks(target, scene.grid);
    const std::vector<PrinterModel> window = process_window(effects, scene.grid, scene.place);
    if (enhance == "paper") {
      return paper_masks(target, scene.grid, std::make_shared<const PrinterModel>(window.front()),
                         kPaperPasses);
    }
    return inverse_masks(target, std::make_shared<const InverseSolver>(window, scene.grid, rules));
  };
  const auto stream = enhanced().layers(scene.layers());
  std::vector<Shared<RunLayer>> out;
  while (stream->rest().size() > 0) {
    for (const Shared<MaskLayer>& layer : stream->next(kBlockLayers)) {
      out.push_back(std::make_shared<const RunLayer>(layer->mask));
    }
  }
  return out;
}

MeasuredJob job_of(const Scene& scene, std::vector<Shared<RunLayer>> masks) {
  MeasuredJob job;
  job.name = "part";
  job.grid = scene.grid;
  job.place = scene.place;
  job.masks = std::move(masks);
  return job;
}

PrintScore score_print(const Scene& scene, const std::vector<Shared<RunLayer>>& printed) {
  const auto layers =
      score_layers(voxelize(scene.wanted.mesh, scene.grid, scene.box, scene.layers()),
                   stream_of(printed), scene.grid, scene.layers());
  Scorer scorer(scene.grid, 0);
  while (layers->rest().size() > 0) {
    for (const Shared<LayerScore>& layer : layers->next(kBlockLayers)) scorer.add(*layer);
  }
  const JobScore score = scorer.finish();
  return {score.voxels, score.faults[FaultKind::kLost], score.faults[FaultKind::kFused],
          score.faults[FaultKind::kSpurious]};
}

PrintScore score_masks(const Printer& printer, const Scene& scene,
                       std::vector<Shared<RunLayer>> masks) {
  MeasuredJob job = job_of(scene, std::move(masks));
  constexpr unsigned kNoNoise = 0;
  print(printer, job, kNoNoise);
  return score_print(scene, job.prints.front());
}

}  // namespace

Wanted scaled(Mesh mesh, double scale) {
  const Box before = bounding_box(mesh);
  for (Point& point : mesh.points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = (point[axis] - before.min[axis]) * scale;
    }
  }
  const Box box = bounding_box(mesh);
  return {std::make_shared<const Mesh>(std::move(mesh)), box};
}

Loop close_loop(const Printer& printer, const Wanted& calibrated_on, const Wanted& wanted,
                const std::vector<EffectSpec>& declared, const MaskRules& rules) {
  const Scene first = scene_of(calibrated_on);
  MeasuredJob sent = job_of(first, masks_of(first, "none", declared, rules));
  print(printer, sent, 1);
  print(printer, sent, 2);
  Loop loop;
  loop.found = calibrate(sent, {}, declared, {});

  const Scene second = scene_of(wanted);
  for (const std::string enhance : {"none", "paper", "inverse"}) {
    loop.second[enhance] =
        score_masks(printer, second, masks_of(second, enhance, loop.found.after_model, rules));
  }
  return loop;
}

}  // namespace binderjet::hidden
