// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/mask_search.h"

#include <algorithm>
#include <cmath>

#include "slicer/enhance/inverse/search/layer_sets.h"
#include "slicer/enhance/inverse/search/open_pixels.h"
#include "slicer/enhance/inverse/search/prices.h"
#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

// By what a dose may miss the level before the hinge is satisfied. With half of it the process
// window narrows by a tenth, with twice as much features narrower than the spread come out worse.
constexpr double kMargin = 0.08;
constexpr double kRampWidth = 0.06;
// Of a pixel's side that is an edge of the mask, in wrong slices of a voxel. Without, masks are
// ragged (2 to 3 times as much edge) and print no better; in the last stage it settles ties only.
constexpr double kEdgePrice = 0.2;
constexpr double kLastEdgePrice = 0.03;
constexpr double kHingeSlope = 4;  // what a dose of 1 costs in the hinge, in wrong slices
constexpr int kMostRounds = 12;    // of a stage; hardly any place takes more than six
// How far from the boundary pixels may flip: with 1 the excess is twice as large, 4 is no better.
constexpr int kReachPx = 3;
constexpr int kFaultTimes = 8;  // each time that a fault is searched again
// Beyond this a hinge rises no further: no dose is as far off, and sums stay within 16 bits.
constexpr int kHingeSpan = 12000;

// Pixels within reach of the boundary of a layer that the mask prints into.
RunLayer open_around(const SearchModel& by, const LayerWindow& layers) {
  RunLayer out = RunLayer::powder(layers.middle().mask->width(), layers.middle().mask->height());
  for (const int offset : by.offsets.printed) {
    if (layers.at(offset) == nullptr) continue;
    out = either(out, open_pixels(*layers.at(offset)->target, by.grid, kReachPx));
  }
  return out;
}

}  // namespace

MaskSearch::MaskSearch(const SearchModel& by, const LayerWindow& layers)
    : by_(by),
      start_(*layers.middle().mask),
      open_(open_around(by, layers)),
      doses_(by, layers, open_),
      rules_(by.rules) {
  const int most = std::max(1, by.rules.largest_px());
  mask_.reset(Rect{0, 0, start_.width(), start_.height()}.grown(most, most), 0);
  add_layer(start_, std::uint8_t{1}, mask_);
  const auto [x, y] = doses_.pixel_reach();
  near_px_ = {(x + 2) / 3, (y + 2) / 3};
  if (!doses_.runs().empty()) {
    const PixelRun& last = doses_.runs().back();
    waiting_.resize(last.first + static_cast<std::size_t>(last.x1 - last.x0));
  }
  free_.assign(waiting_.size(), 1);
}

void MaskSearch::run() {
  if (!free_.empty()) run_stages();
}

void MaskSearch::run_again(std::span<const SearchFaults> faults) {
  std::fill(free_.begin(), free_.end(), std::uint8_t{0});
  for (const SearchFaults& of : faults) {
    doses_.raise_prices(of.offset, of.missing, true, kFaultTimes);
    doses_.raise_prices(of.offset, of.surplus, false, kFaultTimes);
    wait_around(of.missing);
    wait_around(of.surplus);
    seed(of.missing, 1);
    seed(of.surplus, 0);
  }
  run_stages();
}

// Single flips never begin an island or a hole, which the rules want larger than a pixel.
void MaskSearch::seed(const RunLayer& voxels, std::uint8_t state) {
  const auto [rx, ry, rz] = by_.grid.detail_vx;
  Rect changed;
  for (int v = 0; v < voxels.height(); ++v) {
    const rows::Row row = voxels.row(v);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      for (int y = v / ry - 1; y <= v / ry + 1; ++y) {
        if (y < 0 || y >= open_.height()) continue;
        for (int x = row[i] / rx - 1; x <= (row[i + 1] - 1) / rx + 1; ++x) {
          if (x >= 0 && x < open_.width() && open_.at(x, y)) *mask_.at(x, y) = state;
        }
      }
      const Rect near{row[i] / rx - 1, v / ry - 1, (row[i + 1] - 1) / rx + 2, v / ry + 2};
      changed = changed.empty() ? near : changed.joined(near);
    }
  }
  if (changed.empty()) return;
  seeded_ = true;
  const int most = by_.rules.largest_px();
  obey(by_.rules, changed.grown(most, most).cut({0, 0, open_.width(), open_.height()}), mask_);
}

void MaskSearch::wait_around(const RunLayer& voxels) {
  const auto [rx, ry, rz] = by_.grid.detail_vx;
  for (int v = 0; v < voxels.height(); ++v) {
    const rows::Row row = voxels.row(v);
    if (row.empty()) continue;
    const int y0 = std::max(0, v / ry - 2 * near_px_[1]);
    const int y1 = std::min(start_.height(), v / ry + 2 * near_px_[1] + 1);
    for (int y = y0; y < y1; ++y) {
      const auto [begin, end] = doses_.runs_of(y);
      for (std::size_t r = begin; r < end; ++r) {
        const PixelRun& run = doses_.runs()[r];
        for (std::size_t i = 0; i < row.size(); i += 2) {
          const int x0 = std::max(run.x0, row[i] / rx - 2 * near_px_[0]);
          const int x1 = std::min(run.x1, (row[i + 1] - 1) / rx + 2 * near_px_[0] + 1);
          for (int x = x0; x < x1; ++x) free_[run.first + static_cast<std::size_t>(x - run.x0)] = 1;
        }
      }
    }
  }
}

void MaskSearch::run_stages() {
  const auto units = [&](double dose) { return static_cast<int>(std::lround(dose * by_.unit)); };
  const int level = by_.models.front().levels.front().least;
  const auto on_ramp = [&](const Ramp& ramp, double edge_price) {
    doses_.enter(ramp);
    run_stage(
        static_cast<int>(std::lround(edge_price * kPriceUnit)),
        [&](const OpenPixel& pixel, int sign) { return doses_.ramp_change(pixel, sign, ramp); });
    doses_.leave(ramp);
  };
  doses_.fill_nominal(mask());
  on_ramp({level - units(kMargin), level + units(kMargin) - kHingeSpan, kHingeSpan},
          kEdgePrice / kHingeSlope * by_.unit);
  const int width = units(kRampWidth);
  on_ramp({level - width / 2, level - width / 2, width}, kEdgePrice * width);
  doses_.fill_drifted(mask());
  run_stage(static_cast<int>(std::lround(kLastEdgePrice * doses_.weights() * kPriceUnit)),
            [&](const OpenPixel& pixel, int sign) { return doses_.count_change(pixel, sign); });
}

template <class Change>
void MaskSearch::run_stage(int edge_price, Change change) {
  waiting_ = free_;
  const std::span<const PixelRun> runs = doses_.runs();
  for (int round = 0; round < kMostRounds; ++round) {
    const std::int64_t before = flips_;
    if (round % 2 == 0) {
      for (std::size_t r = 0; r < runs.size(); ++r) {
        for (int x = runs[r].x0; x < runs[r].x1; ++x) look({r, x}, edge_price, change);
      }
    } else {
      for (std::size_t r = runs.size(); r-- > 0;) {
        for (int x = runs[r].x1; x-- > runs[r].x0;) look({r, x}, edge_price, change);
      }
    }
    if (flips_ == before) break;
  }
}

template <class Change>
void MaskSearch::look(const OpenPixel& pixel, int edge_price, Change& change) {
  const PixelRun& run = doses_.runs()[pixel.run];
  std::uint8_t& waits = waiting_[run.first + static_cast<std::size_t>(pixel.x - run.x0)];
  if (waits == 0) return;
  waits = 0;
  std::uint8_t& state = *mask_.at(pixel.x, run.y);
  const int sign = state != 0 ? -1 : 1;
  if (change(pixel, sign) + edge_price * edge_change(pixel.x, run.y) >= 0) return;
  state ^= 1;
  if (!rules_.fits_around(mask_, pixel.x, run.y)) {
    state ^= 1;
    return;
  }
  doses_.flip(pixel, sign);
  ++flips_;
  look_again(pixel.x, run.y);
  waits = 0;
}

// How much longer the mask's edge gets by a flip, in pixel sides.
int MaskSearch::edge_change(int x, int y) const {
  const std::uint8_t own = *mask_.at(x, y);
  const int differ =
      static_cast<int>(*mask_.at(x + 1, y) != own) + static_cast<int>(*mask_.at(x - 1, y) != own) +
      static_cast<int>(*mask_.at(x, y + 1) != own) + static_cast<int>(*mask_.at(x, y - 1) != own);
  return 4 - 2 * differ;
}

void MaskSearch::look_again(int x, int y) {
  const int last = std::min(start_.height() - 1, y + near_px_[1]);
  for (int v = std::max(0, y - near_px_[1]); v <= last; ++v) {
    const auto [begin, end] = doses_.runs_of(v);
    for (std::size_t r = begin; r < end; ++r) {
      const PixelRun& run = doses_.runs()[r];
      const int x0 = std::max(run.x0, x - near_px_[0]);
      const int x1 = std::min(run.x1, x + near_px_[0] + 1);
      if (x0 >= x1) continue;
      const std::size_t first = run.first + static_cast<std::size_t>(x0 - run.x0);
      std::copy_n(free_.begin() + static_cast<std::ptrdiff_t>(first), x1 - x0,
                  waiting_.begin() + static_cast<std::ptrdiff_t>(first));
    }
  }
}

RunLayer MaskSearch::mask() const {
  RunLayer out(start_.width());
  std::vector<int> fixed;
  std::vector<int> row;
  for (int y = 0; y < start_.height(); ++y) {
    // Flips of what is fixed, then those of the open pixels: where both flip, neither does.
    std::vector<int> open;
    const rows::Row may_flip = open_.row(y);
    for (std::size_t i = 0; i < may_flip.size(); i += 2) {
      bool before = false;
      for (int x = may_flip[i]; x < may_flip[i + 1]; ++x) {
        const bool on = *mask_.at(x, y) != 0;
        if (on != before) open.push_back(x);
        before = on;
      }
      if (before) open.push_back(may_flip[i + 1]);
    }
    rows::subtract(start_.row(y), may_flip, fixed);
    rows::unite(fixed, open, row);
    out.append_row(row);
  }
  // What a seed leaves of an island or a hole may lie among the fixed pixels, where no flip mends
  // it.
  return seeded_ ? obeying_mask(out, by_.rules).mask : out;
}

}  // namespace binderjet
