// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/effects/model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slicer/error.h"
#include "slicer/opening.h"

namespace binderjet {
namespace {

ModelForm form_of(const std::vector<EffectSpec>& effects, const Grid& grid, const JobPlace& place) {
  ModelForm form;
  form.place = place;
  for (const EffectSpec& effect : effects) find_effect_kind(effect.kind)->add(effect, grid, form);
  return form;
}

}  // namespace

void ModelForm::bind_at(double new_level) {
  if (level > 0) {
    throw Error(ErrorKind::kBadInput, "effects",
                "powder is bound at two levels; keep one threshold or fill");
  }
  level = new_level;
}

void ModelForm::shift(std::function<std::array<double, 2>(const Spot&)> by_mm,
                      const std::array<double, 2>& most_mm) {
  placed.shifts.push_back({std::move(by_mm), std::max(std::abs(most_mm[0]), std::abs(most_mm[1]))});
}

void ModelForm::ask_density(double radius_mm) {
  if (placed.density_radius_mm && *placed.density_radius_mm != radius_mm) {
    throw Error(ErrorKind::kBadInput, "effects", "density is asked for with two radii; keep one");
  }
  placed.density_radius_mm = radius_mm;
}

Reach ModelForm::reach(const Grid& grid) const {
  Reach reach;
  for (const DoseTerm& term : terms) {
    reach.xy_vx[0] = std::max({reach.xy_vx[0], -term.x.first, term.x.last()});
    reach.xy_vx[1] = std::max({reach.xy_vx[1], -term.y.first, term.y.last()});
    reach.layers_below = std::max(reach.layers_below, -term.layer);
    reach.layers_above = std::max(reach.layers_above, term.layer);
  }
  for (const std::array<int, 2>& box : survive_vx) {
    for (std::size_t axis = 0; axis < 2; ++axis) reach.xy_vx[axis] += box[axis] - 1;
  }
  for (int axis = 0; axis < 2 && !placed.shifts.empty(); ++axis) {
    reach.xy_vx[static_cast<std::size_t>(axis)] += placed.most_shift_vx(grid, axis);
  }
  reach.layers_below = std::max(reach.layers_below, placed.density_layers(grid));
  reach.layers_above = std::max(reach.layers_above, placed.density_layers(grid));
  return reach;
}

PrinterModel::PrinterModel(const std::vector<EffectSpec>& effects, const Grid& grid,
                           const JobPlace& place)
    : PrinterModel(form_of(effects, grid, place), grid, place) {}

PrinterModel::PrinterModel(ModelForm form, const Grid& grid, const JobPlace& place)
    : repeat_{grid.detail_vx[0], grid.detail_vx[1]},
      form_(std::move(form)),
      reach_(form_.reach(grid)) {
  form_.place = place;
  if (form_.level <= 0) {
    throw Error(ErrorKind::kBadInput, "effects",
                "nothing binds powder: the model needs a threshold or a fill");
  }
  choose_filter(grid, place);
}

void PrinterModel::choose_filter(const Grid& grid, const JobPlace& place) {
  const DoseTerm& first = form_.terms.front();
  const auto x = as_box(first.x);
  const auto y = as_box(first.y);
  const bool anywhere = form_.placed.gains.empty() && form_.placed.shifts.empty();
  if (form_.terms.size() == 1 && first.layer == 0 && first.gain == 1 && x && y && anywhere) {
    box_ = OneBox{*x, *y, least_sum(*x, *y, form_.level)};
  } else {
    filter_.emplace(form_.terms, form_.level, grid, form_.placed, place);
  }
}

RunLayer PrinterModel::print(std::span<const RunLayer* const> window, int layer) const {
  RunLayer printed =
      box_ ? box_threshold(*window[window.size() / 2], repeat_, box_->x, box_->y, box_->least)
           : (*filter_)(window, layer);
  for (const std::array<int, 2>& box : form_.survive_vx) printed = opening(printed, box);
  return printed;
}

RunLayer PrinterModel::print(std::span<const Shared<RunLayer>> window, int layer) const {
  std::vector<const RunLayer*> masks;
  for (const Shared<RunLayer>& mask : window) masks.push_back(mask.get());
  return print(masks, layer);
}

RunLayer PrinterModel::print(const RunLayer& mask) const {
  std::vector<const RunLayer*> window(2 * static_cast<std::size_t>(window_reach()) + 1, nullptr);
  window[window.size() / 2] = &mask;
  return print(window);
}

}  // namespace binderjet
