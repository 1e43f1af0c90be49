// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/layer_sets.h"

#include <vector>

#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

template <class Combine>
RunLayer by_rows(const RunLayer& a, const RunLayer& b, Combine combine) {
  RunLayer out(a.width());
  std::vector<int> row;
  for (int y = 0; y < a.height(); ++y) {
    combine(a.row(y), b.row(y), row);
    out.append_row(row);
  }
  return out;
}

}  // namespace

RunLayer common(const RunLayer& a, const RunLayer& b) { return by_rows(a, b, rows::intersect); }

RunLayer either(const RunLayer& a, const RunLayer& b) { return by_rows(a, b, rows::unite); }

RunLayer without(const RunLayer& a, const RunLayer& b) { return by_rows(a, b, rows::subtract); }

RunLayer within(const RunLayer& layer, std::span<const Rect> boxes) {
  RunLayer out(layer.width());
  std::vector<int> near;
  std::vector<int> sum;
  for (int y = 0; y < layer.height(); ++y) {
    near.clear();
    for (const Rect& box : boxes) {
      if (y < box.y0 || y >= box.y1) continue;
      const int ends[] = {box.x0, box.x1};
      rows::unite(near, ends, sum);
      near.swap(sum);
    }
    rows::intersect(layer.row(y), near, sum);
    out.append_row(sum);
  }
  return out;
}

}  // namespace binderjet
