// SPDX-License-Identifier: GPL-3.0-or-later
// Effects of the catalogue that move whole layers, or all of a print.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "slicer/calibrate/candidates/candidate_list.h"

namespace binderjet {
namespace {

using Basis = Column::Basis;
using Coefficients = std::span<const double>;

// Two columns: the mask shifted along x and along y by of(spot).
void add_shift(CandidateList& list, const std::string& kind, Covariate covariate, unsigned along,
               std::function<double(const Spot&)> of,
               std::function<EffectSpec(double, double)> effect) {
  list.add(kind, std::move(covariate), {{Basis::kShiftX, of, {}, 1}, {Basis::kShiftY, of, {}, 1}},
           along, [model = list.model(), effect](Coefficients c) {
             return with_effect(model, effect(c[0], c[1]));
           });
}

}  // namespace

void add_shift_candidates(CandidateList& list) {
  if (!list.has("shift")) {
    add_shift(list, "empirical", {"facing", "trend", {}}, kNowhere, {}, [](double x, double y) {
      return EffectSpec{"shift", {}, {{"by_mm", {x, y}}}};
    });
  }
  add_shift(
      list, "registration_drift", {"z", "trend", {}}, kAlongZ, [](const Spot& s) { return s.z_mm; },
      [](double x, double y) {
        return EffectSpec{"registration_drift", {}, {{"per_mm", {x, y}}}};
      });
  for (const double height_mm : {0.2, 0.4, 0.8, 1.6}) {
    add_shift(
        list, "layer_shift_low", {"z", "window", {{"from_mm", {0}}, {"to_mm", {2 * height_mm}}}},
        kAlongZ, [height_mm](const Spot& s) { return std::exp(-s.z_mm / height_mm); },
        [height_mm](double x, double y) {
          return EffectSpec{"layer_shift_low", {}, {{"by_mm", {x, y}}, {"height_mm", {height_mm}}}};
        });
  }
  add_shift(
      list, "parity", {"layer", "periodic", {{"period_layers", {2}}}}, kAlongZ,
      [](const Spot& s) { return s.layer % 2 == 0 ? 1.0 : -1.0; },
      [](double x, double y) {
        return EffectSpec{"parity", {}, {{"by_mm", {x, y}}}};
      });
  if (!list.has("scale_xyz")) {
    const std::array<double, 2> center{list.job().place.center_mm(0),
                                       list.job().place.center_mm(1)};
    list.add("scale_xyz", {"x", "trend", {}},
             {{Basis::kShiftX, [center](const Spot& s) { return s.x_mm - center[0]; }, {}, 1},
              {Basis::kShiftY, [center](const Spot& s) { return s.y_mm - center[1]; }, {}, 1}},
             kAlongX | kAlongY, [model = list.model()](Coefficients c) {
               return with_effect(model, {"scale_xyz", {}, {{"by", {c[0], c[1]}}}});
             });
  }
}

}  // namespace binderjet
