// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/color/skin.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slicer/color/row_bits.h"

namespace binderjet {
namespace {

// Sums per pixel of one row of pixels.
class PixelRow {
 public:
  explicit PixelRow(int width)
      : sums_(static_cast<std::size_t>(width)), counts_(static_cast<std::size_t>(width), 0) {}

  void add(int pixel, const FloatRgb& color) {
    const auto i = static_cast<std::size_t>(pixel);
    for (std::size_t c = 0; c < 3; ++c) sums_[i][c] += color[c];
    ++counts_[i];
    first_ = std::min(first_, i);
    last_ = std::max(last_, i + 1);
  }

  // Appends the row to the layer and forgets it.
  void flush(SkinLayer& skin) {
    skin.rows.push_back(skin.colors.size());
    for (std::size_t i = first_; i < last_; ++i) {
      if (counts_[i] == 0) continue;
      Rgb color{};
      for (std::size_t c = 0; c < 3; ++c) {
        const float mean = sums_[i][c] / static_cast<float>(counts_[i]);
        color[c] = static_cast<std::uint8_t>(std::clamp(std::lround(mean), 0L, 255L));
      }
      skin.pixels.flip(static_cast<int>(i));
      skin.pixels.flip(static_cast<int>(i) + 1);
      skin.colors.push_back(color);
      sums_[i] = {};
      counts_[i] = 0;
    }
    skin.pixels.end_row();
    first_ = sums_.size();
    last_ = 0;
  }

 private:
  std::vector<FloatRgb> sums_;
  std::vector<int> counts_;
  std::size_t first_ = sums_.size();
  std::size_t last_ = 0;
};

const RunLayer* slice_of(const MaskLayer* masks, bool first) {
  if (masks == nullptr) return nullptr;
  return first ? &masks->target->slices.front() : &masks->target->slices.back();
}

}  // namespace

Pipeline<SkinLayer> skin(const Pipeline<MaskLayer>& masks, const Grid& grid, const JobBox& box,
                         std::shared_ptr<const ColorField> field) {
  return masks.then(
      "skin", LayerReach::both_sides(1),
      [grid, box, field = std::move(field)](int layer, const Window<MaskLayer>& window) {
        SkinLayer out;
        out.masks = window.shared(0);
        out.pixels = RunLayer(box.size_px[0]);
        const std::vector<RunLayer>& slices = window.middle().target->slices;
        const auto [rx, ry, rz] = grid.detail_vx;
        const std::unique_ptr<ColorSlab> slab =
            field->slab(layer * grid.pitch_mm[2], (layer + 1) * grid.pitch_mm[2]);
        RowNeighborhood rows(box.width_vx(grid));
        PixelRow pixels(box.size_px[0]);
        for (int j = 0; j < box.size_px[1]; ++j) {
          for (int s = 0; s < rz; ++s) {
            const RunLayer* under =
                s > 0 ? &slices[static_cast<std::size_t>(s) - 1] : slice_of(window.at(-1), false);
            const RunLayer* over = s + 1 < rz ? &slices[static_cast<std::size_t>(s) + 1]
                                              : slice_of(window.at(1), true);
            const RunLayer& slice = slices[static_cast<std::size_t>(s)];
            for (int y = j * ry; y < (j + 1) * ry; ++y) {
              if (slice.row(y).empty()) continue;
              rows.fill(under, slice, over, y);
              Point center{0, grid.center_mm(1, y - box.margin_px[1] * ry),
                           grid.center_mm(2, layer * rz + s)};
              for (std::size_t w = 0; w < rows.here.size(); ++w) {
                for_each_bit(rows.boundary(w), w, [&](int x) {
                  center[0] = grid.center_mm(0, x - box.margin_px[0] * rx);
                  pixels.add(x / rx, slab->at(center));
                });
              }
            }
          }
          pixels.flush(out);
        }
        return out;
      });
}

}  // namespace binderjet
