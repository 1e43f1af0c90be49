// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/inverse_solver.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include "slicer/enhance/inverse/judge.h"
#include "slicer/enhance/inverse/search/mask_search.h"
#include "slicer/layers/rows.h"
#include "slicer/voxels/slicing_operator.h"

namespace binderjet {
namespace {

InverseLayer with_mask(InverseLayer layer, RunLayer mask) {
  layer.mask = std::make_shared<const RunLayer>(std::move(mask));
  return layer;
}

// The printer's dose of a voxel of the middle layer with `own` as its mask, term by term. For
// models that shift no mask.
double exact_dose(const AssembledModel& form, const Grid& grid, const LayerWindow& layers,
                  const RunLayer& own, int x_vx, int y_vx) {
  const auto [rx, ry, rz] = grid.detail_vx;
  double sum = 0;
  for (const DoseTerm& term : form.terms) {
    if (term.layer != 0 && layers.at(term.layer) == nullptr) continue;
    const RunLayer& mask = term.layer == 0 ? own : *layers.at(term.layer)->mask;
    std::int64_t landed = 0;
    for (int j = term.y.first; j <= term.y.last(); ++j) {
      for (int i = term.x.first; i <= term.x.last(); ++i) {
        const int x = x_vx - i;
        const int y = y_vx - j;
        const bool inside = x >= 0 && y >= 0 && x < rx * mask.width() && y < ry * mask.height();
        if (inside && mask.at(x / rx, y / ry)) landed += term.x.at(i) * term.y.at(j);
      }
    }
    const auto all = static_cast<double>(term.x.total()) * static_cast<double>(term.y.total());
    sum += term.gain * static_cast<double>(landed) / all;
  }
  return sum;
}

}  // namespace

InverseSolver::InverseSolver(std::vector<PrinterModel> window, const Grid& grid,
                             const MaskRules& rules)
    : window_(std::move(window)), search_(window_, rules, grid) {}

int InverseSolver::improve_reach() const { return 2 * search_.printer.window_reach(); }

int InverseSolver::print_reach() const { return search_.printer.window_reach(); }

int InverseSolver::repair_reach() const { return 2 * search_.printer.window_reach() + 2; }

int InverseSolver::stride() const {
  const std::set<int>& printed = search_.offsets.printed;
  return *printed.rbegin() - *printed.begin() + 1;
}

bool InverseSolver::sees_the_section_alone() const {
  const BedDependence& placed = search_.printer.form().placed;
  return search_.printer.window_reach() == 0 && placed.gains.empty() && placed.shifts.empty();
}

bool InverseSolver::follows_density() const {
  return search_.printer.form().placed.density_radius_mm.has_value();
}

InverseLayer InverseSolver::plain(int number, Shared<VoxelLayer> target) const {
  const RunLayer sliced = slicing_operator(*target, search_.grid);
  auto obeying = std::make_shared<const RunLayer>(obeying_mask(sliced, search_.rules).mask);
  return {std::move(target), obeying, obeying, number};
}

InverseLayer InverseSolver::improve(const LayerWindow& layers) const {
  const Judge judge(search_, layers);
  MaskSearch search(search_, layers);
  search.run();
  RunLayer mask = search.mask();
  constexpr int kMostRounds = 4;
  FoundFaults deep = judge.too_deep(mask);
  for (int round = 0; round < kMostRounds && deep.weight > 0; ++round) {
    search.run_again(deep.faults);
    mask = search.mask();
    deep = judge.too_deep(mask);
  }
  return with_mask(layers.middle(), judge.held(mask));
}

InverseLayer InverseSolver::print(const LayerWindow& layers) const {
  InverseLayer layer = layers.middle();
  layer.printed =
      std::make_shared<const RunLayer>(print_with(layers, 0, search_.printer, *layer.mask));
  return layer;
}

InverseLayer InverseSolver::find_broken(const LayerWindow& layers) const {
  InverseLayer layer = layers.middle();
  layer.broken = std::make_shared<const FoundFaults>(binderjet::find_broken(layers, search_.grid));
  layer.judged = prints_around(layers, 0, 1);
  return layer;
}

InverseLayer InverseSolver::repair(const LayerWindow& layers) const {
  InverseLayer layer = layers.middle();
  const int around = search_.printer.window_reach() + 1;
  bool sound = true;
  for (int at = -around; at <= around; ++at) {
    if (layers.at(at) == nullptr) continue;
    if (!is_known(layers, at) || layers.at(at)->broken->weight > 0) sound = false;
  }
  const bool alone = search_.printer.window_reach() == 0;
  if (alone && sound) return layer;
  std::vector<Shared<RunLayer>> seen = prints_around(layers, 0, around + 1);
  if (alone && layer.settled == seen) return layer;
  layer.settled = std::move(seen);

  const Judge judge(search_, layers);
  RunLayer best = *layer.mask;
  // Where layers couple, masks beside may have changed since this one was held.
  FoundFaults found = judge.broken();
  if (found.weight == 0) return layer;
  MaskSearch search(search_, layers);
  // What is mended may cost wrong voxels, but no more than so many for each that is at fault.
  constexpr std::int64_t kFaultWeight = 5;
  std::int64_t least = kFaultWeight * found.weight + judge.wrong_voxels(best);
  constexpr int kMostRounds = 30;  // with 10 some hard parts keep a fault
  for (int round = 0; round < kMostRounds && found.weight > 0; ++round) {
    search.run_again(found.faults);
    const RunLayer next = search.mask();
    found = judge.broken(next);
    // What is too deep goes back to the mask so far, and that may break it again.
    RunLayer held = judge.held(next);
    const std::int64_t weight = held == next ? found.weight : judge.broken(held).weight;
    const std::int64_t cost = kFaultWeight * weight + judge.wrong_voxels(held);
    if (cost >= least) continue;
    least = cost;
    best = std::move(held);
  }
  if (best == *layer.mask) return layer;
  layer = with_mask(layers.middle(), std::move(best));
  layer.printed =
      std::make_shared<const RunLayer>(print_with(layers, 0, search_.printer, *layer.mask));
  return layer;
}

PixelReasons InverseSolver::reasons(const LayerWindow& layers, int x, int y) const {
  const auto [rx, ry, rz] = search_.grid.detail_vx;
  const InverseLayer& layer = layers.middle();
  RunLayer flipped(layer.mask->width());
  RunLayer one(layer.mask->width());
  const int pixel[] = {x, x + 1};
  std::vector<int> row;
  for (int v = 0; v < layer.mask->height(); ++v) {
    rows::difference(layer.mask->row(v), v == y ? rows::Row(pixel) : rows::Row(), row);
    flipped.append_row(row);
    one.append_row(v == y ? rows::Row(pixel) : rows::Row());
  }

  PixelReasons why;
  why.on = layer.mask->at(x, y);
  why.level = search_.printer.form().level;
  const AssembledModel& form = search_.printer.form();
  const WindowPlaces places(search_.printer, search_.grid, layers, search_.offsets);
  Doses doses(search_, layers, one);
  const auto doses_of = [&](const RunLayer& mask) {
    doses.fill_nominal(mask);
    std::vector<double> out;
    for (int v = y * ry; v < (y + 1) * ry; ++v) {
      for (int u = x * rx; u < (x + 1) * rx; ++u) {
        out.push_back(places.shifts(0) != nullptr
                          ? doses.dose(u, v)
                          : places.gain(0, u, v) *
                                exact_dose(form, search_.grid, layers, mask, u, v));
      }
    }
    return out;
  };
  why.dose = doses_of(*layer.mask);
  why.dose_flipped = doses_of(flipped);
  int solid = 0;
  for (const RunLayer& slice : layer.target->slices) {
    for (int v = y * ry; v < (y + 1) * ry; ++v) {
      for (int u = x * rx; u < (x + 1) * rx; ++u) solid += static_cast<int>(slice.at(u, v));
    }
  }
  why.target_share = static_cast<double>(solid) / (rx * ry * rz);
  const auto grows = [&](const PrinterModel& model) {
    std::int64_t sum = 0;
    for (const int offset : search_.offsets.printed) {
      if (layers.at(offset) == nullptr) continue;
      sum += wrong_voxels(*layers.at(offset), print_with(layers, offset, model, flipped)) -
             wrong_voxels(*layers.at(offset), print_with(layers, offset, model, *layer.mask));
    }
    return static_cast<int>(sum);
  };
  why.nominal_cost = grows(window_.front());
  why.window_cost = kNominalWeight * why.nominal_cost;
  for (std::size_t m = 1; m < window_.size(); ++m) why.window_cost += grows(window_[m]);
  Plane<std::uint8_t> mask;
  const int most = search_.rules.largest_px();
  mask.reset(Rect{x, y, x + 1, y + 1}.grown(2 * most, 2 * most), 0);
  add_layer(flipped, std::uint8_t{1}, mask);
  why.rules_allow = RuleCheck(search_.rules).fits_around(mask, x, y);
  return why;
}

}  // namespace binderjet
