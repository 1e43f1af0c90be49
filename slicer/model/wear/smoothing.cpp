// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/wear/smoothing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "slicer/base/vector_clones.h"
#include "slicer/model/dose/kernel.h"

namespace binderjet {
namespace {

constexpr int kTotal = 1024;  // three of them multiplied still fit an int

std::vector<int> whole_weights(double sigma_vx) {
  const Kernel kernel = gaussian_kernel(sigma_vx * 2 * std::sqrt(2 * std::log(2.0)));
  std::vector<int> out;
  for (const std::int64_t weight : kernel.weights) {
    out.push_back(static_cast<int>(
        std::llround(static_cast<double>(weight) * kTotal / static_cast<double>(kernel.total()))));
  }
  // What rounding took or gave is the middle's.
  out[out.size() / 2] += kTotal - std::accumulate(out.begin(), out.end(), 0);
  while (out.size() > 1 && out.front() == 0) {
    out.erase(out.begin());
    out.pop_back();
  }
  return out;
}

// out[i] += weight * in[i].
BINDERJET_VECTOR_CLONES void add_scaled(const int* in, int weight, int count, int* out) {
  for (int i = 0; i < count; ++i) out[i] += weight * in[i];
}

}  // namespace

Smoothing::Smoothing(double sigma_mm, const Grid& grid)
    : weights_{whole_weights(sigma_mm / grid.voxel_mm(0)),
               whole_weights(sigma_mm / grid.voxel_mm(1)),
               whole_weights(sigma_mm / grid.pitch_mm[2])} {}

std::array<int, 3> Smoothing::reach() const {
  std::array<int, 3> out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out[axis] = static_cast<int>(weights_[axis].size()) / 2;
  }
  return out;
}

RunLayer Smoothing::operator()(const RunWindow& window) const {
  const RunLayer& middle = window.middle();
  const auto [rx, ry, rz] = reach();
  const int width = middle.width();
  const int height = middle.height();
  const int padded = width + 2 * rx;
  // Along z first, while voxels are runs; `columns` is padded in x.
  std::vector<int> columns(static_cast<std::size_t>(padded) * static_cast<std::size_t>(height), 0);
  std::vector<char> has(static_cast<std::size_t>(height), 0);
  for (int dz = -rz; dz <= rz; ++dz) {
    const RunLayer* layer = window.at(dz);
    if (layer == nullptr) continue;
    const int weight = weights_[2][static_cast<std::size_t>(dz + rz)];
    for (int y = 0; y < height; ++y) {
      const std::span<const int> row = layer->row(y);
      int* to = columns.data() + static_cast<std::ptrdiff_t>(y) * padded + rx;
      for (std::size_t i = 0; i < row.size(); i += 2) {
        has[static_cast<std::size_t>(y)] = 1;
        for (int x = row[i]; x < row[i + 1]; ++x) to[x] += weight;
      }
    }
  }
  RunLayer out(width);
  std::vector<int> along_y(static_cast<std::size_t>(padded));
  std::vector<int> sums(static_cast<std::size_t>(width));
  constexpr int kHalf = kTotal / 2 * kTotal * kTotal;
  for (int y = 0; y < height; ++y) {
    std::fill(along_y.begin(), along_y.end(), 0);
    bool any = false;
    for (int d = -std::min(ry, y); d <= std::min(ry, height - 1 - y); ++d) {
      if (has[static_cast<std::size_t>(y + d)] == 0) continue;
      any = true;
      add_scaled(columns.data() + static_cast<std::ptrdiff_t>(y + d) * padded,
                 weights_[1][static_cast<std::size_t>(d + ry)], padded, along_y.data());
    }
    if (!any) {
      out.end_row();
      continue;
    }
    std::fill(sums.begin(), sums.end(), 0);
    for (int d = -rx; d <= rx; ++d) {
      add_scaled(along_y.data() + rx + d, weights_[0][static_cast<std::size_t>(d + rx)], width,
                 sums.data());
    }
    out.append_row_where([&](int x) { return sums[static_cast<std::size_t>(x)] >= kHalf; });
  }
  return out;
}

}  // namespace binderjet
