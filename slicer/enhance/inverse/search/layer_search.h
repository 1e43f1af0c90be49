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

// What a search goes by; the first model is the nominal one.
struct SearchModel {
  PrinterModel printer;
  std::vector<StampedModel> models;
  ModelOffsets offsets;
  double level_share = 0.5;  // the level, of the dose that a wide field gets
  MaskRules rules;
  Grid grid;
};

// Where a search begins.
struct SearchStart {
  const RunLayer* mask = nullptr;  // if not null, with this mask
  double share = 1;                // else as a straight edge wants it, of which this much is enough
};

class LayerSearch {
 public:
  // On the middle one of the layers; both must outlive this. It begins with the mask so far.
  LayerSearch(const SearchModel& by, LayerWindow layers);

  // Searches the whole layer; `anew` forgets its mask so far.
  void run(bool anew);
  // Searches from this start where pixels reach what is 1 in any of these layers, on the voxel
  // grid.
  void run_near(std::span<const RunLayer* const> places, const SearchStart& start);

  RunLayer mask() const { return to_layer(mask_, box_.x1, box_.y1); }

 private:
  struct Tile {
    Rect rect;
    std::vector<Pixel> pixels;  // those for which neither state is right whatever is around
  };

  void find_tiles();
  // Without `anew` both keep the mask so far.
  void search(std::span<Tile> tiles, const SearchStart* anew);
  void look_over(Tile& tile, const SearchStart* anew);
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
