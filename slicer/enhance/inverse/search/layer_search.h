// SPDX-License-Identifier: GPL-3.0-or-later
// The search for one layer's mask, tile by tile, while the masks of the layers around it stay.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/enhance/inverse/search/local_dose.h"
#include "slicer/enhance/inverse/search/pixel_search.h"
#include "slicer/enhance/inverse/search/stamp.h"
#include "slicer/enhance/inverse/search/window_places.h"
#include "slicer/enhance/rules/mask_rules.h"
#include "slicer/enhance/rules/rect_cells.h"
#include "slicer/layers/grid.h"
#include "slicer/score/lost_and_fused.h"

namespace binderjet {

// All that a search needs to know beside the layers.
struct SearchModel {
  PrinterModel printer;              // the nominal model, exact: it judges
  std::vector<StampedModel> models;  // the process window, the nominal model first
  ModelOffsets offsets;              // the layers that a mask prints into
  double level_share = 0.5;          // level / dose inside a wide solid
  MaskRules rules;
  Grid grid;
};

// The mask that a search begins with.
struct SearchStart {
  // This mask, if it is not null.
  const RunLayer* mask = nullptr;
  // Else the pixels of which at least `share` times as much binder lands where binder is wanted as
  // a straight edge needs (LayerSearch::begin()); less than 1 begins with more pixels on.
  double share = 1;
};

class LayerSearch {
 public:
  // Searches the mask of the middle layer, and begins with its mask so far. Both arguments must
  // outlive this.
  LayerSearch(const SearchModel& by, LayerWindow layers);

  // Searches the whole layer. With `from_scratch` the mask so far is forgotten.
  void run(bool from_scratch);
  // Searches, from this start, the tiles whose pixels reach a voxel that is 1 in any of `places`.
  void run_near(std::span<const RunLayer* const> places, const SearchStart& start);

  RunLayer mask() const { return to_layer(mask_, box_.x1, box_.y1); }

 private:
  struct Tile {
    Rect rect;
    std::vector<Pixel> pixels;  // whose right state depends on the pixels around them
  };

  void find_tiles();
  // Without `from_scratch` both keep the mask so far.
  void search(std::span<Tile> tiles, const SearchStart* from_scratch);
  void look_over(Tile& tile, const SearchStart* from_scratch);
  void begin(const Tile& tile, const Plane<double>& wanted, const SearchStart& start,
             const LocalDose& dose);
  double wanted_at(int x, int y) const;
  void search(const Tile& tile);

  const SearchModel& by_;
  LayerWindow layers_;
  WindowPlaces places_;
  Rect box_;
  Rect reach_vx_;  // of the pixel at (0, 0)
  Plane<std::uint8_t> mask_;
  std::vector<Tile> tiles_;
};

}  // namespace binderjet
