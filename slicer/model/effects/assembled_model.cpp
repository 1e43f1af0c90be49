// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/assembled_model.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "slicer/base/error.h"
#include "slicer/model/effects/catalogue.h"
#include "slicer/model/effects/level.h"

namespace binderjet {

void AssembledModel::bind_at(double new_level) {
  if (level > 0) {
    throw Error(ErrorKind::kBadInput, "effects",
                "powder is bound at two levels; keep one " + kinds_with_level());
  }
  level = new_level;
}

void AssembledModel::shift(std::function<std::array<double, 2>(const Spot&)> by_mm,
                           const std::array<double, 2>& max_mm) {
  placed.shifts.push_back({std::move(by_mm), std::max(std::abs(max_mm[0]), std::abs(max_mm[1]))});
}

void AssembledModel::wear_first(Wear step) {
  const auto after =
      std::find_if(wear.begin(), wear.end(), [](const Wear& other) { return !other.keeps_edges; });
  step.keeps_edges = true;
  wear.insert(after, std::move(step));
}

void AssembledModel::ask_density(double radius_mm) {
  if (placed.density_radius_mm && *placed.density_radius_mm != radius_mm) {
    throw Error(ErrorKind::kBadInput, "effects", "density is asked for with two radii; keep one");
  }
  placed.density_radius_mm = radius_mm;
}

Reach AssembledModel::reach(const Grid& grid) const {
  Reach reach;
  for (const DoseTerm& term : terms) {
    reach.xy_vx[0] = std::max({reach.xy_vx[0], -term.x.first, term.x.last()});
    reach.xy_vx[1] = std::max({reach.xy_vx[1], -term.y.first, term.y.last()});
    reach.layers_below = std::max(reach.layers_below, -term.layer);
    reach.layers_above = std::max(reach.layers_above, term.layer);
  }
  for (int axis = 0; axis < 2 && !placed.shifts.empty(); ++axis) {
    reach.xy_vx[static_cast<std::size_t>(axis)] += placed.max_shift_vx(grid, axis);
  }
  reach.layers_below = std::max(reach.layers_below, placed.density_layers(grid));
  reach.layers_above = std::max(reach.layers_above, placed.density_layers(grid));
  for (const Wear& step : wear) {
    for (std::size_t axis = 0; axis < 2; ++axis) reach.xy_vx[axis] += step.reach.xy_vx[axis];
    reach.layers_below += step.reach.layers_below;
    reach.layers_above += step.reach.layers_above;
  }
  for (const LayerMove& move : moves) {
    reach.layers_below += move.most;
    reach.layers_above += move.most;
  }
  return reach;
}

AssembledModel::Received AssembledModel::received(const RunWindow& window, int layer) const {
  if (moves.empty()) return {window, nullptr};
  std::shared_ptr<const RunLayer> powder;
  RunWindow masks = RunWindow::around(window.reach(), [&](int offset) -> const RunLayer* {
    int from = offset;
    for (const LayerMove& move : moves) from += move.by(layer + offset);
    const RunLayer* mask = std::abs(from) <= window.reach() ? window.at(from) : nullptr;
    if (offset != 0 || mask != nullptr || window.at(0) == nullptr) return mask;
    powder = std::make_shared<const RunLayer>(
        RunLayer::powder(window.middle().width(), window.middle().height()));
    return powder.get();
  });
  return {std::move(masks), std::move(powder)};
}

AssembledModel assemble(const EffectList& effects, const Grid& grid, const JobPlace& place) {
  AssembledModel form;
  form.place = place;
  for (const EffectSpec& effect : effects) {
    find_effect_kind(effect.kind)->write_into(effect, grid, form);
  }
  return form;
}

}  // namespace binderjet
