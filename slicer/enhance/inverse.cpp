// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse.h"

#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
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

using FaultsByOffset = std::map<int, Shared<LayerFaults>>;

std::int64_t voxels(const FaultsByOffset& faults) {
  std::int64_t sum = 0;
  for (const auto& [offset, of] : faults) {
    for (const RunLayer& slice : of->gone.lost) sum += slice.count();
    for (const RunLayer& slice : of->gone.fused) sum += slice.count();
    sum += of->barren.count();
  }
  return sum;
}

// The pixels of each run of voxels and so many on each side.
std::vector<Rect> pixels_around(const RunLayer& voxels, const Grid& grid, int around_px) {
  const auto [rx, ry, rz] = grid.detail_vx;
  std::vector<Rect> out;
  for (int y = 0; y < voxels.height(); ++y) {
    const rows::Row row = voxels.row(y);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      const Rect run{row[i] / rx, y / ry, (row[i + 1] - 1) / rx + 1, y / ry + 1};
      out.push_back(run.grown(around_px, around_px));
    }
  }
  return out;
}

RunLayer united(const RunLayer& a, const RunLayer& b) {
  RunLayer sum(a.width());
  std::vector<int> row;
  for (int y = 0; y < a.height(); ++y) {
    rows::unite(a.row(y), b.row(y), row);
    sum.append_row(row);
  }
  return sum;
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
  const FaultsByOffset before = all_faults(layers, *out.mask);
  if (voxels(before) == 0) return out;
  if (before.contains(0)) out.stressed.push_back(before.at(0));
  std::vector<Shared<InverseLayer>> with_stress(layers.begin(), layers.end());
  std::vector<const RunLayer*> places;
  for (const auto& [offset, faults] : before) {
    InverseLayer layer = *layer_at(layers, offset);
    layer.stressed.push_back(faults);
    const auto middle = static_cast<std::ptrdiff_t>(layers.size() / 2);
    with_stress[static_cast<std::size_t>(middle + offset)] =
        std::make_shared<const InverseLayer>(std::move(layer));
    for (const RunLayer& slice : faults->gone.lost) places.push_back(&slice);
    for (const RunLayer& slice : faults->gone.fused) places.push_back(&slice);
    places.push_back(&faults->barren);
  }
  LayerSearch search(search_, with_stress);
  search.run_near(places);
  auto mask = std::make_shared<const RunLayer>(search.mask());
  if (voxels(all_faults(layers, *mask)) < voxels(before) && acceptable(layers, *mask)) {
    out.mask = std::move(mask);
  }
  return out;
}

InverseLayer InverseSolver::settle(LayerWindow layers) const {
  InverseLayer out = *layer_at(layers, 0);
  out.mask = without_spurious(layers);
  const bool worse = wrong(out, print_with(layers, 0, search_.printer, *out.mask)) >
                     wrong(out, print_plain(layers, 0, search_.printer));
  if (worse) out.mask = plain(out.number, out.target).mask;
  return out;
}

// Only the plain mask's pixels stay around what is printed where no part is, further and further
// until nothing is.
Shared<RunLayer> InverseSolver::without_spurious(LayerWindow layers) const {
  const InverseLayer& layer = *layer_at(layers, 0);
  Shared<RunLayer> mask = layer.mask;
  const Rect box{0, 0, mask->width(), mask->height()};
  constexpr int kMostPx = 32;
  for (int around_px = 2; around_px <= kMostPx; around_px *= 2) {
    const RunLayer spurious =
        spurious_print(*layer.target, print_with(layers, 0, search_.printer, *mask));
    if (spurious.count() == 0) break;
    Plane<std::uint8_t> plain(box);
    add_layer(*layer.plain, std::uint8_t{1}, plain);
    const int most = search_.rules.most();
    Plane<std::uint8_t> pixels(box.grown(most, most));
    add_layer(*mask, std::uint8_t{1}, pixels);
    for (const Rect& near : pixels_around(spurious, search_.grid, around_px)) {
      const Rect rect = near.cut(box);
      for (int y = rect.y0; y < rect.y1; ++y) {
        for (int x = rect.x0; x < rect.x1; ++x) *pixels.at(x, y) &= *plain.at(x, y);
      }
    }
    obey(search_.rules, box, pixels);
    mask = std::make_shared<const RunLayer>(to_layer(pixels, box.x1, box.y1));
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

// As `score` finds them.
LayerFaults InverseSolver::faults(LayerWindow layers, int offset, const RunLayer& mask) const {
  std::array<std::optional<ComparedLayer>, 3> compared;
  std::array<const ComparedLayer*, 3> seen{};
  for (int near = -1; near <= 1; ++near) {
    const InverseLayer* layer = layer_at(layers, offset + near);
    if (layer == nullptr) continue;
    const auto at = static_cast<std::size_t>(near + 1);
    compared[at] = ComparedLayer{layer->target, std::make_shared<const RunLayer>(print_with(
                                                    layers, offset + near, search_.printer, mask))};
    seen[at] = &*compared[at];
  }
  const VoxelLayer& target = *seen[1]->target;
  LayerFaults out{find_features(seen[0], *seen[1], seen[2], search_.grid),
                  spurious_print(target, *seen[1]->printed)};
  for (const PrinterModel& model : std::span(window_).subspan(1)) {
    const RunLayer more = spurious_print(target, print_with(layers, offset, model, mask));
    if (more.count() > 0) out.barren = united(out.barren, more);
  }
  return out;
}

FaultsByOffset InverseSolver::all_faults(LayerWindow layers, const RunLayer& mask) const {
  FaultsByOffset out;
  for (const int offset : search_.offsets.printed) {
    if (layer_at(layers, offset) == nullptr) continue;
    out.emplace(offset, std::make_shared<const LayerFaults>(faults(layers, offset, mask)));
  }
  return out;
}

}  // namespace binderjet
