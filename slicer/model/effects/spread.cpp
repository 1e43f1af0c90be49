// SPDX-License-Identifier: GPL-3.0-or-later
// Binder spread (paper, 4.1): the binder of a pixel spreads around it, within its layer.
//
//   shape = "box":      evenly over a box
//         | "gaussian": as a normal distribution
//   width_mm = [x, y]: the box's width, or the full width at half the gaussian's height, so that
//   both are what an eye would call the width; above 0, at most 10
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

constexpr double kMaxMm = 10;

Kernel kernel(const EffectSpec& spec, const Grid& grid, int axis) {
  const double width_vx =
      spec.number("width_mm", static_cast<std::size_t>(axis)) / grid.voxel_mm(axis);
  return spec.words.at("shape") == "box" ? box_kernel(box_weights(width_vx))
                                         : gaussian_kernel(width_vx);
}

void write_into(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
  for (DoseTerm& term : form.terms) {
    term.x = kernel(spec, grid, 0);
    term.y = kernel(spec, grid, 1);
  }
}

// The declared spread, wider or narrower along one axis, or of the other shape.
void add_candidates(CandidateList& list) {
  const std::size_t place = list.own_place();
  if (place == list.model().size()) return;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto widened = [model = list.model(), place, axis](Coefficients c) {
      EffectList out = model;
      double& width = out[place].numbers["width_mm"][axis];
      width *= std::clamp(1 + c[0], 0.2, 4.0);
      return out;
    };
    constexpr double kStep = 0.05;
    Candidate& candidate = list.add(
        {axis == 0 ? Covariate::Axis::kX : Covariate::Axis::kY, Covariate::Form::kLocal},
        {{.basis = Column::Basis::kModel, .nudged = widened(std::array{kStep}), .step = kStep}},
        kNowhere, widened);
    candidate.kind = axis == 0 ? "kernel_x" : "kernel_y";
    candidate.effect = place;
  }
  if (list.model()[place].words.at("shape") != "box") return;
  const auto gaussian = [model = list.model(), place](Coefficients) {
    // The gaussian with the box's second moment.
    const double same_moment = 2 * std::sqrt(2 * std::log(2.0)) / std::sqrt(12.0);
    EffectList out = model;
    out[place].words["shape"] = "gaussian";
    for (double& width : out[place].numbers["width_mm"]) width *= same_moment;
    return out;
  };
  Candidate& candidate =
      list.add({Covariate::Axis::kX, Covariate::Form::kLocal},
               {{.basis = Column::Basis::kModel, .nudged = gaussian({})}}, kNowhere, gaussian);
  candidate.kind = "kernel_shape";
  candidate.effect = place;
}

void add_gauge_changes(const EffectList& declared, std::vector<GaugeChange>& out) {
  const EffectSpec* own = find_effect(declared, "spread");
  if (own == nullptr) return;
  const auto place = static_cast<std::size_t>(own - declared.data());
  out.push_back({"kernel_x", evenly(0.5, 3, 101),
                 [=](double factor) {
                   EffectList effects = declared;
                   for (double& width : effects[place].numbers["width_mm"]) width *= factor;
                   return effects;
                 },
                 [widths = own->pair("width_mm")](double factor) {
                   return fmt::format("binder spreads {:.2f} times as wide: {:.2f} x {:.2f} mm",
                                      factor, factor * widths[0], factor * widths[1]);
                 },
                 2});
}

}  // namespace

EffectKind spread_effect() {
  return {.name = "spread",
          .words = {{"shape", {"box", "gaussian"}}},
          .numbers = {{.name = "width_mm",
                       .count = 2,
                       .min = 0,
                       .max = kMaxMm,
                       .drift_share = 0.1,
                       .fit_share = 0.02}},
          .write_into = write_into,
          .examples = {{"spread", {{"shape", "box"}}, {{"width_mm", {0.9, 0.7}}}},
                       {"spread", {{"shape", "gaussian"}}, {{"width_mm", {0.4, 0.6}}}}},
          .add_candidates = add_candidates,
          .add_gauge_changes = add_gauge_changes};
}

}  // namespace binderjet
