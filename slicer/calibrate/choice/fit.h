// SPDX-License-Identifier: GPL-3.0-or-later
// Refits the numbers of a model to a measured print: Gauss-Newton on the missing dose with the real
// forward model, and the printed error decides whether a step is taken.
#pragma once

#include <string>
#include <vector>

#include "slicer/calibrate/residual/surface.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {

// A number of the model that a fit may move.
struct FreeNumber {
  std::size_t effect = 0;  // its place in the model
  std::string name;
  std::size_t index = 0;
  double step = 0;  // a move that the print shows
};
std::vector<FreeNumber> free_numbers(const EffectList& model, std::size_t effect);

// d(dose - level) / d(number) at each point, per step.
std::vector<std::vector<float>> slopes(const MeasuredJob& job, const EffectList& model,
                                       const std::vector<SurfacePoint>& points,
                                       const std::vector<FreeNumber>& numbers);

// What a scanner adds and no printer is to blame for: the rest of a shift and of a turn, blur.
// One column each; none for prints that were not scanned.
std::vector<std::vector<float>> scanner_columns(const MeasuredJob& job, const EffectList& model,
                                                const std::vector<SurfacePoint>& points);

// The model with these numbers refitted on the chosen layers in at most `rounds` steps; never worse
// there than it was.
EffectList refit(const MeasuredJob& job, EffectList model, const std::vector<FreeNumber>& numbers,
                 const LayerChoice& layers, int rounds);

}  // namespace binderjet
