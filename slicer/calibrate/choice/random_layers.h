// SPDX-License-Identifier: GPL-3.0-or-later
// Layers that land at random: every layer has a shift of its own, and none of them follows from
// another.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "slicer/calibrate/residual/surface.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {

struct RandomLayers {
  std::array<double, 2> sigma_mm{};
  double p = 1;
  // Of the residual's power, what a shift per layer takes where the fit did not look.
  double share = 0;
};

// None if the layers are apart by next to nothing, or if their shifts follow each other: then they
// have a cause that depends on the height, and this is not it. `known` as for
// rank_candidates().
std::optional<RandomLayers> find_random_layers(const MeasuredJob& job, const EffectList& model,
                                               const std::vector<SurfacePoint>& points,
                                               const std::vector<std::vector<float>>& known);

}  // namespace binderjet
