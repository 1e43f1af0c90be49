// SPDX-License-Identifier: GPL-3.0-or-later
// One layer as a smooth field on a regular grid, 0 powder and 1 solid, to compare and
// differentiate.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "slicer/layers/run_layer.h"

namespace binderjet {

struct GrayPlane {
  int width = 0;
  int height = 0;
  std::array<double, 2> pitch_mm{};
  std::array<double, 2> origin_mm{};  // the lower corner of sample (0, 0)
  std::vector<float> values;          // row 0 first

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  // Samples outside read as powder.
  float at(int x, int y) const {
    return x < 0 || y < 0 || x >= width || y >= height ? 0 : values[index(x, y)];
  }
  double center_mm(int axis, int i) const {
    const auto a = static_cast<std::size_t>(axis);
    return origin_mm[a] + (i + 0.5) * pitch_mm[a];
  }
  // Bilinear between the centers of samples.
  double sample(double x_mm, double y_mm) const;
};

// The share of solid in cells of factor[0] x factor[1] voxels.
GrayPlane coverage(const RunLayer& layer, std::array<double, 2> pitch_mm,
                   std::array<double, 2> origin_mm, std::array<int, 2> factor);

// Averages of cells of factor[0] x factor[1] samples.
GrayPlane coarsened(const GrayPlane& plane, std::array<int, 2> factor);

// Convolved with a normal distribution of this standard deviation; powder all around. The result
// reaches three deviations further on each side.
GrayPlane blurred(const GrayPlane& plane, double sigma_mm);

// sum += weight * plane; both of one grid.
void add_scaled(GrayPlane& sum, const GrayPlane& plane, double weight);

}  // namespace binderjet
