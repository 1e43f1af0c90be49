// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/score_prints.h"

#include <oneapi/tbb/parallel_for.h>

#include "slicer/base/work.h"
#include "slicer/score/edge_error.h"
#include "slicer/score/voxel_counts.h"

namespace binderjet {
namespace {

struct Sum {
  VoxelCounts voxels;
  EdgeErrors edges;

  PrintError error() const {
    return {voxels.wrong(), edges.mean_mm(), edges.p95_mm(), edges.max_mm()};
  }
};

using Layers = std::vector<Shared<RunLayer>>;

// `print` takes the target's part: what came out is what a prediction is measured against.
Sum compare(const Layers& print, const Layers& predicted, const Grid& grid,
            const LayerChoice& layers, Stage& stage) {
  std::vector<Sum> of_layer(print.size());
  oneapi::tbb::parallel_for(std::size_t{0}, print.size(), [&](std::size_t k) {
    stage.advance();
    if (!layers[k]) return;
    const VoxelLayer target{{*print[k]}};
    of_layer[k] = {count_voxels(target, *predicted[k]), edge_errors(target, *predicted[k], grid)};
  });
  Sum sum;
  for (const Sum& one : of_layer) {
    sum.voxels += one.voxels;
    sum.edges += one.edges;
  }
  return sum;
}

PrintError mean_error(const MeasuredJob& job, const Layers& predicted, const LayerChoice& layers,
                      Stage& stage) {
  Sum sum;
  for (const Layers& print : job.prints) {
    const Sum one = compare(print, predicted, job.grid, layers, stage);
    sum.voxels += one.voxels;
    sum.edges += one.edges;
  }
  return sum.error();
}

}  // namespace

BeforeAfter score_models(const MeasuredJob& job, const std::string& name,
                         const std::vector<EffectSpec>& before,
                         const std::vector<EffectSpec>& after, const LayerChoice& layers) {
  BeforeAfter out;
  out.name = name;
  const auto prints = static_cast<std::int64_t>(job.prints.size());
  Stage stage(job.work, "scoring " + name, (2 * prints + (prints > 1 ? 1 : 0)) * job.layers(),
              "layers");
  out.before = mean_error(job, print_layers(job, before, layers), layers, stage);
  out.after = mean_error(job, print_layers(job, after, layers), layers, stage);
  if (job.prints.size() > 1) {
    out.floor = compare(job.prints[0], job.prints[1], job.grid, layers, stage).error();
  }
  return out;
}

}  // namespace binderjet
