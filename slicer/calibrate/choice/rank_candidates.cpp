// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/choice/rank_candidates.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

#include "slicer/base/work.h"
#include "slicer/calibrate/choice/null_draws.h"
#include "slicer/calibrate/choice/regression.h"

namespace binderjet {
namespace {

using regression::Field;
using regression::FittedAlready;
using regression::Score;
using regression::Vector;

// A step or a window with nearly all points on one side says nothing of its place.
bool covers_all(const Candidate& candidate, const Field& field) {
  using Form = Covariate::Form;
  const Form form = candidate.covariate.form;
  if (candidate.columns.front().basis == Column::Basis::kModel) return false;
  if (form != Form::kStep && form != Form::kWindow) return false;
  if (candidate.has_given_place) return false;
  constexpr double kMost = 0.95;
  const auto inside = std::count_if(field.spots.begin(), field.spots.end(), [&](const Spot& spot) {
    return candidate.columns.front().of(spot) > 0.5;
  });
  return static_cast<double>(inside) > kMost * static_cast<double>(field.spots.size());
}

// What makes two candidates the same finding.
auto finding(const Candidate& candidate) {
  return std::make_tuple(candidate.kind, candidate.covariate.axis, candidate.covariate.form);
}

}  // namespace

std::vector<ScoredCandidate> rank_candidates(const MeasuredJob& job, const EffectList& model,
                                             const std::vector<SurfacePoint>& points,
                                             const std::vector<std::vector<float>>& known,
                                             const std::vector<Candidate>& candidates) {
  constexpr std::size_t kFewestPoints = 500;
  if (points.size() < kFewestPoints) return {};
  const Field field = regression::field_of(job, model, points);
  const FittedAlready others(known, field);
  double power = 0;
  for (const float r : others.residual()) power += static_cast<double>(r) * r;
  if (power <= 0) return {};

  std::vector<Score> scores(candidates.size());
  Stage stage(job.work, "weighing candidates", static_cast<std::int64_t>(candidates.size()),
              "candidates");
  oneapi::tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
    stage.advance();
    if (covers_all(candidates[i], field)) return;
    std::vector<std::vector<float>> columns;
    for (const Column& column : candidates[i].columns) {
      columns.push_back(regression::values(column, job, field, points));
    }
    scores[i] = regression::score_of(candidates[i], others.normal(columns, field), power);
    if (scores[i].usable) {
      const Vector& fit = scores[i].fit;
      scores[i].usable =
          !candidates[i].apply({fit.data(), static_cast<std::size_t>(fit.size())}).empty();
    }
  });

  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (scores[i].usable) order.push_back(i);
  }
  if (order.empty()) return {};
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return scores[a].held_out > scores[b].held_out;
  });
  const Score& best = scores[order.front()];
  if (best.held_out <= 0) return {};
  // Of those that do as well as the best the simplest goes first.
  constexpr double kWorthTrying = 0.8;
  std::vector<std::size_t> equals;
  std::vector<std::size_t> others_worth;
  for (const std::size_t i : order) {
    if (scores[i].held_out < kWorthTrying * best.held_out) break;
    (alike(best.gain, scores[i].gain) ? equals : others_worth).push_back(i);
  }
  std::stable_sort(equals.begin(), equals.end(), [&](std::size_t a, std::size_t b) {
    return std::make_pair(candidates[a].columns.size(), !candidates[a].named) <
           std::make_pair(candidates[b].columns.size(), !candidates[b].named);
  });

  std::vector<ScoredCandidate> ranked;
  std::set<decltype(finding(Candidate{}))> seen;
  const auto take = [&](std::size_t i, bool equal) {
    if (!seen.insert(finding(candidates[i])).second) return;
    ScoredCandidate one;
    one.place = i;
    one.coefficients.assign(scores[i].fit.begin(), scores[i].fit.end());
    one.share = scores[i].held_out;
    one.folds_agree = scores[i].folds_agree;
    one.equal = equal;
    ranked.push_back(one);
  };
  for (const std::size_t i : equals) take(i, true);
  for (const std::size_t i : others_worth) take(i, false);
  const double p = regression::p_over_all_columns(
      scores, scores[ranked.front().place].white.rowwise().sum().squaredNorm());
  for (ScoredCandidate& one : ranked) one.p = p;
  return ranked;
}

}  // namespace binderjet
