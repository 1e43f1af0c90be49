// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/box_filter.h"

#include <algorithm>
#include <cmath>
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
  for (int voxel_row = first; voxel_row <= last; ++voxel_row) {
    const int row = voxel_row / repeat;
    if (shares.empty() || shares.back().row != row) shares.push_back({row, 0});
    shares.back().weight += weights.at(voxel_row - y);
  }
}

// A flip of some input row, in voxels, and what it adds to the sum once it is fully inside.
struct Ramp {
  int at;
  std::int64_t weight;
};

// Writes one row of the result while the sum is followed from left to right.
class RowBuilder {
 public:
  RowBuilder(RunLayer& out, const BoxWeights& x, std::int64_t least)
      : out_(out), x_(x), least_(least) {}

  // The ramps of one row, ascending.
  void build(const std::vector<Ramp>& ramps) {
    sum_ = 0;
    solid_ = false;
    for (std::size_t i = 0; i < ramps.size();) {
      const int begin = ramps[i].at - x_.reach;
      int end = ramps[i].at + x_.reach + 1;
      std::size_t next = i + 1;
      for (; next < ramps.size() && ramps[next].at - x_.reach <= end; ++next) {
        end = ramps[next].at + x_.reach + 1;
      }
      walk(begin, end, {ramps.data() + i, next - i});
      i = next;
    }
    if (solid_) out_.flip(out_.width());
    out_.end_row();
  }

 private:
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

  RunLayer& out_;
  const BoxWeights& x_;
  std::int64_t least_;
  std::int64_t sum_ = 0;
  bool solid_ = false;
  std::vector<std::int64_t> steps_;
};

}  // namespace

BoxWeights box_weights(double width_vx) {
  constexpr std::int64_t kFull = std::int64_t{1} << 16;
  BoxWeights weights;
  weights.full = kFull;
  weights.end = kFull;
  if (width_vx <= 1) return weights;
  const double half = width_vx / 2 - 0.5;  // beyond the centre voxel, on each side
  const int whole = static_cast<int>(half);
  const std::int64_t fraction = std::llround((half - whole) * static_cast<double>(kFull));
  weights.reach = whole;
  if (fraction > 0) {
    weights.reach = whole + 1;
    weights.end = fraction;
  }
  return weights;
}

std::int64_t least_sum(const BoxWeights& x, const BoxWeights& y, double level) {
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
  RowBuilder builder(out, x, least);
  std::vector<RowShare> shares;
  std::vector<Ramp> ramps;
  for (int row = 0; row < height; ++row) {
    shares_of(row, repeat[1], in.height(), y, shares);
    ramps.clear();
    for (const RowShare& share : shares) {
      std::int64_t sign = 1;
      for (const int flip : in.row(share.row)) {
        ramps.push_back({flip * repeat[0], sign * share.weight});
        sign = -sign;
      }
    }
    std::sort(ramps.begin(), ramps.end(), [](const Ramp& a, const Ramp& b) { return a.at < b.at; });
    builder.build(ramps);
  }
  return out;
}

}  // namespace binderjet
