// SPDX-License-Identifier: GPL-3.0-or-later
// Chance, for gains that are counted in cells. Cells are larger than the residual is correlated
// over, so if nothing is hidden in a print, a cell's gain might as well have been a loss:
//
//   draw     each of the 125 cells gets a sign, + or - with even odds
//   null     the best of all candidates after the draw's signs were applied
//   p        (1 + draws whose null reaches the real best) / (1 + 499)
//
// "The best of all" counts every candidate that was tried: trying more makes each less sure.
#pragma once

#include <span>
#include <vector>

namespace binderjet {

constexpr int kNullDraws = 499;

// A sign for each cell in each draw; the same every time.
std::vector<std::vector<int>> sign_draws(int cells);

double sum_of_cells(std::span<const double> gain);

// How often the best of the family does at least as well as `best` when each cell's gain may as
// well have been a loss.
double p_over_all_gains(std::span<const std::vector<double>* const> family, double best);

// All in all a gain, and at most one slab loses. A slab that gains or loses less than a fiftieth of
// the whole has no vote: where an effect has nothing to act on (no edge, no gap) chance alone sets
// the sign, and three such slabs would reject every second effect that is there.
bool most_agree(std::span<const double> slabs);
// The same along every axis that is not in `along` (candidates.h).
bool slabs_agree(std::span<const double> gain, unsigned along);

// Whether two gains are apart by no more than one standard error of their difference, cell by cell,
// or by so little that it is no difference to a person.
bool alike(std::span<const double> best, std::span<const double> other);

}  // namespace binderjet
