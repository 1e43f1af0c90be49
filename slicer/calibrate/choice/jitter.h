// SPDX-License-Identifier: GPL-3.0-or-later
// Layers that land at random: every layer has a shift of its own, and none of them follows from
// another.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "slicer/calibrate/candidates/candidate.h"
#include "slicer/calibrate/residual/surface.h"

namespace binderjet {

struct Jitter {
  std::array<double, 2> sigma_mm{};
  double p = 1;
  double share =
      0;  // of the residual's power that shifts per layer take where the fit did not look
};

// None if the layers are apart by next to nothing, or if their shifts follow each other: then they
// have a cause that depends on the height, and this is not it. `known` as for choose().
std::optional<Jitter> find_jitter(const MeasuredJob& job, const EffectList& model,
                                  const std::vector<SurfacePoint>& points,
                                  const std::vector<std::vector<float>>& known);

}  // namespace binderjet
