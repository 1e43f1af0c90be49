// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/open_pixels.h"

#include <algorithm>
#include <vector>

#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

// Appends [x0, x1) to runs in order of x0.
void append_run(int x0, int x1, std::vector<int>& row) {
  if (!row.empty() && row.back() >= x0) {
    row.back() = std::max(row.back(), x1);
  } else {
    row.insert(row.end(), {x0, x1});
  }
}

// The pixels with a voxel, of any slice, that is solid, or one that is powder.
RunLayer pixels_with(const VoxelLayer& target, const Grid& grid, bool solid) {
  const auto [rx, ry, rz] = grid.detail_vx;
  const int width = target.slices.front().width();
  const int height = target.slices.front().height() / ry;
  RunLayer out(width / rx);
  std::vector<int> sum;
  std::vector<int> next;
  std::vector<int> powder;
  std::vector<int> pixels;
  const int whole[] = {0, width};
  for (int y = 0; y < height; ++y) {
    sum.clear();
    for (const RunLayer& slice : target.slices) {
      for (int v = y * ry; v < (y + 1) * ry; ++v) {
        rows::Row row = slice.row(v);
        if (!solid) {
          rows::subtract(whole, row, powder);
          row = powder;
        }
        pixels.clear();
        for (std::size_t i = 0; i < row.size(); i += 2) {
          append_run(row[i] / rx, (row[i + 1] - 1) / rx + 1, pixels);
        }
        rows::unite(sum, pixels, next);
        sum.swap(next);
      }
    }
    out.append_row(sum);
  }
  return out;
}

}  // namespace

RunLayer grown(const RunLayer& layer, int by) {
  RunLayer out(layer.width());
  std::vector<int> sum;
  std::vector<int> next;
  std::vector<int> wide;
  for (int y = 0; y < layer.height(); ++y) {
    sum.clear();
    for (int v = std::max(0, y - by); v <= std::min(layer.height() - 1, y + by); ++v) {
      const rows::Row row = layer.row(v);
      wide.clear();
      for (std::size_t i = 0; i < row.size(); i += 2) {
        append_run(std::max(0, row[i] - by), std::min(layer.width(), row[i + 1] + by), wide);
      }
      rows::unite(sum, wide, next);
      sum.swap(next);
    }
    out.append_row(sum);
  }
  return out;
}

RunLayer open_pixels(const VoxelLayer& target, const Grid& grid, int reach_px) {
  const RunLayer solid = grown(pixels_with(target, grid, true), reach_px);
  const RunLayer powder = grown(pixels_with(target, grid, false), reach_px);
  RunLayer out(solid.width());
  std::vector<int> row;
  for (int y = 0; y < solid.height(); ++y) {
    rows::intersect(solid.row(y), powder.row(y), row);
    out.append_row(row);
  }
  return out;
}

}  // namespace binderjet
