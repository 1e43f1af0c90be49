// SPDX-License-Identifier: GPL-3.0-or-later
// Jitter: each layer lands at random beside its place. No mask can make that good, and the print to
// expect is the one without it; the profile keeps how far, for who judges a print.
//
//   sigma_mm = [x, y]: standard deviation of the layers' shifts, 0 to 5
#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

EffectSpec effect(const std::array<double, 2>& sigma_mm) {
  return {"jitter", {}, {{"sigma_mm", {sigma_mm[0], sigma_mm[1]}}}};
}

}  // namespace

EffectKind jitter_effect() {
  return {.name = "jitter",
          .numbers = {{.name = "sigma_mm", .count = 2, .min = -1e-9, .max = 5}},
          .write_into = [](const EffectSpec&, const Grid&, AssembledModel&) {},
          .examples = {effect({0.1, 0.05})},
          .random_layers = effect};
}

}  // namespace binderjet
