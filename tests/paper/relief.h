// SPDX-License-Identifier: GPL-3.0-or-later
// A printed volume seen straight from below, shaded like a statue under a lamp: the gargoyle's
// face, for in its file it lies on it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/stream.h"
#include "tests/support/picture.h"

namespace binderjet {

// What is seen looking up from below the bed, y upwards: how high the lowest voxel is, in mm, on
// square pixels.
class Relief {
 public:
  Relief(const std::vector<Shared<RunLayer>>& layers, const Grid& grid)
      : pixel_mm_(grid.voxel_mm(0)),
        width_(layers.front()->width()),
        height_(static_cast<int>(layers.front()->height() * grid.voxel_mm(1) / pixel_mm_)),
        depth_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), kNothing) {
    for (std::size_t k = layers.size(); k-- > 0;) {
      for (int v = 0; v < height_; ++v) {
        const auto row = layers[k]->row(static_cast<int>(v * pixel_mm_ / grid.voxel_mm(1)));
        for (std::size_t i = 0; i < row.size(); i += 2) {
          // From below, x runs the other way.
          for (int x = row[i]; x < row[i + 1]; ++x) {
            depth_[place(width_ - 1 - x, v)] = static_cast<double>(k) * grid.pitch_mm[2];
          }
        }
      }
    }
  }

  int width() const { return width_; }
  int height() const { return height_; }
  double pixel_mm() const { return pixel_mm_; }

  // 0 is darkest, 14 brightest, 15 nothing. The slope is taken over a few pixels, for layers are
  // steps.
  int shade(int x, int z) const {
    if (value(x, z) == kNothing) return 15;
    constexpr int kSpan = 2;
    const auto slope = [&](int dx, int dz) {
      const double a = value(x - kSpan * dx, z - kSpan * dz);
      const double b = value(x + kSpan * dx, z + kSpan * dz);
      const double here = value(x, z);
      const double from = a == kNothing ? here : a;
      const double to = b == kNothing ? here : b;
      return (to - from) / (2 * kSpan * pixel_mm_);
    };
    const double sx = slope(1, 0);
    const double sz = slope(0, 1);
    // A lamp above on the left.
    const double light = (-0.4 * sx + 0.6 * sz + 0.7) / std::sqrt(sx * sx + sz * sz + 1);
    return std::clamp(static_cast<int>(std::lround(light * 14)), 0, 14);
  }

 private:
  static constexpr double kNothing = 1e9;
  std::size_t place(int x, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  double value(int x, int z) const {
    if (x < 0 || z < 0 || x >= width_ || z >= height_) return kNothing;
    return depth_[place(x, z)];
  }

  double pixel_mm_;
  int width_;
  int height_;
  std::vector<double> depth_;
};

// The whole and the close-ups, as pictures/FOLDER/NAME_*.png.
inline void draw_reliefs(const std::vector<Shared<RunLayer>>& layers, const Grid& grid,
                         const std::string& folder, const std::string& name) {
  const Relief relief(layers, grid);
  std::vector<Rgb> grays;
  for (int i = 0; i < 15; ++i) {
    const auto gray = static_cast<std::uint8_t>(30 + i * 14);
    grays.push_back({gray, gray, gray});
  }
  grays.push_back({255, 255, 255});
  struct CloseUp {
    const char* part;
    double x_mm, z_mm, width_mm, height_mm;
    int scale;
  };
  // Places in the box of a job whose margin is that of the paper's kernel.
  const CloseUp views[] = {
      {"whole", 0, 0, relief.width() * relief.pixel_mm(), relief.height() * relief.pixel_mm(), 2},
      {"wing", 1.9, 14, 3.6, 5.6, 6},
      {"ear", 5.2, 12.6, 5, 3.2, 6},
      {"mouth", 5, 7.6, 4.4, 3.4, 6}};
  for (const CloseUp& view : views) {
    const int x0 = static_cast<int>(view.x_mm / relief.pixel_mm());
    const int z0 = static_cast<int>(view.z_mm / relief.pixel_mm());
    pictures::write(pictures::folder(folder) + "/" + view.part + "_" + name + ".png",
                    static_cast<int>(view.width_mm / relief.pixel_mm()),
                    static_cast<int>(view.height_mm / relief.pixel_mm()), {view.scale, view.scale},
                    grays, [&](int x, int z) { return relief.shade(x0 + x, z0 + z); });
  }
}

}  // namespace binderjet
