// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/breaks.h"

#include <algorithm>
#include <cstdint>
#include <map>
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

struct Piece {
  Rect box;
  std::int64_t voxels = 0;
};
using Pieces = std::map<int, Piece>;  // by number

// What a part has of each piece, by the numbers' roots.
class SharedVoxels {
 public:
  void add(const VoxelLayer& target, const RunLayer& printed, const std::vector<int>& pieces) {
    for (const RunLayer& slice : target.slices) {
      for_each_shared(slice, parts_.add(slice), printed, pieces,
                      [&](int part, int piece, int first, int last, int y) {
                        add(found_[part][piece], {{first, y, last, y + 1}, last - first});
                      });
    }
  }

  std::map<int, Pieces> by_part(RegionNumbers& pieces) {
    std::map<int, Pieces> sum;
    for (const auto& [part, of_part] : found_) {
      Pieces& all = sum[parts_.root(part)];
      for (const auto& [number, piece] : of_part) add(all[pieces.root(number)], piece);
    }
    return sum;
  }

 private:
  static void add(Piece& sum, const Piece& more) {
    sum.box = sum.voxels == 0 ? more.box : sum.box.joined(more.box);
    sum.voxels += more.voxels;
  }

  RegionNumbers parts_;
  std::map<int, Pieces> found_;
};

// The runs of a layer whose pieces are in `roots`.
RunLayer runs_of(const RunLayer& printed, const std::vector<int>& numbers, RegionNumbers& pieces,
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

Breaks find_breaks(std::span<const ComparedLayer* const> window) {
  const ComparedLayer& middle = *window[window.size() / 2];
  const RunLayer powder = RunLayer::powder(middle.printed->width(), middle.printed->height());
  RegionNumbers pieces;
  SharedVoxels shared;
  std::vector<int> of_middle;
  for (const ComparedLayer* layer : window) {
    const std::vector<int>& numbers = pieces.add(layer == nullptr ? powder : *layer->printed);
    if (layer == &middle) of_middle = numbers;
    if (layer != nullptr) shared.add(*layer->target, *layer->printed, numbers);
  }
  Breaks out;
  std::set<int> loose;
  std::vector<Rect> near;
  for (const auto& [part, of_part] : shared.by_part(pieces)) {
    const auto largest = std::max_element(
        of_part.begin(), of_part.end(),
        [](const auto& a, const auto& b) { return a.second.voxels < b.second.voxels; });
    for (auto piece = of_part.begin(); piece != of_part.end(); ++piece) {
      if (piece == largest) continue;
      ++out.count;
      loose.insert(piece->first);
      near.push_back(piece->second.box.grown(kBridgeVx, kBridgeVx));
    }
  }
  out.loose = out.count == 0 ? powder : runs_of(*middle.printed, of_middle, pieces, loose);
  out.gap =
      out.count == 0 ? powder : within(without(any_slice(*middle.target), *middle.printed), near);
  return out;
}

}  // namespace binderjet
