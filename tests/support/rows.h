// SPDX-License-Identifier: GPL-3.0-or-later
// Small layers written by hand, and rows read from them.
#pragma once

#include <initializer_list>
#include <vector>

#include "slicer/layers/run_layer.h"

namespace binderjet {

// One row a list of flips, from the smallest y up.
inline RunLayer rows_of(int width, std::initializer_list<std::vector<int>> rows) {
  RunLayer layer(width);
  for (const std::vector<int>& row : rows) layer.append_row(row);
  return layer;
}

// The flips of the row half way up.
inline std::vector<int> middle_row(const RunLayer& layer) {
  const auto row = layer.row(layer.height() / 2);
  return {row.begin(), row.end()};
}

}  // namespace binderjet
