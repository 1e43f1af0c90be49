// SPDX-License-Identifier: GPL-3.0-or-later
// The mask rules on the runs of a whole layer: runs of touching rows that overlap are one region
// (union-find), and the runs of regions with too few pixels go.
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "slicer/enhance/rules/mask_rules.h"
#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

// The regions of a picture that is given row by row, by their runs.
class RunRegions {
 public:
  void add(rows::Row row) {
    const std::size_t first = parent_.size();
    for (std::size_t i = 0; i < row.size(); i += 2) {
      parent_.push_back(parent_.size());
      pixels_.push_back(row[i + 1] - row[i]);
    }
    rows::for_each_overlap(row, last_, [&](std::size_t here, std::size_t below) {
      join(first + here, last_first_ + below);
    });
    last_.assign(row.begin(), row.end());
    last_first_ = first;
  }

  // Makes the region of the first run larger than any minimum.
  void keep_first() { pixels_[root(0)] += std::int64_t{1} << 40; }

  // Regions with fewer pixels; every region's pixels are counted at its root.
  std::int64_t count_below(std::int64_t least) const {
    std::int64_t count = 0;
    for (std::size_t run = 0; run < parent_.size(); ++run) {
      if (parent_[run] == run && pixels_[run] < least) ++count;
    }
    return count;
  }
  std::int64_t pixels(std::size_t run) { return pixels_[root(run)]; }

 private:
  std::size_t root(std::size_t run) {
    while (parent_[run] != run) run = parent_[run] = parent_[parent_[run]];
    return run;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    parent_[a] = b;
    pixels_[b] += pixels_[a];
  }

  std::vector<std::size_t> parent_;
  std::vector<std::int64_t> pixels_;
  std::vector<int> last_;
  std::size_t last_first_ = 0;
};

// The runs of `row`, the first of them number `run` among all, whose regions are too small.
void small_runs(rows::Row row, RunRegions& regions, std::int64_t least, std::size_t& run,
                std::vector<int>& out) {
  out.clear();
  for (std::size_t i = 0; i < row.size(); i += 2, ++run) {
    if (regions.pixels(run) < least) out.insert(out.end(), {row[i], row[i + 1]});
  }
}

std::int64_t erase_islands(RunLayer& mask, std::int64_t least) {
  RunRegions regions;
  for (int y = 0; y < mask.height(); ++y) regions.add(mask.row(y));
  const std::int64_t count = regions.count_below(least);
  if (count == 0) return 0;
  RunLayer out(mask.width());
  std::vector<int> gone;
  std::vector<int> row;
  std::size_t run = 0;
  for (int y = 0; y < mask.height(); ++y) {
    small_runs(mask.row(y), regions, least, run, gone);
    rows::subtract(mask.row(y), gone, row);
    out.append_row(row);
  }
  mask = std::move(out);
  return count;
}

// The powder around the mask, here a frame of one pixel, and what hangs together with it is no
// hole.
std::int64_t fill_holes(RunLayer& mask, std::int64_t least) {
  RunRegions regions;
  std::vector<int> powder;
  const int ends[] = {-1, mask.width() + 1};
  const auto surrounded = [&](int y) -> rows::Row {
    if (y < 0 || y == mask.height()) return ends;
    rows::complement(mask.row(y), mask.width(), powder);
    return powder;
  };
  for (int y = -1; y <= mask.height(); ++y) regions.add(surrounded(y));
  regions.keep_first();
  const std::int64_t count = regions.count_below(least);
  if (count == 0) return 0;
  RunLayer out(mask.width());
  std::vector<int> filled;
  std::vector<int> row;
  std::size_t run = 1;  // after the frame's first row
  for (int y = 0; y < mask.height(); ++y) {
    small_runs(surrounded(y), regions, least, run, filled);
    rows::unite(mask.row(y), filled, row);
    out.append_row(row);
  }
  mask = std::move(out);
  return count;
}

}  // namespace

ObeyingMask obeying_mask(const RunLayer& mask, const MaskRules& rules) {
  ObeyingMask out{mask, {}};
  if (rules.min_hole_px > 1) out.changes.holes_filled = fill_holes(out.mask, rules.min_hole_px);
  if (rules.min_island_px > 1) {
    out.changes.islands_erased = erase_islands(out.mask, rules.min_island_px);
  }
  return out;
}

}  // namespace binderjet
