// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/scan/scan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace binderjet {

std::array<double, 2> Pose::in_scan(double x_mm, double y_mm) const {
  const double c = std::cos(turn_deg * std::numbers::pi / 180);
  const double s = std::sin(turn_deg * std::numbers::pi / 180);
  const double x = x_mm - center_mm[0];
  const double y = y_mm - center_mm[1];
  return {center_mm[0] + shift_mm[0] + c * x - s * y, center_mm[1] + shift_mm[1] + s * x + c * y};
}

bool Scan::has_layers_of(const StackInfo& frame) const {
  const double slack = 1e-6 * frame.pitch_mm[2];
  return info.size[2] == frame.size[2] &&
         std::abs(info.pitch_mm[2] - frame.pitch_mm[2]) * frame.size[2] < slack &&
         std::abs(info.origin_mm[2] - frame.origin_mm[2]) < slack;
}

GrayPlane Scan::mean(double low_mm, double high_mm) const {
  const double pitch = info.pitch_mm[2];
  // Rounding must not pull in a sliver of the next slice.
  const double low = (low_mm - info.origin_mm[2]) / pitch + 1e-6;
  const double high = (high_mm - info.origin_mm[2]) / pitch - 1e-6;
  GrayPlane sum;
  for (int k = static_cast<int>(std::floor(low)); k < high; ++k) {
    if (k < 0 || k >= info.size[2]) continue;
    const double share = (std::min(high, k + 1.0) - std::max(low, double(k))) / (high - low);
    GrayPlane plane = slice(k);
    if (sum.values.empty()) {
      sum = plane;
      std::fill(sum.values.begin(), sum.values.end(), 0.0F);
    }
    add_scaled(sum, plane, share);
  }
  if (sum.values.empty()) {
    sum = slice(0);
    std::fill(sum.values.begin(), sum.values.end(), 0.0F);
  }
  return sum;
}

}  // namespace binderjet
