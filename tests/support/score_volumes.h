// SPDX-License-Identifier: GPL-3.0-or-later
// The score of volumes that a test makes by hand.
#pragma once

#include <utility>
#include <vector>

#include "slicer/score/score.h"
#include "tests/support/volume.h"

namespace binderjet::whole {

struct ScoreOfVolumes {
  Score score;
  std::vector<Feature> features;
  std::vector<Region> regions(FeatureKind kind) const {
    std::vector<Region> out;
    for (const Feature& feature : features) {
      if (feature.kind == kind) out.push_back(feature.region);
    }
    return out;
  }
};

// `target` has every slice, `printed` one per layer.
inline ScoreOfVolumes score(const Volume& target, const Volume& printed, const Grid& grid,
                            int block = kBlockLayers) {
  const LayerRange layers{0, printed.nz};
  const auto stream = score_layers(voxel_stream(target, grid.detail_vx[2], layers),
                                   layer_stream(printed), grid, layers);
  ScoreOfVolumes out{Score(grid, 0), {}};
  const auto take = [&](const std::vector<Feature>& features) {
    out.features.insert(out.features.end(), features.begin(), features.end());
  };
  while (stream->rest().size() > 0) {
    for (const Shared<LayerScore>& layer : stream->next(block)) take(out.score.add(*layer));
  }
  take(out.score.finish());
  return out;
}

}  // namespace binderjet::whole
