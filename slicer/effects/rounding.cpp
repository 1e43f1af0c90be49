// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/effects/rounding.h"

#include <cmath>
#include <memory>

#include "slicer/effects/model.h"
#include "slicer/morphology.h"

namespace binderjet {
namespace {

void add_ball(double radius_mm, const Grid& grid, ModelForm& form) {
  const Ellipsoid ball(radius_mm, grid);
  const auto [x, y, z] = ball.reach();
  const Reach reach{{x, y}, z, z};
  form.wear.push_back({reach, [ball](std::span<const RunLayer* const> window) {
                         return eroded(window, ball, Beyond::kPowder);
                       }});
  form.wear.push_back(
      {reach, [ball](std::span<const RunLayer* const> window) { return dilated(window, ball); }});
}

Kernel gaussian(double sigma_vx) {
  return gaussian_kernel(sigma_vx * 2 * std::sqrt(2 * std::log(2.0)));
}

void add_gaussian(double radius_mm, const Grid& grid, ModelForm& form) {
  // The printed voxels are the masks of one more dose and threshold.
  Grid voxels = grid;
  for (int axis = 0; axis < 2; ++axis) {
    voxels.pitch_mm[static_cast<std::size_t>(axis)] = grid.voxel_mm(axis);
  }
  voxels.detail_vx = {1, 1, 1};
  const Kernel x = gaussian(radius_mm / voxels.pitch_mm[0]);
  const Kernel y = gaussian(radius_mm / voxels.pitch_mm[1]);
  const Kernel z = gaussian(radius_mm / voxels.pitch_mm[2]);
  std::vector<DoseTerm> terms;
  for (int k = z.first; k <= z.last(); ++k) {
    terms.push_back({k, x, y, static_cast<double>(z.at(k)) / static_cast<double>(z.total())});
  }
  // Kernels are rounded to whole weights: a flat face must not move by that.
  constexpr double kHalf = 0.5 - 1e-5;
  const auto filter = std::make_shared<const DoseFilter>(terms, kHalf, voxels);
  form.wear.push_back(
      {{{x.last(), y.last()}, z.last(), z.last()},
       [filter](std::span<const RunLayer* const> window) { return (*filter)(window); }});
}

void add(const EffectSpec& spec, const Grid& grid, ModelForm& form) {
  const double radius_mm = spec.number("radius_mm");
  if (spec.words.at("shape") == "ball") {
    add_ball(radius_mm, grid, form);
  } else {
    add_gaussian(radius_mm, grid, form);
  }
}

}  // namespace

EffectKind rounding_kind() {
  return {"rounding", {{"shape", {"ball", "gaussian"}}}, {{"radius_mm", 1, 0, 0.5}}, add};
}

}  // namespace binderjet
