// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/dose/box_filter.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace binderjet {
namespace {

// An input row's share in one voxel row of the result.
struct RowShare {
  int row;
  std::int64_t weight;
};

// The input rows within reach of voxel row `y`, each with the sum of its voxel rows' weights.
void shares_of(int y, int repeat, int rows, const BoxWeights& weights,
               std::vector<RowShare>& shares) {
  shares.clear();
  const int first = std::max(0, y - weights.reach);
  const int last = std::min(rows * repeat - 1, y + weights.reach);
  for (int row = first / repeat; row * repeat <= last; ++row) {
    std::int64_t weight = 0;
    for (int voxel_row = row * repeat; voxel_row < (row + 1) * repeat; ++voxel_row) {
      weight += weights.at(voxel_row - y);
    }
    shares.push_back({row, weight});
  }
}

// Writes the rows of the result, one voxel row after the other.
class BoxRowBuilder {
 public:
  BoxRowBuilder(const RunLayer& in, int repeat, const BoxWeights& x, std::int64_t least,
                RunLayer& out)
      : in_(in), repeat_(repeat), x_(x), least_(least), out_(out) {}

  void build(const std::vector<RowShare>& shares) {
    if (!build_edges(shares)) build_ramps(shares);
    out_.end_row();
  }

 private:
  // The common case: all rows in reach have the same runs but for a slope, and the slopes of
  // different flips do not meet. Then the sum only rises or only falls along each slope, and the
  // flip is where it passes `least`.
  bool build_edges(const std::vector<RowShare>& shares) {
    const std::size_t flips = shares.empty() ? 0 : in_.row(shares.front().row).size();
    rows_.clear();
    std::int64_t weight = 0;
    for (const RowShare& share : shares) {
      const std::span<const int> row = in_.row(share.row);
      if (row.size() != flips) return false;
      rows_.push_back(row.data());
      weight += share.weight;
    }
    const std::int64_t full = weight * x_.total();
    places_.resize(flips, 0);
    int end = -2 * x_.reach - 1;  // of the slope before
    for (std::size_t i = 0; i < flips; ++i) {
      const Slope slope = slope_of(shares, i);
      if (slope.low - x_.reach < end) return false;
      end = slope.high + x_.reach + 1;
      if (full < least_) continue;
      const std::int64_t needed = i % 2 == 0 ? least_ : full - least_ + 1;
      const std::optional<int> place = straight_place(needed, slope, weight);
      places_[i] = place ? *place : first_at_least(needed, shares, i, places_[i]);
    }
    // A flip may leave the layer together with the powder around it.
    for (std::size_t i = 0; i < flips && full >= least_; ++i) {
      out_.flip(std::clamp(places_[i], 0, out_.width()));
    }
    return true;
  }

  // The flips of one rank in all rows in reach, in voxels.
  struct Slope {
    int low;
    int high;
    std::int64_t weighted;  // their sum, each times its row's weight
  };

  Slope slope_of(const std::vector<RowShare>& shares, std::size_t i) const {
    int low = rows_.front()[i];
    int high = low;
    std::int64_t weighted = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const int flip = rows_[r][i];
      low = std::min(low, flip);
      high = std::max(high, flip);
      weighted += shares[r].weight * flip;
    }
    return {low * repeat_, high * repeat_, weighted * repeat_};
  }

  // Along a steep edge the ramps of all rows lie over each other, and where they do their sum is a
  // straight line: the first place with at least `needed` on it, if it is on it.
  std::optional<int> straight_place(std::int64_t needed, const Slope& slope,
                                    std::int64_t weight) const {
    const int first = slope.high - x_.reach;    // all ramps have begun
    const int last = slope.low + x_.reach - 1;  // none has ended
    if (first >= last) return std::nullopt;
    const std::int64_t rise = weight * x_.full;
    const std::int64_t from = weight * (x_.end + x_.reach * x_.full) - slope.weighted * x_.full;
    const std::int64_t above = needed - from;
    const std::int64_t place = above / rise + (above % rise > 0 ? 1 : 0);
    if (place <= first || place > last) return std::nullopt;
    return static_cast<int>(place);
  }

  // The sum at x of the half-lines that begin at flip `i` of each row.
  std::int64_t half_lines(const std::vector<RowShare>& shares, std::size_t i, int x) const {
    std::int64_t sum = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      // A ramp is a straight line but for its ends, which weigh less than a whole step.
      const std::int64_t inside = x - rows_[r][i] * repeat_ + x_.reach;
      const std::int64_t rise = std::clamp(x_.end + inside * x_.full, std::int64_t{0}, x_.total());
      sum += shares[r].weight * rise;
    }
    return sum;
  }

  int first_at_least(std::int64_t needed, const std::vector<RowShare>& shares, std::size_t i,
                     int guess) const {
    // Far from the slope the sum is flat and says nothing about the way.
    const int at = rows_.front()[i] * repeat_;
    if (guess < at - 2 * x_.reach || guess > at + 2 * x_.reach) guess = at;
    if (half_lines(shares, i, guess) >= needed) {
      while (half_lines(shares, i, guess - 1) >= needed) --guess;
      return guess;
    }
    do ++guess;
    while (half_lines(shares, i, guess) < needed);
    return guess;
  }

  // A flip of some input row, in voxels, and the weight of its row.
  struct Ramp {
    int at;
    std::int64_t weight;  // negative where a run ends
  };

  // The general case: the sum is followed over all ramps from left to right.
  void build_ramps(const std::vector<RowShare>& shares) {
    ramps_.clear();
    for (const RowShare& share : shares) {
      std::int64_t sign = 1;
      for (const int flip : in_.row(share.row)) {
        ramps_.push_back({flip * repeat_, sign * share.weight});
        sign = -sign;
      }
    }
    std::sort(ramps_.begin(), ramps_.end(),
              [](const Ramp& a, const Ramp& b) { return a.at < b.at; });
    sum_ = 0;
    solid_ = false;
    for (std::size_t i = 0; i < ramps_.size();) {
      const int begin = ramps_[i].at - x_.reach;
      int end = ramps_[i].at + x_.reach + 1;
      std::size_t next = i + 1;
      for (; next < ramps_.size() && ramps_[next].at - x_.reach <= end; ++next) {
        end = ramps_[next].at + x_.reach + 1;
      }
      walk(begin, end, {ramps_.data() + i, next - i});
      i = next;
    }
    if (solid_) out_.flip(out_.width());
  }

  // Follows the sum over [begin, end), which holds these ramps whole; it is constant behind.
  void walk(int begin, int end, std::span<const Ramp> ramps) {
    steps_.assign(static_cast<std::size_t>(end - begin) + 2, 0);
    for (const Ramp& ramp : ramps) {
      // The sum rises by end, full, ..., full, end: four changes of the step.
      std::int64_t* step = steps_.data() + (ramp.at - x_.reach - begin);
      const int length = 2 * x_.reach + 1;
      if (x_.reach == 0) {
        step[0] += x_.end * ramp.weight;
        step[1] -= x_.end * ramp.weight;
        continue;
      }
      step[0] += x_.end * ramp.weight;
      step[1] += (x_.full - x_.end) * ramp.weight;
      step[length - 1] -= (x_.full - x_.end) * ramp.weight;
      step[length] -= x_.end * ramp.weight;
    }
    std::int64_t step = 0;
    for (int x = begin; x < end; ++x) {
      step += steps_[static_cast<std::size_t>(x - begin)];
      sum_ += step;
      if ((sum_ >= least_) != solid_) {
        solid_ = !solid_;
        out_.flip(std::clamp(x, 0, out_.width()));
      }
    }
  }

  const RunLayer& in_;
  int repeat_;
  const BoxWeights& x_;
  std::int64_t least_;
  RunLayer& out_;
  std::vector<const int*> rows_;  // the flips of the rows in reach
  std::vector<int> places_;       // of the flips in the result, here or in the row before
  std::vector<Ramp> ramps_;
  std::vector<std::int64_t> steps_;
  std::int64_t sum_ = 0;
  bool solid_ = false;
};

}  // namespace

BoxWeights box_weights(double width_vx) {
  constexpr std::int64_t kFull = std::int64_t{1} << 16;
  BoxWeights weights;
  weights.full = kFull;
  weights.end = kFull;
  if (width_vx <= 1) return weights;
  const double half = width_vx / 2 - 0.5;  // beyond the center voxel, on each side
  const int whole = static_cast<int>(half);
  const std::int64_t fraction = std::llround((half - whole) * static_cast<double>(kFull));
  weights.reach = whole;
  if (fraction > 0) {
    weights.reach = whole + 1;
    weights.end = fraction;
  }
  return weights;
}

std::int64_t min_sum(const BoxWeights& x, const BoxWeights& y, double level) {
  // A product that is whole but for rounding is that number: an exact tie counts as printed.
  constexpr double kRounding = 1e-12;
  const double sum = level * static_cast<double>(x.total()) * static_cast<double>(y.total());
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(sum * (1 - kRounding))));
}

RunLayer box_threshold(const RunLayer& in, std::array<int, 2> repeat, const BoxWeights& x,
                       const BoxWeights& y, std::int64_t least) {
  const int height = in.height() * repeat[1];
  RunLayer out(in.width() * repeat[0]);
  out.reserve(height, in.flip_count() * static_cast<std::size_t>(repeat[1]));
  BoxRowBuilder builder(in, repeat[0], x, least, out);
  std::vector<RowShare> shares;
  for (int row = 0; row < height; ++row) {
    shares_of(row, repeat[1], in.height(), y, shares);
    builder.build(shares);
  }
  return out;
}

}  // namespace binderjet
