// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of flips (slicer/layers/run_layer.h) as sets of voxels: union, difference, overlap.
//
//   a                ..####....##..     flips 2 6 10 12
//   b                ....####......     flips 4 8
//   intersect(a, b)  ....##........     flips 4 6
//
// One walk over both rows, so the cost is the number of flips and never the width.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

namespace binderjet::rows {

using Row = std::span<const int>;

// The row where op(in a, in b) holds; op(false, false) is false. `out` is neither a nor b.
template <class Op>
void combine(Row a, Row b, Op op, std::vector<int>& out) {
  out.clear();
  bool in_a = false;
  bool in_b = false;
  bool in_out = false;
  for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    const int x = j == b.size() || (i < a.size() && a[i] <= b[j]) ? a[i] : b[j];
    if (i < a.size() && a[i] == x) {
      in_a = !in_a;
      ++i;
    }
    if (j < b.size() && b[j] == x) {
      in_b = !in_b;
      ++j;
    }
    if (op(in_a, in_b) != in_out) {
      in_out = !in_out;
      out.push_back(x);
    }
  }
}

inline void intersect(Row a, Row b, std::vector<int>& out) {
  combine(
      a, b, [](bool in_a, bool in_b) { return in_a && in_b; }, out);
}
inline void unite(Row a, Row b, std::vector<int>& out) {
  combine(
      a, b, [](bool in_a, bool in_b) { return in_a || in_b; }, out);
}
inline void subtract(Row a, Row b, std::vector<int>& out) {
  combine(
      a, b, [](bool in_a, bool in_b) { return in_a && !in_b; }, out);
}
inline void difference(Row a, Row b, std::vector<int>& out) {
  combine(
      a, b, [](bool in_a, bool in_b) { return in_a != in_b; }, out);
}

// What is not in a row of [0, width), which is powder for ever on both sides: the result reaches
// from -1 to width + 1, where -1 and `width` stand for all that lies beyond.
inline void complement(Row a, int width, std::vector<int>& out) {
  const int ends[] = {-1, width + 1};
  combine(
      Row(ends), a, [](bool in_frame, bool in_a) { return in_frame && !in_a; }, out);
}

// The runs of `a` that share a voxel with `b`: calls take(index of a's run, index of b's run).
template <class Take>
void for_each_overlap(Row a, Row b, Take take) {
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (std::max(a[i], b[j]) < std::min(a[i + 1], b[j + 1])) take(i / 2, j / 2);
    if (a[i + 1] <= b[j + 1]) {
      i += 2;
    } else {
      j += 2;
    }
  }
}

}  // namespace binderjet::rows
