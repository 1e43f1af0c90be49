// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/mask_patch.h"

#include <algorithm>
#include <cstdint>

#include "slicer/rows.h"

namespace binderjet {

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
  Plane<std::uint8_t> patch(box);
  add_layer(with, std::uint8_t{1}, patch);
  Plane<std::uint8_t> pixels(box.grown(rules.most(), rules.most()));
  add_layer(mask, std::uint8_t{1}, pixels);
  for (const Rect& place : places) {
    const Rect rect = place.cut(box);
    for (int y = rect.y0; y < rect.y1 && !rect.empty(); ++y) {
      std::copy_n(patch.at(rect.x0, y), rect.width(), pixels.at(rect.x0, y));
    }
  }
  obey(rules, box, pixels);
  return to_layer(pixels, box.x1, box.y1);
}

}  // namespace binderjet
