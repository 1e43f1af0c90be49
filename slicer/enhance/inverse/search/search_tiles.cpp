// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/search_tiles.h"

#include <algorithm>

#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

class TileMarks {
 public:
  TileMarks(int width_vx, int height_vx, const Grid& grid, std::array<int, 2> reach_vx)
      : size_px_{width_vx / grid.detail_vx[0], height_vx / grid.detail_vx[1]},
        tile_vx_{kTilePx * grid.detail_vx[0], kTilePx * grid.detail_vx[1]},
        reach_vx_(reach_vx) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      tiles_[axis] = (size_px_[axis] + kTilePx - 1) / kTilePx;
    }
    marks_.assign(static_cast<std::size_t>(tiles_[0]) * static_cast<std::size_t>(tiles_[1]), false);
  }

  // Something changes between the voxels first <= x < last of row y and others.
  void mark(int first, int last, int y) {
    const auto tile = [&](int voxel, std::size_t axis) {
      return std::clamp(voxel / tile_vx_[axis], 0, tiles_[axis] - 1);
    };
    for (int j = tile(y - reach_vx_[1] - 1, 1); j <= tile(y + reach_vx_[1] + 1, 1); ++j) {
      for (int i = tile(first - reach_vx_[0] - 1, 0); i <= tile(last + reach_vx_[0], 0); ++i) {
        marks_[place(i, j)] = true;
      }
    }
  }

  std::vector<Rect> tiles() const {
    std::vector<Rect> out;
    for (int j = 0; j < tiles_[1]; ++j) {
      for (int i = 0; i < tiles_[0]; ++i) {
        if (!marks_[place(i, j)]) continue;
        out.push_back({i * kTilePx, j * kTilePx, std::min((i + 1) * kTilePx, size_px_[0]),
                       std::min((j + 1) * kTilePx, size_px_[1])});
      }
    }
    return out;
  }

 private:
  std::size_t place(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(tiles_[0]) +
           static_cast<std::size_t>(i);
  }

  std::array<int, 2> size_px_;
  std::array<int, 2> tile_vx_;
  std::array<int, 2> reach_vx_;
  std::array<int, 2> tiles_{};
  std::vector<bool> marks_;
};

}  // namespace

std::vector<Rect> search_tiles(std::span<const RunLayer* const> slices, const Grid& grid,
                               std::array<int, 2> reach_vx) {
  if (slices.empty()) return {};
  const RunLayer& front = *slices.front();
  TileMarks marks(front.width(), front.height(), grid, reach_vx);
  std::vector<int> changes;
  const auto mark_changes = [&](rows::Row a, rows::Row b, int y) {
    rows::difference(a, b, changes);
    for (std::size_t i = 0; i < changes.size(); i += 2) marks.mark(changes[i], changes[i + 1], y);
  };
  for (std::size_t s = 0; s < slices.size(); ++s) {
    for (int y = 0; y <= front.height(); ++y) {
      const rows::Row row = slices[s]->row(y);
      for (const int x : row) marks.mark(x, x, y);
      mark_changes(slices[s]->row(y - 1), row, y);
      if (s > 0) mark_changes(slices[s - 1]->row(y), row, y);
    }
  }
  return marks.tiles();
}

}  // namespace binderjet
