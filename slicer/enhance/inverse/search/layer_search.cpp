// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/layer_search.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "slicer/enhance/inverse/search/change_count.h"
#include "slicer/enhance/inverse/search/search_tiles.h"
#include "slicer/enhance/inverse/search/tile_surroundings.h"
#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

// Tiles overlap by this much, so that no pixel is settled before its neighbors have been seen.
constexpr int kOverlapPx = 4;
// Sweeps over a tile; trials end after 3 to 8.
constexpr int kMaxSweeps = 20;

// What a pixel can do, the short way where all that it reaches is alike.
PixelSight look(const LocalDose& dose, const Surroundings& around,
                const std::map<int, ChangeCount>& changes, int x, int y) {
  const Rect reach = dose.voxels_of(x, y);
  PixelSight sight{std::numeric_limits<int>::max(), std::numeric_limits<int>::min(), 0};
  for (const auto& [offset, change] : changes) {
    if (!change.uniform(reach)) return dose.sight(x, y);
    const int cost = *around.cost(offset, true).at(reach.x0, reach.y0);
    sight.min_cost = std::min(sight.min_cost, cost);
    sight.max_cost = std::max(sight.max_cost, cost);
  }
  return sight.min_cost < 0 && sight.max_cost > 0 ? dose.sight(x, y) : sight;
}

bool meets(const RunLayer& layer, const Rect& rect) {
  for (int y = rect.y0; y < rect.y1; ++y) {
    const rows::Row row = layer.row(y);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      if (row[i] < rect.x1 && row[i + 1] > rect.x0) return true;
    }
  }
  return false;
}

}  // namespace

LayerSearch::LayerSearch(const SearchModel& by, LayerWindow layers)
    : by_(by), layers_(layers), places_(by.printer, by.grid, layers, by.offsets) {
  const RunLayer& before = *layer_at(layers, 0)->mask;
  box_ = {0, 0, before.width(), before.height()};
  const TileSurroundings nothing(layers_, by_.offsets, places_, mask_);
  const LocalDose one(by_.models, by_.grid, {0, 0, 1, 1}, nothing);
  reach_vx_ = one.voxel_rect();
  // Tiles at the box's edge ask for the mask beyond it.
  const Rect& masks = one.mask_rect();
  const int rules = by_.rules.largest_px();
  mask_.reset(
      box_.grown(std::max({-masks.x0, masks.x1, rules}), std::max({-masks.y0, masks.y1, rules})),
      0);
  add_layer(before, std::uint8_t{1}, mask_);
  find_tiles();
}

void LayerSearch::find_tiles() {
  std::vector<const RunLayer*> slices;
  for (const int offset : by_.offsets.printed) {
    const InverseLayer* layer = layer_at(layers_, offset);
    if (layer == nullptr) continue;
    for (const RunLayer& slice : layer->target->slices) slices.push_back(&slice);
  }
  const std::array<int, 2> reach{std::max(-reach_vx_.x0, reach_vx_.x1),
                                 std::max(-reach_vx_.y0, reach_vx_.y1)};
  for (const Rect& rect : search_tiles(slices, by_.grid, reach)) {
    tiles_.push_back({rect.grown(kOverlapPx, kOverlapPx).cut(box_), {}});
  }
}

void LayerSearch::run(bool from_scratch) {
  const SearchStart start;
  search(tiles_, from_scratch ? &start : nullptr);
}

void LayerSearch::run_near(std::span<const RunLayer* const> places, const SearchStart& start) {
  std::vector<Tile> near;
  for (const Tile& tile : tiles_) {
    const std::array<int, 2> r{by_.grid.detail_vx[0], by_.grid.detail_vx[1]};
    const Rect voxels{tile.rect.x0 * r[0] + reach_vx_.x0, tile.rect.y0 * r[1] + reach_vx_.y0,
                      tile.rect.x1 * r[0] + reach_vx_.x1, tile.rect.y1 * r[1] + reach_vx_.y1};
    const bool is_near = std::any_of(places.begin(), places.end(),
                                     [&](const RunLayer* place) { return meets(*place, voxels); });
    if (is_near) near.push_back({tile.rect, {}});
  }
  search(near, &start);
}

void LayerSearch::search(std::span<Tile> tiles, const SearchStart* from_scratch) {
  for (Tile& tile : tiles) look_over(tile, from_scratch);
  if (from_scratch != nullptr) {
    // What a tile leaves of an island or a hole may lie beside it.
    const int most = by_.rules.largest_px();
    for (const Tile& tile : tiles) {
      obey(by_.rules, tile.rect.grown(most, most).cut(box_), mask_);
    }
  }
  for (const Tile& tile : tiles) search(tile);
}

// Finds the pixels to search on. A pixel is settled where all voxels that it reaches want binder,
// or none of them does.
void LayerSearch::look_over(Tile& tile, const SearchStart* from_scratch) {
  TileSurroundings around(layers_, by_.offsets, places_, mask_);
  const LocalDose dose(by_.models, by_.grid, tile.rect, around);
  around.look_at(dose);
  std::map<int, ChangeCount> changes;
  for (const int offset : by_.offsets.printed) changes.emplace(offset, around.cost(offset, true));
  tile.pixels.clear();
  Plane<double> wanted(tile.rect);
  for (int y = tile.rect.y0; y < tile.rect.y1; ++y) {
    for (int x = tile.rect.x0; x < tile.rect.x1; ++x) {
      const PixelSight sight = look(dose, around, changes, x, y);
      const bool open = sight.min_cost < 0 && sight.max_cost > 0;
      if (open) tile.pixels.push_back({x, y});
      *wanted.at(x, y) = open ? sight.wanted : sight.min_cost < 0;
    }
  }
  if (from_scratch != nullptr) begin(tile, wanted, *from_scratch, dose);
}

// With w(p) the share of the binder of pixel p that lands where binder is wanted:
//
//   p is on iff w(p) >= (1 - level share) * max of w over the pixels near p
//
// At a straight edge the maximum is 1, and this is where a straight edge has its mask. In a feature
// that is narrower than the spread no pixel reaches 1, and flips of single pixels would never bring
// the feature about; there its best pixels are on. "Near" is a quarter of pixel_reach(): from half
// on, the maximum would change straight edges.
void LayerSearch::begin(const Tile& tile, const Plane<double>& wanted, const SearchStart& start,
                        const LocalDose& dose) {
  if (start.mask != nullptr) {
    Plane<std::uint8_t> from(tile.rect);
    add_layer(*start.mask, std::uint8_t{1}, from);
    for (const auto& [x, y] : tile.pixels) *mask_.at(x, y) = *from.at(x, y);
    return;
  }
  const auto [reach_x, reach_y] = dose.pixel_reach();
  const Rect& rect = tile.rect;
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      const Rect near =
          Rect{x, y, x + 1, y + 1}.grown((reach_x + 3) / 4, (reach_y + 3) / 4).cut(rect);
      double most = 0;
      for (int v = near.y0; v < near.y1; ++v) {
        most = std::max(
            most, *std::max_element(wanted.at(near.x0, v), wanted.at(near.x0, v) + near.width()));
      }
      const double share = *wanted.at(x, y);
      *mask_.at(x, y) = share > 0 && share >= most * wanted_at(x, y) * start.share;
    }
  }
}

// The share of its binder that a pixel at a straight edge has where binder is wanted.
double LayerSearch::wanted_at(int x, int y) const {
  if (!places_.has_gains()) return 1 - by_.level_share;
  const auto [rx, ry, rz] = by_.grid.detail_vx;
  return 1 - by_.level_share / places_.gain(0, x * rx + rx / 2, y * ry + ry / 2);
}

void LayerSearch::search(const Tile& tile) {
  if (tile.pixels.empty()) return;
  TileSurroundings around(layers_, by_.offsets, places_, mask_);
  LocalDose dose(by_.models, by_.grid, tile.rect, around);
  around.look_at(dose);
  dose.reset();
  PixelSearch(dose, mask_, tile.pixels, by_.rules).run(kMaxSweeps);
}

}  // namespace binderjet
