// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/printer_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slicer/base/error.h"
#include "slicer/model/effects/level.h"

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
                "nothing binds powder: the model needs " + kinds_with_level("a "));
  }
  choose_filter(grid, place);
}

void PrinterModel::choose_filter(const Grid& grid, const JobPlace& place) {
  const DoseTerm& first = form_.terms.front();
  const auto x = as_box(first.x);
  const auto y = as_box(first.y);
  const BedDependence& placed = form_.placed;
  const bool anywhere = placed.gains.empty() && placed.shifts.empty() && placed.weak_drops.empty();
  if (form_.terms.size() == 1 && first.layer == 0 && first.gain == 1 && x && y && anywhere) {
    filter_ = OneBox{*x, *y, min_sum(*x, *y, form_.level)};
  } else {
    filter_.emplace<DoseFilter>(form_.terms, form_.level, grid, form_.placed, place);
  }
}

RunLayer PrinterModel::bind(const RunWindow& window, int layer) const {
  const AssembledModel::Received received = form_.received(window, layer);
  const auto* box = std::get_if<OneBox>(&filter_);
  return box != nullptr
             ? box_threshold(received.masks.middle(), repeat_, box->x, box->y, box->least)
             : std::get<DoseFilter>(filter_)(received.masks, layer);
}

int PrinterModel::wear_reach() const {
  int reach = 0;
  for (const Wear& step : form_.wear) reach += step.reach.layers_below;
  return reach;
}

// Each step of wear leaves a window that is smaller by its reach.
RunLayer PrinterModel::worn(const RunWindow& bound) const {
  RunWindow layers = bound;
  std::vector<RunLayer> done;
  for (const Wear& step : form_.wear) {
    const int reach = layers.reach() - step.reach.layers_below;
    std::vector<RunLayer> next(2 * static_cast<std::size_t>(reach) + 1);
    RunWindow next_layers = RunWindow::around(reach, [&](int offset) -> const RunLayer* {
      if (layers.at(offset) == nullptr) return nullptr;
      RunLayer& out = next[static_cast<std::size_t>(offset + reach)];
      out = step.apply(layers.part(offset, step.reach.layers_below));
      return &out;
    });
    done = std::move(next);
    layers = std::move(next_layers);
  }
  return std::move(done.front());
}

RunLayer PrinterModel::print(const RunWindow& window, int layer) const {
  if (form_.wear.empty()) return bind(window, layer);
  const int around = wear_reach();
  std::vector<RunLayer> bound(2 * static_cast<std::size_t>(around) + 1);
  return worn(RunWindow::around(around, [&](int offset) -> const RunLayer* {
    if (window.at(offset) == nullptr) return nullptr;
    RunLayer& out = bound[static_cast<std::size_t>(offset + around)];
    out = bind(window.part(offset, bind_reach()), layer + offset);
    return &out;
  }));
}

RunLayer PrinterModel::print(const RunLayer& mask) const {
  return print(
      RunWindow::around(window_reach(), [&](int offset) { return offset == 0 ? &mask : nullptr; }));
}

}  // namespace binderjet
