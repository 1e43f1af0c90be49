// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/dose/kernel.h"

#include <cmath>

namespace binderjet {

Kernel box_kernel(const BoxWeights& box) {
  Kernel kernel{-box.reach, {}};
  for (int offset = -box.reach; offset <= box.reach; ++offset) {
    kernel.weights.push_back(box.at(offset));
  }
  return kernel;
}

Kernel gaussian_kernel(double width_vx) {
  constexpr double kUnit = 1 << 20;
  constexpr double kCut = 1.0 / (1 << 12);
  const double sigma_vx = width_vx / (2 * std::sqrt(2 * std::log(2.0)));
  const auto beyond = [sigma_vx](double distance_vx) {  // the share beyond it, on one side
    return std::erfc(distance_vx / sigma_vx / std::sqrt(2.0)) / 2;
  };
  std::vector<std::int64_t> side;  // of offsets 1, 2, ...
  for (double edge = 0.5; 2 * beyond(edge) > kCut; ++edge) {
    side.push_back(std::llround((beyond(edge) - beyond(edge + 1)) * kUnit));
  }
  Kernel kernel{-static_cast<int>(side.size()), {side.rbegin(), side.rend()}};
  kernel.weights.push_back(std::llround((1 - 2 * beyond(0.5)) * kUnit));
  kernel.weights.insert(kernel.weights.end(), side.begin(), side.end());
  return kernel;
}

std::optional<BoxWeights> as_box(const Kernel& kernel) {
  if (kernel.first != -kernel.last()) return std::nullopt;
  BoxWeights box;
  box.reach = kernel.last();
  box.end = kernel.weights.front();
  box.full = kernel.at(0);
  if (!(box_kernel(box) == kernel)) return std::nullopt;
  return box;
}

}  // namespace binderjet
