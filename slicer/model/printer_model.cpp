// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/printer_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slicer/base/error.h"

namespace binderjet {

PrinterModel::PrinterModel(const std::vector<EffectSpec>& effects, const Grid& grid,
                           const JobPlace& place)
    : PrinterModel(assemble(effects, grid, place), grid, place) {}

PrinterModel::PrinterModel(AssembledModel form, const Grid& grid, const JobPlace& place)
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
  const PlacedDose& placed = form_.placed;
  const bool anywhere = placed.gains.empty() && placed.shifts.empty() && placed.weak_drops.empty();
  if (form_.terms.size() == 1 && first.layer == 0 && first.gain == 1 && x && y && anywhere) {
    filter_ = OneBox{*x, *y, least_sum(*x, *y, form_.level)};
  } else {
    filter_.emplace<DoseFilter>(form_.terms, form_.level, grid, form_.placed, place);
  }
}

RunLayer PrinterModel::bind(std::span<const RunLayer* const> window, int layer) const {
  const AssembledModel::Received masks = form_.received(window, layer);
  const auto* box = std::get_if<OneBox>(&filter_);
  return box != nullptr ? box_threshold(*masks.masks[masks.masks.size() / 2], repeat_, box->x,
                                        box->y, box->least)
                        : std::get<DoseFilter>(filter_)(masks.masks, layer);
}

int PrinterModel::wear_reach() const {
  int reach = 0;
  for (const Wear& step : form_.wear) reach += step.reach.layers_below;
  return reach;
}

RunLayer PrinterModel::worn(std::span<const RunLayer* const> bound) const {
  std::vector<const RunLayer*> layers(bound.begin(), bound.end());
  std::vector<RunLayer> done;
  for (const Wear& step : form_.wear) {
    const auto span = 2 * static_cast<std::size_t>(step.reach.layers_below) + 1;
    const std::size_t count = layers.size() - span + 1;
    std::vector<RunLayer> next(count);
    std::vector<const RunLayer*> next_layers(count, nullptr);
    for (std::size_t first = 0; first < count; ++first) {
      if (layers[first + span / 2] == nullptr) continue;
      next[first] = step.apply(std::span<const RunLayer* const>(layers).subspan(first, span));
      next_layers[first] = &next[first];
    }
    done = std::move(next);
    layers = std::move(next_layers);
  }
  return std::move(done.front());
}

RunLayer PrinterModel::print(std::span<const RunLayer* const> window, int layer) const {
  if (form_.wear.empty()) return bind(window, layer);
  const int around = wear_reach();
  const auto count = 2 * static_cast<std::size_t>(bind_reach()) + 1;
  // The window may be larger than this model asks for.
  window = window.subspan(window.size() / 2 - static_cast<std::size_t>(window_reach()),
                          2 * static_cast<std::size_t>(window_reach()) + 1);
  std::vector<RunLayer> bound(2 * static_cast<std::size_t>(around) + 1);
  std::vector<const RunLayer*> layers(bound.size(), nullptr);
  for (std::size_t i = 0; i < bound.size(); ++i) {
    const auto part = window.subspan(i, count);
    if (part[count / 2] == nullptr) continue;
    bound[i] = bind(part, layer + static_cast<int>(i) - around);
    layers[i] = &bound[i];
  }
  return worn(layers);
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
