// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/loose_in_window.h"

#include <algorithm>
#include <set>
#include <vector>

#include "slicer/enhance/inverse/search/layer_sets.h"
#include "slicer/enhance/rules/rect_cells.h"
#include "slicer/layers/rows.h"
#include "slicer/score/pieces.h"
#include "slicer/voxels/any_slice.h"

namespace binderjet {
namespace {

// A bridge may begin this far from a piece along x and y.
constexpr int kBridgeVx = 4;

// The runs of a layer whose pieces are in `roots`.
RunLayer runs_of(const RunLayer& printed, const std::vector<int>& numbers, PieceFinder& pieces,
                 const std::set<int>& roots) {
  RunLayer out(printed.width());
  std::vector<int> row;
  std::size_t run = 0;
  for (int y = 0; y < printed.height(); ++y) {
    const rows::Row all = printed.row(y);
    row.clear();
    for (std::size_t i = 0; i < all.size(); i += 2, ++run) {
      if (roots.contains(pieces.root(numbers[run]))) row.insert(row.end(), {all[i], all[i + 1]});
    }
    out.append_row(row);
  }
  return out;
}

}  // namespace

LooseInWindow find_loose_in_window(std::span<const ComparedLayer* const> window) {
  const ComparedLayer& middle = *window[window.size() / 2];
  const auto slices = static_cast<int>(middle.target->slices.size());
  PieceFinder pieces(slices, 0, Contacts::kIgnore);
  std::vector<int> of_middle;
  for (const ComparedLayer* layer : window) {
    if (layer == nullptr) continue;
    const std::vector<int>& numbers = pieces.add(*layer->target, *layer->printed);
    if (layer == &middle) of_middle = numbers;
  }
  LooseInWindow out;
  std::set<int> loose;
  std::vector<Rect> near;
  for (const auto& [part, of_part] : pieces.pieces_by_part()) {
    const auto largest = std::max_element(
        of_part.begin(), of_part.end(),
        [](const auto& a, const auto& b) { return a.second.voxels < b.second.voxels; });
    for (auto piece = of_part.begin(); piece != of_part.end(); ++piece) {
      if (piece == largest) continue;
      ++out.count;
      loose.insert(piece->first);
      const Region& box = piece->second;
      near.push_back(
          Rect{box.low[0], box.low[1], box.high[0], box.high[1]}.grown(kBridgeVx, kBridgeVx));
    }
  }
  const RunLayer powder = RunLayer::powder(middle.printed->width(), middle.printed->height());
  out.loose = out.count == 0 ? powder : runs_of(*middle.printed, of_middle, pieces, loose);
  out.gap =
      out.count == 0 ? powder : within(without(any_slice(*middle.target), *middle.printed), near);
  return out;
}

}  // namespace binderjet
