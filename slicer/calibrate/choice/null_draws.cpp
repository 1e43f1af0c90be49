// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/choice/null_draws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "slicer/calibrate/residual/printed_error.h"

namespace binderjet {

std::vector<std::vector<int>> sign_draws(int cells) {
  std::mt19937 engine(1);
  std::vector<std::vector<int>> draws(kNullDraws);
  for (std::vector<int>& draw : draws) {
    for (int k = 0; k < cells; ++k) draw.push_back((engine() & 1U) != 0 ? 1 : -1);
  }
  return draws;
}

double sum_of_cells(std::span<const double> gain) {
  return std::accumulate(gain.begin(), gain.end(), 0.0);
}

double p_over_all_gains(std::span<const std::vector<double>* const> family, double best) {
  int beaten = 0;
  for (const std::vector<int>& signs : sign_draws(kCells)) {
    beaten += std::any_of(family.begin(), family.end(), [&](const std::vector<double>* gain) {
      return std::inner_product(gain->begin(), gain->end(), signs.begin(), 0.0) >= best;
    });
  }
  return (1.0 + beaten) / (1 + kNullDraws);
}

bool most_agree(std::span<const double> slabs) {
  constexpr double kNothing = 0.02;
  const double least = -kNothing * sum_of_cells(slabs);
  return least < 0 &&
         std::count_if(slabs.begin(), slabs.end(), [&](double sum) { return sum < least; }) <= 1;
}

bool slabs_agree(std::span<const double> gain, unsigned along) {
  for (int axis = 0; axis < 3; ++axis) {
    if ((along & (1U << axis)) != 0) continue;
    std::array<double, kSlabs> sums{};
    for (int k = 0; k < kCells; ++k) {
      sums[static_cast<std::size_t>(slab_of_cell(k, axis))] += gain[static_cast<std::size_t>(k)];
    }
    if (!most_agree(sums)) return false;
  }
  return true;
}

bool alike(std::span<const double> best, std::span<const double> other) {
  double sum = 0;
  double squares = 0;
  for (std::size_t k = 0; k < best.size(); ++k) {
    const double d = best[k] - other[k];
    sum += d;
    squares += d * d;
  }
  const double cells = static_cast<double>(best.size());
  const double error = std::sqrt(std::max(0.0, squares - sum * sum / cells));
  constexpr double kAlike = 0.01;
  return sum <= std::max(error, kAlike * sum_of_cells(best));
}

}  // namespace binderjet
