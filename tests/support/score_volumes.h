// SPDX-License-Identifier: GPL-3.0-or-later
// The score of volumes that a test makes by hand.
#pragma once

#include <utility>
#include <vector>

#include "slicer/score/score.h"
#include "tests/support/volume.h"

namespace binderjet::whole {

struct ScoreOfVolumes {
  JobScore score;
  std::vector<Fault> faults;
  std::vector<Region> regions(FaultKind kind) const {
    std::vector<Region> out;
    for (const Fault& fault : faults) {
      if (fault.kind == kind) out.push_back(fault.region);
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
  Scorer scorer(grid, 0);
  ScoreOfVolumes out;
  const auto take = [&](const std::vector<Fault>& faults) {
    out.faults.insert(out.faults.end(), faults.begin(), faults.end());
  };
  while (stream->rest().size() > 0) {
    for (const Shared<LayerScore>& layer : stream->next(block)) take(scorer.add(*layer));
  }
  out.score = scorer.finish();
  take(out.score.last_faults);
  return out;
}

}  // namespace binderjet::whole
