// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/mask_patch.h"

#include <algorithm>
#include <cstdint>

#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

// The layer with these cells in a rectangle of it.
RunLayer with_cells(const RunLayer& layer, const Plane<std::uint8_t>& cells, const Rect& rect) {
  RunLayer out(layer.width());
  std::vector<int> row;
  std::vector<int> beside;
  std::vector<int> sum;
  const int ends[] = {rect.x0, rect.x1};
  for (int y = 0; y < layer.height(); ++y) {
    if (y < rect.y0 || y >= rect.y1) {
      out.append_row(layer.row(y));
      continue;
    }
    rows::subtract(layer.row(y), ends, beside);
    row.clear();
    for (int x = rect.x0; x < rect.x1; ++x) {
      const bool before = x > rect.x0 && *cells.at(x - 1, y) != 0;
      if ((*cells.at(x, y) != 0) != before) row.push_back(x);
    }
    if (row.size() % 2 == 1) row.push_back(rect.x1);
    rows::unite(beside, row, sum);
    out.append_row(sum);
  }
  return out;
}

}  // namespace

std::vector<Rect> pixels_around(const RunLayer& voxels, const Grid& grid, int around_px) {
  const auto [rx, ry, rz] = grid.detail_vx;
  std::vector<Rect> out;
  for (int y = 0; y < voxels.height(); ++y) {
    const rows::Row row = voxels.row(y);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      const Rect run{row[i] / rx, y / ry, (row[i + 1] - 1) / rx + 1, y / ry + 1};
      out.push_back(run.grown(around_px, around_px));
    }
  }
  return out;
}

RunLayer patched(const RunLayer& mask, const RunLayer& with, std::span<const Rect> places,
                 const MaskRules& rules) {
  const Rect box{0, 0, mask.width(), mask.height()};
  Rect all;
  for (const Rect& place : places) {
    const Rect inside = place.cut(box);
    if (!inside.empty()) all = all.empty() ? inside : all.joined(inside);
  }
  if (all.empty()) return mask;
  // What the patch leaves of an island or a hole may lie beside it.
  const int most = rules.largest_px();
  const Rect mended = all.grown(most, most).cut(box);
  Plane<std::uint8_t> patch(all);
  add_layer(with, std::uint8_t{1}, patch);
  Plane<std::uint8_t> pixels(mended.grown(most, most));
  add_layer(mask, std::uint8_t{1}, pixels);
  for (const Rect& place : places) {
    const Rect rect = place.cut(box);
    for (int y = rect.y0; y < rect.y1 && !rect.empty(); ++y) {
      std::copy_n(patch.at(rect.x0, y), rect.width(), pixels.at(rect.x0, y));
    }
  }
  obey(rules, mended, pixels);
  return with_cells(mask, pixels, mended);
}

}  // namespace binderjet
