// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/scan/gray_image.h"

#include <algorithm>
#include <cmath>

namespace binderjet {
namespace {

int cells(int samples, int factor) { return (samples + factor - 1) / factor; }

GrayPlane empty_cells(int width, int height, std::array<double, 2> pitch_mm,
                      std::array<double, 2> origin_mm, std::array<int, 2> factor) {
  GrayPlane plane;
  plane.width = cells(width, factor[0]);
  plane.height = cells(height, factor[1]);
  plane.pitch_mm = {pitch_mm[0] * factor[0], pitch_mm[1] * factor[1]};
  plane.origin_mm = origin_mm;
  plane.values.assign(
      static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(plane.height), 0.0F);
  return plane;
}

// Half a normal distribution, center first; the whole adds up to 1.
std::vector<float> half_bell(double sigma_samples) {
  const int reach = std::max(1, static_cast<int>(std::ceil(3 * sigma_samples)));
  std::vector<float> bell;
  double sum = 0;
  for (int i = 0; i <= reach; ++i) {
    const double value = std::exp(-0.5 * i * i / (sigma_samples * sigma_samples));
    sum += i == 0 ? value : 2 * value;
    bell.push_back(static_cast<float>(value));
  }
  for (float& value : bell) value = static_cast<float>(value / sum);
  return bell;
}

}  // namespace

double GrayPlane::sample(double x_mm, double y_mm) const {
  const double x = (x_mm - origin_mm[0]) / pitch_mm[0] - 0.5;
  const double y = (y_mm - origin_mm[1]) / pitch_mm[1] - 0.5;
  if (x <= -1 || y <= -1 || x >= width || y >= height) return 0;
  const int i = static_cast<int>(std::floor(x));
  const int j = static_cast<int>(std::floor(y));
  const double u = x - i;
  const double v = y - j;
  return (1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
         v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
}

GrayPlane coverage(const RunLayer& layer, std::array<double, 2> pitch_mm,
                   std::array<double, 2> origin_mm, std::array<int, 2> factor) {
  GrayPlane plane = empty_cells(layer.width(), layer.height(), pitch_mm, origin_mm, factor);
  const float share = 1.0F / static_cast<float>(factor[0] * factor[1]);
  for (int y = 0; y < layer.height(); ++y) {
    const std::span<const int> row = layer.row(y);
    float* const out = plane.values.data() + plane.index(0, y / factor[1]);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      for (int x = row[i]; x < row[i + 1]; ++x) out[x / factor[0]] += share;
    }
  }
  return plane;
}

GrayPlane coarsened(const GrayPlane& plane, std::array<int, 2> factor) {
  if (factor[0] == 1 && factor[1] == 1) return plane;
  GrayPlane out = empty_cells(plane.width, plane.height, plane.pitch_mm, plane.origin_mm, factor);
  const float share = 1.0F / static_cast<float>(factor[0] * factor[1]);
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      out.values[out.index(x / factor[0], y / factor[1])] +=
          share * plane.values[plane.index(x, y)];
    }
  }
  return out;
}

GrayPlane blurred(const GrayPlane& plane, double sigma_mm) {
  const std::vector<float> x_bell = half_bell(sigma_mm / plane.pitch_mm[0]);
  const std::vector<float> y_bell = half_bell(sigma_mm / plane.pitch_mm[1]);
  const int x_reach = static_cast<int>(x_bell.size()) - 1;
  const int y_reach = static_cast<int>(y_bell.size()) - 1;
  GrayPlane rows =
      empty_cells(plane.width + 2 * x_reach, plane.height, plane.pitch_mm,
                  {plane.origin_mm[0] - x_reach * plane.pitch_mm[0], plane.origin_mm[1]}, {1, 1});
  for (int y = 0; y < rows.height; ++y) {
    for (int x = 0; x < rows.width; ++x) {
      const int from = x - x_reach;
      float sum = x_bell[0] * plane.at(from, y);
      for (int i = 1; i <= x_reach; ++i) {
        sum +=
            x_bell[static_cast<std::size_t>(i)] * (plane.at(from - i, y) + plane.at(from + i, y));
      }
      rows.values[rows.index(x, y)] = sum;
    }
  }
  GrayPlane out =
      empty_cells(rows.width, rows.height + 2 * y_reach, rows.pitch_mm,
                  {rows.origin_mm[0], rows.origin_mm[1] - y_reach * rows.pitch_mm[1]}, {1, 1});
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const int from = y - y_reach;
      float sum = y_bell[0] * rows.at(x, from);
      for (int j = 1; j <= y_reach; ++j) {
        sum += y_bell[static_cast<std::size_t>(j)] * (rows.at(x, from - j) + rows.at(x, from + j));
      }
      out.values[out.index(x, y)] = sum;
    }
  }
  return out;
}

void add_scaled(GrayPlane& sum, const GrayPlane& plane, double weight) {
  const auto factor = static_cast<float>(weight);
  for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += factor * plane.values[i];
}

}  // namespace binderjet
