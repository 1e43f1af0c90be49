// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/stamps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace binderjet {
namespace {

// The share of a kernel that has been placed up to `offset` voxels from the side of a row of
// pixels, which lands `part` beyond the voxel that offsets count from.
double placed_up_to(const Kernel& kernel, int offset, int part) {
  std::int64_t up_to = 0;
  for (int i = kernel.first; i < std::min(offset, kernel.last() + 1); ++i) up_to += kernel.at(i);
  return static_cast<double>(kFine * up_to + (kFine - part) * kernel.at(offset)) /
         (kFine * static_cast<double>(kernel.total()));
}

// What `rows` voxel rows of a pixel, the first of which lands `part` beyond the voxel that offsets
// count from, add to a voxel.
double row_share(const Kernel& kernel, int offset, int rows, int part) {
  std::int64_t sum = 0;
  for (int row = 0; row < rows; ++row) {
    const auto [whole, rest] = split_fine((offset - row) * kFine - part);
    sum += (kFine - rest) * kernel.at(whole) + rest * kernel.at(whole + 1);
  }
  return static_cast<double>(sum) / (kFine * static_cast<double>(kernel.total()));
}

}  // namespace

Stamps::Stamps(std::span<const DoseTerm> terms, int layer, const Grid& grid, int unit)
    : unit_(unit), pixel_rows_(grid.detail_vx[1]) {
  for (const DoseTerm& term : terms) {
    if (term.layer != layer) continue;
    const std::array<const Kernel*, 2> kernels{&term.x, &term.y};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const Kernel& kernel = *kernels[axis];
      first_[axis] = terms_.empty() ? kernel.first : std::min(first_[axis], kernel.first);
      last_[axis] = terms_.empty() ? kernel.last() : std::max(last_[axis], kernel.last());
    }
    terms_.push_back(term);
  }
}

const Stamp& Stamps::half_line(int part_x, int part_y) {
  const auto [at, is_new] = lines_.try_emplace({part_x, part_y});
  Stamp& line = at->second;
  if (!is_new) return line;
  line.first = first_;
  line.width = last_[0] - first_[0] + 2;
  line.height = last_[1] - first_[1] + pixel_rows_ + 1;
  std::vector<double> sum(static_cast<std::size_t>(line.width) *
                          static_cast<std::size_t>(line.height));
  for (const DoseTerm& term : terms_) {
    std::vector<double> along;
    for (int x = 0; x < line.width; ++x) {
      along.push_back(placed_up_to(term.x, first_[0] + x, part_x));
    }
    for (int y = 0; y < line.height; ++y) {
      const double share = term.gain * row_share(term.y, first_[1] + y, pixel_rows_, part_y);
      double* to = sum.data() + static_cast<std::ptrdiff_t>(y) * line.width;
      for (const double x : along) *to++ += share * x;
    }
  }
  for (const double share : sum) {
    line.dose.push_back(static_cast<std::int16_t>(std::lround(share * unit_)));
  }
  return line;
}

const Stamp& Stamps::pixel(const PixelFit& fit) {
  const auto [at, is_new] = pixels_.try_emplace(fit);
  Stamp& stamp = at->second;
  if (!is_new) return stamp;
  const FineLength end = split_fine(fit.part_x + fit.width);
  const Stamp& begins = half_line(fit.part_x, fit.part_y);
  const Stamp& ends = half_line(end.part, fit.part_y);
  stamp.first = first_;
  // Behind the last column that rises both lines are alike.
  const int columns = begins.width - 1 + std::max(0, end.whole);
  stamp.width = (columns + kStampVector - 1) / kStampVector * kStampVector;
  stamp.height = begins.height;
  for (int y = 0; y < stamp.height; ++y) {
    const auto in_row = [y](const Stamp& line, int x) {
      if (x < 0) return std::int16_t{0};
      return line.dose[static_cast<std::size_t>(y * line.width + std::min(x, line.width - 1))];
    };
    for (int x = 0; x < stamp.width; ++x) {
      stamp.dose.push_back(
          static_cast<std::int16_t>(in_row(begins, x) - in_row(ends, x - end.whole)));
    }
  }
  return stamp;
}

}  // namespace binderjet
