// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/dose/density_field.h"

#include <algorithm>
#include <cmath>

namespace binderjet {
namespace {

constexpr int kCell = DensityField::kCellPx;

// Adds the pixels of a mask to the cells they are in.
void count(const RunLayer& mask, int cells_x, std::vector<std::int64_t>& solid) {
  for (int y = 0; y < mask.height(); ++y) {
    std::int64_t* cells = solid.data() + static_cast<std::ptrdiff_t>(y / kCell) * cells_x;
    const std::span<const int> row = mask.row(y);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      for (int x = row[i]; x < row[i + 1];) {
        const int end = std::min(row[i + 1], (x / kCell + 1) * kCell);
        cells[x / kCell] += end - x;
        x = end;
      }
    }
  }
}

}  // namespace

DensityField::DensityField(const RunWindow& window, const Grid& grid, double radius_mm) {
  const RunLayer& middle = window.middle();
  cells_ = {(middle.width() + kCell - 1) / kCell, (middle.height() + kCell - 1) / kCell};
  const auto [nx, ny] = cells_;
  std::vector<std::int64_t> solid(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), 0);
  for (const RunLayer* mask : window) {
    if (mask != nullptr) count(*mask, nx, solid);
  }
  // Sums over all cells below and left of a corner give any box with four reads.
  const std::size_t stride = static_cast<std::size_t>(nx) + 1;
  std::vector<std::int64_t> sums(stride * (static_cast<std::size_t>(ny) + 1), 0);
  for (std::size_t j = 0; j < static_cast<std::size_t>(ny); ++j) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(nx); ++i) {
      sums[(j + 1) * stride + i + 1] = solid[j * static_cast<std::size_t>(nx) + i] +
                                       sums[j * stride + i + 1] + sums[(j + 1) * stride + i] -
                                       sums[j * stride + i];
    }
  }
  std::array<int, 2> half{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const int a = static_cast<int>(axis);
    half[axis] = static_cast<int>(std::lround(radius_mm / (kCell * grid.pitch_mm[axis]) - 0.5));
    half[axis] = std::max(0, half[axis]);
    cell_vx_[axis] = kCell * grid.detail_vx[static_cast<std::size_t>(a)];
  }
  const double volume = static_cast<double>(2 * half[0] + 1) * (2 * half[1] + 1) * kCell * kCell *
                        (2 * window.reach() + 1);
  share_.resize(solid.size());
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const auto sum = [&](int column, int row) {
        return sums[static_cast<std::size_t>(std::clamp(row, 0, ny)) * stride +
                    static_cast<std::size_t>(std::clamp(column, 0, nx))];
      };
      const int left = i - half[0];
      const int right = i + half[0] + 1;
      const int low = j - half[1];
      const int high = j + half[1] + 1;
      share_[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) +
             static_cast<std::size_t>(i)] =
          static_cast<float>(static_cast<double>(sum(right, high) - sum(left, high) -
                                                 sum(right, low) + sum(left, low)) /
                             volume);
    }
  }
}

double DensityField::cell(int i, int j) const {
  i = std::clamp(i, 0, cells_[0] - 1);
  j = std::clamp(j, 0, cells_[1] - 1);
  return share_[static_cast<std::size_t>(j) * static_cast<std::size_t>(cells_[0]) +
                static_cast<std::size_t>(i)];
}

double DensityField::at(double x_vx, double y_vx) const {
  const double u = (x_vx + 0.5) / cell_vx_[0] - 0.5;
  const double v = (y_vx + 0.5) / cell_vx_[1] - 0.5;
  const int i = static_cast<int>(std::floor(u));
  const int j = static_cast<int>(std::floor(v));
  const double fx = u - i;
  const double fy = v - j;
  return (1 - fy) * ((1 - fx) * cell(i, j) + fx * cell(i + 1, j)) +
         fy * ((1 - fx) * cell(i, j + 1) + fx * cell(i + 1, j + 1));
}

}  // namespace binderjet
