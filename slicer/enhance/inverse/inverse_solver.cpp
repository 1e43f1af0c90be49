// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/inverse_solver.h"

#include <cstdint>
#include <numeric>
#include <utility>

#include "slicer/enhance/inverse/repair/mask_patch.h"
#include "slicer/enhance/inverse/repair/spurious.h"
#include "slicer/enhance/inverse/search/layer_sets.h"
#include "slicer/enhance/inverse/search/tile_surroundings.h"
#include "slicer/voxels/slicing_operator.h"

namespace binderjet {
namespace {

// A wrong voxel of the nominal model counts twice one of a corner of the window: this halves the
// nominal error of equal weights and costs the window's worst case a hundredth.
constexpr int kNominalWeight = 2;

std::vector<StampedModel> weighted(const std::vector<PrinterModel>& models, const Grid& grid) {
  std::vector<int> weights(models.size(), 1);
  weights.front() = kNominalWeight;
  return stamped(models, weights, grid);
}

double level_share(const AssembledModel& form) {
  double gains = 0;
  for (const DoseTerm& term : form.terms) gains += term.gain;
  return form.level / gains;
}

}  // namespace

InverseSolver::InverseSolver(std::vector<PrinterModel> window, const Grid& grid,
                             const MaskRules& rules)
    : window_(window),
      search_{window.front(),
              weighted(window, grid),
              offsets_of(window.front().form()),
              level_share(window.front().form()),
              rules,
              grid} {
  const std::set<int>& printed = search_.offsets.printed;
  stride_ = *printed.rbegin() - *printed.begin() + 1;
}

InverseLayer InverseSolver::plain(int number, Shared<VoxelLayer> target) const {
  auto sliced = std::make_shared<const RunLayer>(slicing_operator(*target, search_.grid));
  auto obeying = std::make_shared<const RunLayer>(obeying_mask(*sliced, search_.rules).mask);
  return {std::move(target), std::move(sliced), std::move(obeying), {}, number};
}

InverseLayer InverseSolver::improve(LayerWindow layers, bool from_scratch) const {
  LayerSearch search(search_, layers);
  search.run(from_scratch);
  InverseLayer out = *layer_at(layers, 0);
  auto mask = std::make_shared<const RunLayer>(search.mask());
  if (no_worse_than_plain(layers, search_.printer, search_.offsets, *mask))
    out.mask = std::move(mask);
  return out;
}

InverseLayer InverseSolver::rescue(LayerWindow layers, RescueAim aim) const {
  return rescued(search_, window_, layers, aim);
}

InverseLayer InverseSolver::settle(LayerWindow layers) const {
  InverseLayer out = *layer_at(layers, 0);
  out.mask = without_spurious(layers);
  const bool worse = wrong_voxels(out, print_with(layers, 0, search_.printer, *out.mask)) >
                     wrong_voxels(out, print_plain(layers, 0, search_.printer));
  if (worse) out.mask = plain(out.number, out.target).mask;
  return out;
}

// Only the plain mask's pixels stay around what is printed where no part is, further and further
// until nothing is.
Shared<RunLayer> InverseSolver::without_spurious(LayerWindow layers) const {
  const InverseLayer& layer = *layer_at(layers, 0);
  Shared<RunLayer> mask = layer.mask;
  constexpr int kMaxPx = 32;
  for (int around_px = 2; around_px <= kMaxPx; around_px *= 2) {
    const RunLayer spurious =
        spurious_print(*layer.target, print_with(layers, 0, search_.printer, *mask));
    if (spurious.count() == 0) break;
    mask = std::make_shared<const RunLayer>(
        patched(*mask, common(*mask, *layer.plain),
                pixels_around(spurious, search_.grid, around_px), search_.rules));
  }
  return mask;
}

PixelReasons InverseSolver::reasons(LayerWindow layers, int x, int y) const {
  const auto [rx, ry, rz] = search_.grid.detail_vx;
  const Rect pixel{x, y, x + 1, y + 1};
  const Rect voxels{x * rx, y * ry, (x + 1) * rx, (y + 1) * ry};
  Plane<std::uint8_t> mask;
  const WindowPlaces places(search_.printer, search_.grid, layers, search_.offsets);
  TileSurroundings around(layers, search_.offsets, places, mask);
  LocalDose dose(search_.models, search_.grid, pixel, around);
  mask.reset(dose.mask_rect().grown(search_.rules.largest_px(), search_.rules.largest_px()), 0);
  add_layer(*layer_at(layers, 0)->mask, std::uint8_t{1}, mask);
  around.look_at(dose);
  dose.reset();

  PixelReasons why;
  std::uint8_t& state = *mask.at(x, y);
  const int sign = state != 0 ? -1 : 1;
  why.on = state != 0;
  why.level = search_.printer.form().level;
  Plane<int> solid(voxels);
  for (const RunLayer& slice : layer_at(layers, 0)->target->slices) add_layer(slice, 1, solid);
  const auto doses = [&] {
    std::vector<double> out;
    for (int v = voxels.y0; v < voxels.y1; ++v) {
      for (int u = voxels.x0; u < voxels.x1; ++u) out.push_back(dose.dose(u, v));
    }
    return out;
  };
  const int* first = solid.at(voxels.x0, voxels.y0);
  why.target_share = std::accumulate(first, first + std::ptrdiff_t{rx} * ry, 0.0) / (rx * ry * rz);
  why.nominal_cost = dose.nominal_cost(x, y, sign);
  why.window_cost = dose.flip_cost(x, y, sign);
  why.dose = doses();
  dose.flip(x, y, sign);
  state ^= 1;
  why.dose_flipped = doses();
  why.rules_allow = RuleCheck(search_.rules).fits_around(mask, x, y);
  return why;
}

}  // namespace binderjet
