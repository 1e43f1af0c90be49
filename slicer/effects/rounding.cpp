// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/effects/rounding.h"

#include <cmath>
#include <utility>

#include "slicer/effects/model.h"

namespace binderjet {
namespace {

// A kernel followed by a gaussian of this standard deviation in voxels.
Kernel smoothed(const Kernel& kernel, double sigma_vx) {
  const Kernel gauss = gaussian_kernel(sigma_vx * 2 * std::sqrt(2 * std::log(2.0)));
  // Weights stay small enough for the sums of the dose.
  constexpr double kTotal = 1 << 20;
  std::vector<double> sum(kernel.weights.size() + gauss.weights.size() - 1, 0);
  for (std::size_t i = 0; i < kernel.weights.size(); ++i) {
    for (std::size_t j = 0; j < gauss.weights.size(); ++j) {
      sum[i + j] += static_cast<double>(kernel.weights[i]) * static_cast<double>(gauss.weights[j]);
    }
  }
  const double total =
      static_cast<double>(kernel.total()) * static_cast<double>(gauss.total()) / kTotal;
  Kernel out{kernel.first + gauss.first, {}};
  for (const double weight : sum) out.weights.push_back(std::llround(weight / total));
  return out;
}

void add(const EffectSpec& spec, const Grid& grid, ModelForm& form) {
  const double radius_mm = spec.number("radius_mm");
  const Kernel up =
      gaussian_kernel(radius_mm / grid.pitch_mm[2] * 2 * std::sqrt(2 * std::log(2.0)));
  const auto total = static_cast<double>(up.total());
  std::vector<DoseTerm> terms;
  for (DoseTerm term : form.terms) {
    term.x = smoothed(term.x, radius_mm / grid.voxel_mm(0));
    term.y = smoothed(term.y, radius_mm / grid.voxel_mm(1));
    for (int j = up.first; j <= up.last(); ++j) {
      DoseTerm beside = term;
      beside.layer += j;
      beside.gain *= static_cast<double>(up.at(j)) / total;
      if (beside.gain > 0) terms.push_back(beside);
    }
  }
  form.terms = std::move(terms);
}

}  // namespace

EffectKind rounding_kind() { return {"rounding", {}, {{"radius_mm", 1, 0, 0.5}}, add}; }

}  // namespace binderjet
