// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse.h"

#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

#include "slicer/enhance/spurious.h"
#include "slicer/enhance/tile_surroundings.h"
#include "slicer/rows.h"
#include "slicer/score.h"
#include "slicer/slicing_operator.h"

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

double level_share(const ModelForm& form) {
  double gains = 0;
  for (const DoseTerm& term : form.terms) gains += term.gain;
  return form.level / gains;
}

std::int64_t wrong(const InverseLayer& layer, const RunLayer& printed) {
  const VoxelCounts counts = count_voxels(*layer.target, printed);
  return counts.missing + counts.extra;
}

std::int64_t voxels(const LayerFeatures& features) {
  std::int64_t sum = 0;
  for (const RunLayer& slice : features.lost) sum += slice.count();
  for (const RunLayer& slice : features.fused) sum += slice.count();
  return sum;
}

}  // namespace

InverseSolver::InverseSolver(std::vector<PrinterModel> window, const Grid& grid,
                             const MaskRules& rules)
    : search_{window.front(),
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
  const int most = search_.rules.most();
  if (most <= 1) return {std::move(target), sliced, sliced, {}, number};
  const Rect box{0, 0, sliced->width(), sliced->height()};
  Plane<std::uint8_t> mask(box.grown(most, most));
  add_layer(*sliced, std::uint8_t{1}, mask);
  obey(search_.rules, box, mask);
  return {std::move(target),
          sliced,
          std::make_shared<const RunLayer>(to_layer(mask, sliced->width(), sliced->height())),
          {},
          number};
}

InverseLayer InverseSolver::improve(LayerWindow layers, bool anew) const {
  LayerSearch search(search_, layers);
  search.run(anew);
  InverseLayer out = *layer_at(layers, 0);
  auto mask = std::make_shared<const RunLayer>(search.mask());
  if (acceptable(layers, *mask)) out.mask = std::move(mask);
  return out;
}

InverseLayer InverseSolver::rescue(LayerWindow layers) const {
  InverseLayer out = *layer_at(layers, 0);
  auto gone = std::make_shared<const LayerFeatures>(vanished(layers, *out.mask));
  if (voxels(*gone) == 0) return out;
  out.stressed.push_back(gone);
  std::vector<Shared<InverseLayer>> with_stress(layers.begin(), layers.end());
  with_stress[layers.size() / 2] = std::make_shared<const InverseLayer>(out);
  LayerSearch search(search_, with_stress);
  search.run_near(*gone);
  auto mask = std::make_shared<const RunLayer>(search.mask());
  if (voxels(vanished(layers, *mask)) < voxels(*gone) && acceptable(layers, *mask)) {
    out.mask = std::move(mask);
  }
  return out;
}

InverseLayer InverseSolver::settle(LayerWindow layers) const {
  InverseLayer out = *layer_at(layers, 0);
  const bool worse = wrong(out, print_with(layers, 0, search_.printer, *out.mask)) >
                     wrong(out, print_plain(layers, 0, search_.printer));
  if (worse) out.mask = plain(out.number, out.target).mask;
  return out;
}

PixelReasons InverseSolver::reasons(LayerWindow layers, int x, int y) const {
  const auto [rx, ry, rz] = search_.grid.detail_vx;
  const Rect pixel{x, y, x + 1, y + 1};
  const Rect voxels{x * rx, y * ry, (x + 1) * rx, (y + 1) * ry};
  Plane<std::uint8_t> mask;
  const WindowPlaces places(search_.printer, search_.grid, layers, search_.offsets);
  TileSurroundings around(layers, search_.offsets, places, mask);
  LocalDose dose(search_.models, search_.grid, pixel, around);
  mask.reset(dose.mask_rect().grown(search_.rules.most(), search_.rules.most()), 0);
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
  why.target_share = std::accumulate(first, first + rx * ry, 0.0) / (rx * ry * rz);
  why.nominal_cost = dose.nominal_cost(x, y, sign);
  why.window_cost = dose.flip_cost(x, y, sign);
  why.dose = doses();
  dose.flip(x, y, sign);
  state ^= 1;
  why.dose_flipped = doses();
  why.rules_allow = RuleCheck(search_.rules).fits_around(mask, x, y);
  return why;
}

bool InverseSolver::acceptable(LayerWindow layers, const RunLayer& mask) const {
  const std::set<int>& printed = search_.offsets.printed;
  return std::all_of(printed.begin(), printed.end(), [&](int offset) {
    const InverseLayer* layer = layer_at(layers, offset);
    if (layer == nullptr) return true;
    const std::int64_t now = wrong(*layer, print_with(layers, offset, search_.printer, mask));
    if (now <= wrong(*layer, print_plain(layers, offset, search_.printer))) return true;
    const RunLayer& before = *layer_at(layers, 0)->mask;
    return now <= wrong(*layer, print_with(layers, offset, search_.printer, before));
  });
}

// Lost and fused voxels of the middle layer with this mask, as `score` finds them; what is printed
// where no part is counts as fused.
LayerFeatures InverseSolver::vanished(LayerWindow layers, const RunLayer& mask) const {
  std::array<std::optional<ComparedLayer>, 3> compared;
  std::array<const ComparedLayer*, 3> seen{};
  for (int offset = -1; offset <= 1; ++offset) {
    const InverseLayer* layer = layer_at(layers, offset);
    if (layer == nullptr) continue;
    const auto at = static_cast<std::size_t>(offset + 1);
    compared[at] = ComparedLayer{layer->target, std::make_shared<const RunLayer>(print_with(
                                                    layers, offset, search_.printer, mask))};
    seen[at] = &*compared[at];
  }
  LayerFeatures gone = find_features(seen[0], *seen[1], seen[2], search_.grid);
  const RunLayer spurious = spurious_print(*seen[1]->target, *seen[1]->printed);
  std::vector<int> both;
  for (RunLayer& slice : gone.fused) {
    RunLayer sum(slice.width());
    for (int y = 0; y < slice.height(); ++y) {
      rows::unite(slice.row(y), spurious.row(y), both);
      sum.append_row(both);
    }
    slice = std::move(sum);
  }
  return gone;
}

}  // namespace binderjet
