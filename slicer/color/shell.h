// SPDX-License-Identifier: GPL-3.0-or-later
// The colored shell of a mask: color goes some millimeters deep, because powder is translucent;
// inside is white, and so is all that is neither mask nor skin.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "slicer/color/skin.h"

namespace binderjet {

class Shell {
 public:
  // `depth_mm` is measured from the surface to a pixel's center.
  Shell(const Grid& grid, const JobBox& box, double depth_mm,
        std::shared_ptr<const ColorField> field);

  // Layers of skin needed below and above.
  int reach() const { return reach_[2]; }

  // The bitmap of a layer: 24-bit rows, red first, row 0 is the smallest y. `window` is the skin of
  // reach() layers on each side. A pixel of the skin has its color whether or not the mask has it.
  // A pixel of the mask takes the color of the nearest pixel of the skin if that is within the
  // depth. A pixel on the mask's boundary always has a color: what enhancement made boundary takes
  // that of its neighbors, and where there are none the surface's own. Pure; takes as much memory
  // as the bitmap.
  std::vector<std::byte> paint(int layer, const Window<SkinLayer>& window) const;

 private:
  class Band;

  Grid grid_;
  JobBox box_;
  std::shared_ptr<const ColorField> field_;
  std::array<int, 3> reach_{};
  std::array<std::vector<float>, 3> cost_;  // per axis and offset: squared mm
  float paint_within_ = 0;
  float search_within_ = 0;
};

}  // namespace binderjet
