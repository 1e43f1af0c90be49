// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "slicer/enhance/active_tiles.h"
#include "slicer/enhance/local_dose.h"
#include "slicer/enhance/pixel_search.h"
#include "slicer/score.h"
#include "slicer/slicing_operator.h"

namespace binderjet {
namespace {

using Window = std::span<const Shared<InverseLayer>>;

// Tiles overlap by this much, so that no pixel is settled before its neighbours have been seen.
constexpr int kOverlapPx = 4;
// Sweeps over a tile; trials end after 3 to 8.
constexpr int kMostSweeps = 20;
// A wrong voxel of the nominal model counts twice one of a corner of the window: this halves the
// nominal error of equal weights and costs the window's worst case a hundredth.
constexpr int kNominalWeight = 2;

std::vector<int> weights_of(const std::vector<PrinterModel>& models) {
  std::vector<int> weights(models.size(), 1);
  weights.front() = kNominalWeight;
  return weights;
}

const InverseLayer* layer_at(Window layers, int offset) {
  const int at = static_cast<int>(layers.size()) / 2 + offset;
  return at < 0 || at >= static_cast<int>(layers.size())
             ? nullptr
             : layers[static_cast<std::size_t>(at)].get();
}

// The layers whose print the mask of the middle one changes, and those whose masks have a part in
// that print, as offsets.
struct Offsets {
  std::set<int> printed;
  std::set<int> masks;
};

Offsets offsets_of(const ModelForm& form) {
  Offsets offsets;
  for (const DoseTerm& term : form.terms) offsets.printed.insert(-term.layer);
  for (const int printed : offsets.printed) {
    for (const DoseTerm& term : form.terms) offsets.masks.insert(printed + term.layer);
  }
  return offsets;
}

// Costs and masks of the layers around one tile.
class TileSurroundings : public Surroundings {
 public:
  // `own` is the mask of the middle layer.
  TileSurroundings(Window layers, const Offsets& offsets, const Plane<std::uint8_t>& own)
      : layers_(layers), offsets_(offsets), own_(own) {}

  void look_at(const Rect& voxels, const Rect& pixels, int rz) {
    for (const int offset : offsets_.printed) {
      const InverseLayer* layer = layer_at(layers_, offset);
      // Nobody asks what is printed beyond the job's ends.
      costs_[offset].reset(voxels, layer == nullptr ? 0 : rz);
      if (layer == nullptr) continue;
      for (const RunLayer& slice : layer->target->slices) add_layer(slice, -2, costs_[offset]);
    }
    for (const int offset : offsets_.masks) {
      if (offset == 0) continue;
      masks_[offset].reset(pixels, 0);
      const InverseLayer* layer = layer_at(layers_, offset);
      if (layer != nullptr) add_layer(*layer->mask, std::uint8_t{1}, masks_[offset]);
    }
  }

  const Plane<int>& cost(int layer) const override { return costs_.at(layer); }
  const Plane<std::uint8_t>& mask(int layer) const override {
    return layer == 0 ? own_ : masks_.at(layer);
  }

 private:
  Window layers_;
  const Offsets& offsets_;
  const Plane<std::uint8_t>& own_;
  std::map<int, Plane<int>> costs_;
  std::map<int, Plane<std::uint8_t>> masks_;
};

// The search on the middle one of a window of layers.
class LayerSearch {
 public:
  LayerSearch(Window layers, const Grid& grid, std::span<const StampedModel> models,
              const ModelForm& nominal, const MaskRules& rules)
      : layers_(layers),
        grid_(grid),
        models_(models),
        nominal_(nominal),
        rules_(rules),
        offsets_(offsets_of(nominal)) {}

  RunLayer run(bool anew) {
    const RunLayer& before = *layer_at(layers_, 0)->mask;
    box_ = {0, 0, before.width(), before.height()};
    const std::array<int, 2> margin = margins();
    mask_.reset(box_.grown(margin[0], margin[1]), 0);
    add_layer(before, std::uint8_t{1}, mask_);

    std::vector<Tile> tiles = find_tiles();
    for (Tile& tile : tiles) look_over(tile, anew);
    if (anew) {
      for (const Tile& tile : tiles) obey(rules_, tile.rect, mask_);
    }
    for (const Tile& tile : tiles) search(tile);
    return to_layer(mask_, before.width(), before.height());
  }

 private:
  struct Tile {
    Rect rect;
    std::vector<Pixel> pixels;  // where neither state is right whatever is around
  };

  // How far the mask must be known beyond the box.
  std::array<int, 2> margins() const {
    const TileSurroundings nothing(layers_, offsets_, mask_);
    const Rect one{0, 0, 1, 1};
    const Rect reach = LocalDose(models_, grid_, one, nothing).mask_rect();
    return {std::max({-reach.x0, reach.x1, rules_.most()}),
            std::max({-reach.y0, reach.y1, rules_.most()})};
  }

  std::vector<Tile> find_tiles() const {
    std::vector<const RunLayer*> slices;
    for (const int offset : offsets_.printed) {
      const InverseLayer* layer = layer_at(layers_, offset);
      if (layer == nullptr) continue;
      for (const RunLayer& slice : layer->target->slices) slices.push_back(&slice);
    }
    const TileSurroundings nothing(layers_, offsets_, mask_);
    const Rect reach = LocalDose(models_, grid_, {0, 0, 1, 1}, nothing).voxel_rect();
    const std::array<int, 2> reach_vx{std::max(-reach.x0, reach.x1), std::max(-reach.y0, reach.y1)};
    std::vector<Tile> tiles;
    for (const Rect& rect : active_tiles(slices, grid_, reach_vx)) {
      tiles.push_back({rect.grown(kOverlapPx, kOverlapPx).cut(box_), {}});
    }
    return tiles;
  }

  // Finds the pixels to search on. Where all a pixel can do is good or all is bad it is settled;
  // else, to begin with, it is on if a straight edge through what it reaches would want it on.
  void look_over(Tile& tile, bool anew) {
    TileSurroundings around(layers_, offsets_, mask_);
    const LocalDose dose(models_, grid_, tile.rect, around);
    around.look_at(dose.voxel_rect(), dose.mask_rect(), grid_.detail_vx[2]);
    double gains = 0;
    for (const DoseTerm& term : nominal_.terms) gains += term.gain;
    const double wanted = 1 - nominal_.level / gains;
    for (int y = tile.rect.y0; y < tile.rect.y1; ++y) {
      for (int x = tile.rect.x0; x < tile.rect.x1; ++x) {
        const PixelSight sight = dose.sight(x, y);
        const bool open = sight.least_cost < 0 && sight.most_cost > 0;
        if (open) tile.pixels.push_back({x, y});
        if (anew) *mask_.at(x, y) = open ? sight.wanted >= wanted : sight.least_cost < 0;
      }
    }
  }

  void search(const Tile& tile) {
    if (tile.pixels.empty()) return;
    TileSurroundings around(layers_, offsets_, mask_);
    LocalDose dose(models_, grid_, tile.rect, around);
    around.look_at(dose.voxel_rect(), dose.mask_rect(), grid_.detail_vx[2]);
    dose.reset();
    PixelSearch(dose, mask_, tile.pixels, rules_).run(kMostSweeps);
  }

  Window layers_;
  const Grid& grid_;
  std::span<const StampedModel> models_;
  const ModelForm& nominal_;
  const MaskRules& rules_;
  Offsets offsets_;
  Rect box_;
  Plane<std::uint8_t> mask_;
};

// How many voxels of the layer at `offset` come out wrong with these masks.
std::int64_t wrong(Window layers, int offset, const PrinterModel& model,
                   const std::function<const RunLayer*(const InverseLayer&, int offset)>& mask_of) {
  std::vector<const RunLayer*> masks;
  for (int near = offset - model.window_reach(); near <= offset + model.window_reach(); ++near) {
    const InverseLayer* layer = layer_at(layers, near);
    masks.push_back(layer == nullptr ? nullptr : mask_of(*layer, near));
  }
  const VoxelCounts counts = count_voxels(*layer_at(layers, offset)->target, model.print(masks));
  return counts.missing + counts.extra;
}

// No layer may print worse than plain masks do, or, where it already does, than it did.
bool acceptable(Window layers, const RunLayer& mask, const PrinterModel& model) {
  const std::set<int> printed = offsets_of(model.form()).printed;
  return std::all_of(printed.begin(), printed.end(), [&](int offset) {
    if (layer_at(layers, offset) == nullptr) return true;
    const std::int64_t now = wrong(layers, offset, model, [&](const InverseLayer& layer, int at) {
      return at == 0 ? &mask : layer.mask.get();
    });
    const std::int64_t plain = wrong(
        layers, offset, model, [](const InverseLayer& layer, int) { return layer.plain.get(); });
    if (now <= plain) return true;
    return now <= wrong(layers, offset, model,
                        [](const InverseLayer& layer, int) { return layer.mask.get(); });
  });
}

}  // namespace

InverseSolver::InverseSolver(std::vector<PrinterModel> window, const Grid& grid,
                             const MaskRules& rules)
    : models_(std::move(window)),
      grid_(grid),
      rules_(rules),
      stamped_(stamped(models_, weights_of(models_), grid)) {
  const std::set<int> printed = offsets_of(models_.front().form()).printed;
  stride_ = *printed.rbegin() - *printed.begin() + 1;
}

InverseLayer InverseSolver::plain(Shared<VoxelLayer> target) const {
  auto sliced = std::make_shared<const RunLayer>(slicing_operator(*target, grid_));
  if (rules_.most() <= 1) return {std::move(target), sliced, sliced};
  const Rect box{0, 0, sliced->width(), sliced->height()};
  Plane<std::uint8_t> mask(box.grown(rules_.most(), rules_.most()));
  add_layer(*sliced, std::uint8_t{1}, mask);
  obey(rules_, box, mask);
  return {std::move(target), sliced,
          std::make_shared<const RunLayer>(to_layer(mask, sliced->width(), sliced->height()))};
}

InverseLayer InverseSolver::improve(Window layers, bool anew) const {
  InverseLayer out = *layer_at(layers, 0);
  LayerSearch search(layers, grid_, stamped_, models_.front().form(), rules_);
  auto mask = std::make_shared<const RunLayer>(search.run(anew));
  if (acceptable(layers, *mask, models_.front())) out.mask = std::move(mask);
  return out;
}

}  // namespace binderjet
