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
// ragged (2 to 3 times as much edge as plain ones, else 1.8) and print no better; with 0.6 edges
// are 1.5 times as long, and a third more is wrong beside slots.
constexpr double kEdgePrice = 0.2;
constexpr double kHingeSlope = 4;  // what a dose of 1 costs in the hinge, in wrong slices
constexpr int kMostRounds = 12;    // of a stage; hardly any place takes more than six
// How far from the boundary pixels may flip: with 1 the excess is twice as large, 4 is no better.
constexpr int kReachPx = 3;
// Pairs of pixels lie this far apart at most along x and y: with 1 a third of their gain is lost, 3
// gains a thirtieth more at twice the looks.
constexpr int kPairReachPx = 2;
// What the first pixel of a pair may cost alone, in voxels that are wrong under all models: with 1
// half of the gain is lost.
constexpr int kMostAlone = 3;
// A pair that costs the printer more voxels than this is not asked what drifted models gain by it.
constexpr int kMostDriftedGain = 1;
constexpr int kMostPairRounds = 6;
// Each time that a fault is searched again. With 8 faults go in fewer rounds, and combs pay half as
// much again for the mending.
constexpr int kFaultTimes = 4;
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
  pair_waits_ = free_;
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

template <class Act>
void MaskSearch::each_open_in(const Rect& pixels, Act act) const {
  const int end_row = std::min(start_.height(), pixels.y1);
  for (int y = std::max(0, pixels.y0); y < end_row; ++y) {
    const auto [begin, end] = doses_.runs_of(y);
    for (std::size_t r = begin; r < end; ++r) {
      const PixelRun& run = doses_.runs()[r];
      const int x0 = std::max(run.x0, pixels.x0);
      const int x1 = std::min(run.x1, pixels.x1);
      if (x0 < x1) act(r, x0, x1);
    }
  }
}

Rect MaskSearch::near(int x, int y) const {
  return Rect{x, y, x + 1, y + 1}.grown(near_px_[0], near_px_[1]);
}

std::size_t MaskSearch::number(const OpenPixel& pixel) const {
  const PixelRun& run = doses_.runs()[pixel.run];
  return run.first + static_cast<std::size_t>(pixel.x - run.x0);
}

void MaskSearch::wait_around(const RunLayer& voxels) {
  const auto [rx, ry, rz] = by_.grid.detail_vx;
  for (int v = 0; v < voxels.height(); ++v) {
    const rows::Row row = voxels.row(v);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      const Rect pixels{row[i] / rx, v / ry, (row[i + 1] - 1) / rx + 1, v / ry + 1};
      each_open_in(pixels.grown(2 * near_px_[0], 2 * near_px_[1]),
                   [&](std::size_t run, int x0, int x1) {
                     std::fill_n(free_.begin() + static_cast<std::ptrdiff_t>(number({run, x0})),
                                 x1 - x0, std::uint8_t{1});
                   });
    }
  }
}

void MaskSearch::run_stages() {
  const auto units = [&](double dose) { return static_cast<int>(std::lround(dose * by_.unit)); };
  const int level = by_.models.front().levels.front().least;
  const auto on_ramp = [&](const Ramp& ramp, double edge_price) {
    doses_.enter(ramp);
    waiting_ = free_;
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
  const auto count = [&](const OpenPixel& pixel, int sign) {
    return doses_.nominal_change(pixel, sign) + doses_.drifted_change(pixel, sign);
  };
  const auto edge_price = static_cast<int>(std::lround(kEdgePrice * doses_.weights() * kPriceUnit));
  waiting_ = free_;
  run_stage(edge_price, count);
  pair_waits_ = free_;
  for (int round = 0; round < kMostPairRounds && flip_pairs(edge_price); ++round) {
    run_stage(edge_price, count);
  }
}

template <class Change>
void MaskSearch::run_stage(int edge_price, Change change) {
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
  std::uint8_t& waits = waiting_[number(pixel)];
  if (waits == 0) return;
  waits = 0;
  if (would_stand_alone(pixel)) return;
  if (change(pixel, sign(pixel)) + edge_price * edge_change(pixel) >= 0) return;
  state(pixel) ^= 1;
  if (!rules_.fits_around(mask_, pixel.x, row(pixel))) {
    state(pixel) ^= 1;
    return;
  }
  doses_.flip(pixel, -sign(pixel));
  ++flips_;
  look_again(pixel);
  waits = 0;
}

bool MaskSearch::flip_pairs(int edge_price) {
  bool any = false;
  const std::span<const PixelRun> runs = doses_.runs();
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (int x = runs[r].x0; x < runs[r].x1; ++x) {
      std::uint8_t& waits = pair_waits_[number({r, x})];
      if (waits == 0) continue;
      waits = 0;
      if (flip_pair_at({r, x}, edge_price)) any = true;
    }
  }
  return any;
}

// Flips the pixel and the one near it with which all costs fall the most, if they fall.
bool MaskSearch::flip_pair_at(const OpenPixel& pixel, int edge_price) {
  const std::optional<int> alone =
      count_change(pixel, edge_price, kMostAlone * kPriceUnit * doses_.weights());
  if (!alone || *alone > kMostAlone * kPriceUnit * doses_.weights()) return false;
  flip(pixel);
  int least = 0;
  std::optional<OpenPixel> best;
  const Rect around =
      Rect{pixel.x, row(pixel), pixel.x + 1, row(pixel) + 1}.grown(kPairReachPx, kPairReachPx);
  each_open_in(around, [&](std::size_t run, int x0, int x1) {
    for (int x = x0; x < x1; ++x) {
      const OpenPixel other{run, x};
      if (free_[number(other)] == 0 || (run == pixel.run && x == pixel.x)) continue;
      const std::optional<int> then = count_change(other, edge_price, least - *alone);
      if (!then || *alone + *then >= least) continue;
      least = *alone + *then;
      best = other;
    }
  });
  if (best) {
    flip(*best);
    if (rules_.fits_around(mask_, pixel.x, row(pixel)) &&
        rules_.fits_around(mask_, best->x, row(*best))) {
      look_again(pixel);
      look_again(*best);
      return true;
    }
    flip(*best);
  }
  flip(pixel);
  return false;
}

std::optional<int> MaskSearch::count_change(const OpenPixel& pixel, int edge_price,
                                            int most) const {
  if (would_stand_alone(pixel)) return {};
  const int nominal = doses_.nominal_change(pixel, sign(pixel)) + edge_price * edge_change(pixel);
  if (nominal > most + kMostDriftedGain * kNominalWeight * kPriceUnit) return {};
  return nominal + doses_.drifted_change(pixel, sign(pixel));
}

void MaskSearch::flip(const OpenPixel& pixel) {
  doses_.flip(pixel, sign(pixel));
  state(pixel) ^= 1;
}

// How much longer the mask's edge gets by a flip, in pixel sides.
int MaskSearch::edge_change(const OpenPixel& pixel) const {
  const std::uint8_t* at = mask_.at(pixel.x, row(pixel));
  const std::ptrdiff_t pitch = mask_.rect().width();
  const int differ = static_cast<int>(at[1] != *at) + static_cast<int>(at[-1] != *at) +
                     static_cast<int>(at[pitch] != *at) + static_cast<int>(at[-pitch] != *at);
  return 4 - 2 * differ;
}

// Whether the flip would make an island or a hole of one pixel, and the rules want more.
bool MaskSearch::would_stand_alone(const OpenPixel& pixel) const {
  const int least = sign(pixel) > 0 ? by_.rules.min_island_px : by_.rules.min_hole_px;
  return least > 1 && edge_change(pixel) == 4;
}

void MaskSearch::look_again(const OpenPixel& pixel) {
  each_open_in(near(pixel.x, row(pixel)), [&](std::size_t run, int x0, int x1) {
    const auto first = static_cast<std::ptrdiff_t>(number({run, x0}));
    std::copy_n(free_.begin() + first, x1 - x0, waiting_.begin() + first);
  });
  each_open_in(near(pixel.x, row(pixel)).grown(kPairReachPx, kPairReachPx),
               [&](std::size_t run, int x0, int x1) {
                 const auto first = static_cast<std::ptrdiff_t>(number({run, x0}));
                 std::copy_n(free_.begin() + first, x1 - x0, pair_waits_.begin() + first);
               });
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
