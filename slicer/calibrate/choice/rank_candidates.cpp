// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/choice/rank_candidates.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <set>

#include "slicer/calibrate/choice/null_draws.h"
#include "slicer/calibrate/choice/regression.h"

namespace binderjet {
namespace {

using regression::Field;
using regression::Known;
using regression::Tried;
using regression::Vector;

// A step or a window with nearly all points on one side says nothing of its place.
bool covers_all(const Candidate& candidate, const Field& field) {
  const std::string& form = candidate.covariate.form;
  if (candidate.columns.front().basis == Column::Basis::kModel) return false;
  if (form != "step" && form != "window") return false;
  if (candidate.kind == "first_layers" || candidate.kind == "layer_shift_low") return false;
  constexpr double kMost = 0.95;
  const auto inside = std::count_if(field.spots.begin(), field.spots.end(), [&](const Spot& spot) {
    return candidate.columns.front().of(spot) > 0.5;
  });
  return static_cast<double>(inside) > kMost * static_cast<double>(field.spots.size());
}

// What makes two candidates the same finding.
std::string finding(const Candidate& candidate) {
  return candidate.kind + candidate.covariate.axis + candidate.covariate.form;
}

}  // namespace

std::vector<Choice> choose(const MeasuredJob& job, const EffectList& model,
                           const std::vector<SurfacePoint>& points,
                           const std::vector<std::vector<float>>& known,
                           const std::vector<Candidate>& candidates) {
  constexpr std::size_t kFewestPoints = 500;
  if (points.size() < kFewestPoints) return {};
  const Field field = regression::field_of(job, model, points);
  const Known others(known, field);
  double power = 0;
  for (const float r : others.residual()) power += static_cast<double>(r) * r;
  if (power <= 0) return {};

  std::vector<Tried> tried(candidates.size());
  oneapi::tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
    if (covers_all(candidates[i], field)) return;
    job.check();
    std::vector<std::vector<float>> columns;
    for (const Column& column : candidates[i].columns) {
      columns.push_back(regression::values(column, job, field, points));
    }
    tried[i] = regression::attempt(candidates[i], others.normal(columns, field), power);
    if (tried[i].usable) {
      const Vector& fit = tried[i].fit;
      tried[i].usable =
          !candidates[i].apply({fit.data(), static_cast<std::size_t>(fit.size())}).empty();
    }
  });

  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    if (tried[i].usable) order.push_back(i);
  }
  if (order.empty()) return {};
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return tried[a].held_out > tried[b].held_out;
  });
  const Tried& best = tried[order.front()];
  if (best.held_out <= 0) return {};
  // Of those that do as well as the best the simplest goes first.
  constexpr double kWorthTrying = 0.8;
  std::vector<std::size_t> equals;
  std::vector<std::size_t> others_worth;
  for (const std::size_t i : order) {
    if (tried[i].held_out < kWorthTrying * best.held_out) break;
    (alike(best.gain, tried[i].gain) ? equals : others_worth).push_back(i);
  }
  std::stable_sort(equals.begin(), equals.end(), [&](std::size_t a, std::size_t b) {
    return std::make_pair(candidates[a].columns.size(), !candidates[a].named()) <
           std::make_pair(candidates[b].columns.size(), !candidates[b].named());
  });

  std::vector<Choice> choices;
  std::set<std::string> seen;
  const auto take = [&](std::size_t i, bool equal) {
    if (!seen.insert(finding(candidates[i])).second) return;
    Choice choice;
    choice.winner = i;
    choice.coefficients.assign(tried[i].fit.begin(), tried[i].fit.end());
    choice.share = tried[i].held_out;
    choice.folds_agree = tried[i].folds_agree;
    choice.equal = equal;
    choices.push_back(choice);
  };
  for (const std::size_t i : equals) take(i, true);
  for (const std::size_t i : others_worth) take(i, false);
  const double p = regression::family_p(
      tried, tried[choices.front().winner].white.rowwise().sum().squaredNorm());
  for (Choice& choice : choices) choice.p = p;
  return choices;
}

}  // namespace binderjet
