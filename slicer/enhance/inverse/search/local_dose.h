// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of the voxels around a tile, kept up to date while single pixels of a mask are flipped.
//
// A voxel costs its slices of powder less its slices of target where it is printed, and 0 where it
// is not. A flip adds its stamp (slicer/enhance/inverse/search/stamp.h) to the dose, so
//
//   cost of a flip = sum over the stamp's voxels of cost * (bound after - bound before)
//
// is known before the flip is made, at the cost of reading the stamp.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "slicer/enhance/inverse/search/shifted_stamps.h"
#include "slicer/enhance/inverse/search/stamp.h"
#include "slicer/enhance/rules/rect_cells.h"
#include "slicer/layers/grid.h"

namespace binderjet {

// Layers are counted from the one whose pixels are flipped.
class Surroundings {
 public:
  virtual ~Surroundings() = default;
  // What a printed voxel costs more than one that is not: its slices of powder minus those of the
  // target, under the nominal model or the others. On voxels, at least LocalDose::voxel_rect().
  virtual const Plane<int>& cost(int layer, bool nominal) const = 0;
  // At least LocalDose::mask_rect() of the layer's mask as it is.
  virtual const Plane<std::uint8_t>& mask(int layer) const = 0;
  // Null if no mask is shifted. Shifts are taken as at most `max_shift_vx()`.
  virtual const ShiftedMask* shifts(int layer) const = 0;
  virtual std::array<int, 2> max_shift_vx() const = 0;
  // By what the dose of a voxel is multiplied; null if by 1 everywhere. As large as cost().
  virtual const Plane<float>* gain(int layer) const = 0;
};

struct StampOverlay;  // a stamp laid on the dose; for the loops over its voxels

// What a pixel can do for the print, whatever the mask around it.
struct PixelSight {
  int min_cost = 0;   // the least cost of a voxel that the pixel has binder for
  int max_cost = 0;   // the largest
  double wanted = 0;  // the share of the pixel's binder that lands where binder is wanted
};

class LocalDose {
 public:
  // Pixels of `tile` are flipped. The first model is the nominal one; models and surroundings must
  // outlive this.
  LocalDose(std::span<const StampedModel> models, const Grid& grid, const Rect& tile,
            const Surroundings& around);

  // The voxels that the tile's pixels reach, and the pixels that reach these.
  const Rect& voxel_rect() const { return voxels_; }
  const Rect& mask_rect() const { return masks_; }
  // How far apart, in pixels, two pixels may be that reach the same voxel.
  std::array<int, 2> pixel_reach() const;

  // The voxels that pixel (x, y) of the tile may have binder for.
  Rect voxels_of(int x, int y) const;
  PixelSight sight(int x, int y) const;

  // Computes the doses from the masks as they are. TRAP: until then only sight() and what asks for
  // rectangles may be called. A tile with nothing to decide never pays for this.
  void reset();
  // What the weighted count of wrong voxels grows by when pixel (x, y) is set (sign 1) or cleared
  // (sign -1).
  int flip_cost(int x, int y, int sign) const;
  // The same for the nominal model's own level alone, in voxels.
  int nominal_cost(int x, int y, int sign) const;
  void flip(int x, int y, int sign);
  // The nominal dose of a voxel of the layer itself, 0 to 1.
  double dose(int x_vx, int y_vx) const;

 private:
  // Where a pixel of the tile lands, from its first voxel, and the stamps that fit it.
  struct Landing {
    std::array<int, 2> by{};
    std::size_t fit = 0;
  };
  // The dose of one layer under one model.
  struct Field {
    const StampedModel* model;
    const Stamp* stamp;                // of a flip that is not shifted
    std::vector<const Stamp*> fitted;  // by Landing::fit
    Plane<int> dose;
    bool nominal;
  };
  const Plane<int>& cost(const Field& field) const {
    return around_.cost(-field.stamp->layer, field.nominal);
  }
  ShiftedStamps& shifted(const StampedModel& model, int layer);
  void land(const Rect& tile);
  void add_fit(const PixelFit* fit);
  void find_reach();
  int within_most(int shift, std::size_t axis) const;
  Rect landed(const Landing& landing) const;
  void add_mask(const Stamp& stamp, const Plane<std::uint8_t>& mask, Field& field) const;
  void add_shifted_mask(const Stamp& stamp, const Plane<std::uint8_t>& mask,
                        const ShiftedMask& shifts, Field& field);
  void add_credit(Field& field) const;

  // Where a stamp that lands there begins.
  template <class P>
  auto under(P& plane, const Stamp& stamp, int x, int y, const Landing& landing) const {
    return plane.at(x * repeat_[0] + landing.by[0] + stamp.first[0],
                    y * repeat_[1] + landing.by[1] + stamp.first[1]);
  }
  template <class P>
  auto under(P& plane, const Stamp& stamp, int x, int y) const {
    return under(plane, stamp, x, y, Landing());
  }
  StampOverlay overlay(const Field& field, int x, int y, int sign) const;

  Grid grid_;
  std::array<int, 2> repeat_;
  const Surroundings& around_;
  std::map<std::pair<const StampedModel*, int>, ShiftedStamps> shifted_stamps_;  // by layer
  std::vector<Rect> fit_rects_;  // what all stamps of a fit reach, from the voxel they land in
  Plane<Landing> landings_;      // of the tile's pixels
  Rect fit_reach_;               // of all pixels of the tile, from their first voxels
  std::array<int, 2> first_{};   // the corners of all stamps together, wherever they land
  std::array<int, 2> last_{};
  Rect voxels_;
  Rect masks_;
  std::vector<Field> fields_;
};

}  // namespace binderjet
