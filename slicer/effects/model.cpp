// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/effects/model.h"

#include <algorithm>
#include <utility>

#include "slicer/error.h"
#include "slicer/opening.h"

namespace binderjet {
namespace {

ModelForm form_of(const std::vector<EffectSpec>& effects, const Grid& grid) {
  ModelForm form;
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

Reach ModelForm::reach() const {
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
  return reach;
}

PrinterModel::PrinterModel(const std::vector<EffectSpec>& effects, const Grid& grid)
    : PrinterModel(form_of(effects, grid), grid) {}

PrinterModel::PrinterModel(ModelForm form, const Grid& grid)
    : repeat_{grid.detail_vx[0], grid.detail_vx[1]}, form_(std::move(form)), reach_(form_.reach()) {
  if (form_.level <= 0) {
    throw Error(ErrorKind::kBadInput, "effects",
                "nothing binds powder: the model needs a threshold or a fill");
  }
  choose_filter();
}

void PrinterModel::choose_filter() {
  const DoseTerm& first = form_.terms.front();
  const auto x = as_box(first.x);
  const auto y = as_box(first.y);
  if (form_.terms.size() == 1 && first.layer == 0 && first.gain == 1 && x && y) {
    box_ = OneBox{*x, *y, least_sum(*x, *y, form_.level)};
  } else {
    filter_.emplace(form_.terms, form_.level, repeat_);
  }
}

RunLayer PrinterModel::print(std::span<const RunLayer* const> window) const {
  RunLayer printed =
      box_ ? box_threshold(*window[window.size() / 2], repeat_, box_->x, box_->y, box_->least)
           : (*filter_)(window);
  for (const std::array<int, 2>& box : form_.survive_vx) printed = opening(printed, box);
  return printed;
}

RunLayer PrinterModel::print(std::span<const Shared<RunLayer>> window) const {
  std::vector<const RunLayer*> masks;
  for (const Shared<RunLayer>& mask : window) masks.push_back(mask.get());
  return print(masks);
}

RunLayer PrinterModel::print(const RunLayer& mask) const {
  std::vector<const RunLayer*> window(2 * static_cast<std::size_t>(window_reach()) + 1, nullptr);
  window[window.size() / 2] = &mask;
  return print(window);
}

}  // namespace binderjet
