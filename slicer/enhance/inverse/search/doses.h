// SPDX-License-Identifier: GPL-3.0-or-later
// The doses of the voxels around the pixels that may flip, with the price of each voxel, kept up to
// date while pixels flip. A flip adds its stamp to the dose
// (slicer/enhance/inverse/search/stamps.h), so what it changes is known before it is made, at the
// cost of reading the stamp's voxels.
//
// One plane of values, by Band's numbers, for each layer that the mask prints into and each model:
//
//   cells   | price | dose, printer | dose, drifted ... |   layer k
//           | price | dose, printer | dose, drifted ... |   layer k - 1, where binder sinks ...
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "slicer/enhance/inverse/search/band.h"
#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/enhance/inverse/search/search_model.h"
#include "slicer/enhance/inverse/search/stamps.h"
#include "slicer/enhance/inverse/search/window_places.h"
#include "slicer/enhance/rules/rect_cells.h"

namespace binderjet {

// Pixels [x0, x1) of row y that may flip, the first of them number `first`.
struct PixelRun {
  int y;
  int x0;
  int x1;
  std::size_t first;
};

// A pixel that may flip: by its run, and its x.
struct OpenPixel {
  std::size_t run;
  int x;
};

// What a dose costs while it matters how far it is from the level: nothing up to `powder_from`
// where powder is wanted, then more and more over `span`; where solid is wanted the most up to
// `solid_from`, then less and less over `span`.
struct Ramp {
  int powder_from;
  int solid_from;
  int span;
};

class Doses {
 public:
  // Of the middle layer's `open` pixels. Arguments must outlive this.
  Doses(const SearchModel& by, const LayerWindow& layers, const RunLayer& open);

  std::span<const PixelRun> runs() const { return runs_; }
  // Those of row y.
  std::array<std::size_t, 2> runs_of(int y) const;
  // How far apart, in pixels, two pixels may be that reach the same voxel.
  std::array<int, 2> pixel_reach() const;

  // Computes the doses that `own` (as the middle layer's mask) and the masks around it give: of the
  // printer, or of the drifted models.
  void fill_nominal(const RunLayer& own);
  void fill_drifted(const RunLayer& own);
  // A missing or surplus voxel of the layer at `offset` costs `times` as much, where its price says
  // that it is one.
  void raise_prices(int offset, const RunLayer& voxels, bool missing, int times);

  // Between these two the printer's doses stand for their costs: from() is taken off.
  void enter(const Ramp& ramp) { shift(ramp, -1); }
  void leave(const Ramp& ramp) { shift(ramp, 1); }
  // What all costs grow by when the pixel is set (sign 1) or cleared (sign -1): within a ramp, in
  // units of dose times kPriceUnit; of counts under all models that are filled, in kPriceUnit.
  int ramp_change(const OpenPixel& pixel, int sign, const Ramp& ramp) const;
  int count_change(const OpenPixel& pixel, int sign) const {
    return nominal_change(pixel, sign) + drifted_change(pixel, sign);
  }
  // The same of the printer alone, and of the drifted models.
  int nominal_change(const OpenPixel& pixel, int sign) const;
  int drifted_change(const OpenPixel& pixel, int sign) const;
  void flip(const OpenPixel& pixel, int sign);

  // What a wrong voxel weighs in counts, of all models that are filled.
  int weights() const;
  // The printer's dose of a voxel of the middle layer, which an open pixel reaches.
  double dose(int x_vx, int y_vx) const;

 private:
  // Where a pixel lands, from its first voxel, and which stamps fit it.
  struct Landing {
    std::array<int, 2> by{};
    std::size_t fit = 0;
  };
  // The dose of a printed layer under a model. Stamps are by fit.
  struct Plane {
    std::size_t model;
    int printed;       // the layer's offset
    std::size_t dose;  // where its cells begin
    std::size_t price;
    std::vector<const Stamp*> stamps;
  };

  void land();
  void number_pixels(const RunLayer& open);
  void make_planes();
  int within_most(int shift, std::size_t axis) const;
  Stamps& stamps(std::size_t model, int layer);
  void fill(const Plane& plane, const RunLayer& own);
  void add_mask(const RunLayer& mask, Stamps& stamps, const ShiftedMask* shifts,
                std::int16_t* dose) const;
  void add_credit(int printed, int least, std::int16_t* dose) const;
  void shift(const Ramp& ramp, int sign);
  // Calls act(stamp, where the stamp's rows begin in the band, first column) for a pixel.
  int count_change(const OpenPixel& pixel, int sign, const Plane& plane) const;
  template <class Act>
  void on_stamp(const OpenPixel& pixel, const Plane& plane, Act act) const;

  const SearchModel& by_;
  const LayerWindow& layers_;
  WindowPlaces places_;
  std::vector<PixelRun> runs_;
  std::vector<std::size_t> row_ends_;  // of runs_
  std::vector<Landing> landings_;      // by pixel; none if nothing is shifted
  std::vector<PixelFit> fits_;
  std::map<std::array<int, 2>, Stamps> stamps_;  // by model and layer
  Rect reach_;                                   // of any pixel, from its first voxel
  std::optional<Band> band_;
  std::vector<std::size_t> rows_;  // of each run: where in the band each row of its reach begins
  std::vector<Plane> planes_;
  std::vector<std::int16_t> cells_;
  std::size_t filled_ = 0;  // models
};

}  // namespace binderjet
