// SPDX-License-Identifier: GPL-3.0-or-later
// The color of a surface as a function of place, asked layer by layer.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "slicer/color/texture.h"
#include "slicer/mesh/mesh.h"
#include "slicer/mesh/paint.h"

namespace binderjet {

// A field made ready for some heights. One thread at a time.
class ColorSlab {
 public:
  virtual ~ColorSlab() = default;
  // The color at a point on or near the surface, within the range of the input's colors.
  virtual FloatRgb at(const Point& point) const = 0;
};

class ColorField {
 public:
  virtual ~ColorField() = default;
  // Ready for points with low_mm <= z <= high_mm. A pure function of these, whatever was asked
  // before; threads may call it at once.
  virtual std::unique_ptr<ColorSlab> slab(double low_mm, double high_mm) const = 0;
};

// The `neighbors` nearest samples weighted by the inverse of their distance (paper, 4.4); a sample
// at the point itself decides alone. At least one sample.
std::shared_ptr<const ColorField> sample_field(const std::vector<Point>& samples,
                                               std::vector<Rgb> colors, int neighbors);

// The color of the nearest point of painted triangles. The limit of the paper's samples as they
// become dense, without their memory: 190 mm of surface would need hundreds of millions.
std::shared_ptr<const ColorField> surface_field(Paint paint,
                                                std::vector<std::optional<Texture>> textures);

std::shared_ptr<const ColorField> plain_field(Rgb color);

// Parts beside each other on the bed: each point has the color of the part in whose box, or
// nearest to whose box, it lies.
struct PartField {
  Box box;
  std::shared_ptr<const ColorField> field;
};
std::shared_ptr<const ColorField> bed_field(std::vector<PartField> parts);

}  // namespace binderjet
