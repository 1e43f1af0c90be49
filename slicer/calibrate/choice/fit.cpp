// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/choice/fit.h"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "slicer/base/work.h"
#include "slicer/calibrate/residual/printed_error.h"
#include "slicer/model/effects/catalogue.h"

namespace binderjet {
namespace {

double step_of(const EffectSpec& effect, const NumberRule& rule, double value) {
  if (rule.fits != nullptr && !rule.fits(effect, value)) return 0;
  return rule.fit_step + rule.fit_share * value;
}

double& number_of(EffectList& model, const FreeNumber& free) {
  return model[free.effect].numbers.at(free.name)[free.index];
}

bool valid(const EffectList& model) {
  return std::all_of(model.begin(), model.end(),
                     [](const EffectSpec& effect) { return check_effect(effect).what.empty(); });
}

// One Gauss-Newton step in units of each number's own step; damped towards no change.
Eigen::VectorXd gauss_newton(const std::vector<std::vector<float>>& columns,
                             const std::vector<SurfacePoint>& points) {
  const auto q = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(q, q);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(q);
  // A point that is off by more than the others together says that something else happened there.
  constexpr double kMaxMissing = 0.25;
  Eigen::VectorXd row(q);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (Eigen::Index c = 0; c < q; ++c) row[c] = columns[static_cast<std::size_t>(c)][i];
    gram += row * row.transpose();
    right += row * std::clamp(points[i].missing, -kMaxMissing, kMaxMissing);
  }
  gram.diagonal().array() *= 1 + 1e-4;
  gram.diagonal().array() += 1e-9;
  return gram.ldlt().solve(right);
}

}  // namespace

std::vector<FreeNumber> free_numbers(const EffectList& model, std::size_t effect) {
  std::vector<FreeNumber> out;
  const EffectSpec& spec = model[effect];
  for (const auto& [name, values] : spec.numbers) {
    const NumberRule& rule = find_effect_kind(spec.kind)->rule(name);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double step = step_of(spec, rule, values[i]);
      if (step > 0) out.push_back({effect, name, i, step});
    }
  }
  return out;
}

std::vector<std::vector<float>> slopes(const MeasuredJob& job, const EffectList& model,
                                       const std::vector<SurfacePoint>& points,
                                       const std::vector<FreeNumber>& numbers) {
  const std::vector<double> margin = margins_at(job, model, points);
  std::vector<std::vector<float>> out(numbers.size());
  oneapi::tbb::parallel_for(std::size_t{0}, numbers.size(), [&](std::size_t n) {
    EffectList nudged = model;
    double step = numbers[n].step;
    number_of(nudged, numbers[n]) += step;
    if (!valid(nudged)) {
      step = -step;
      number_of(nudged, numbers[n]) += 2 * step;
    }
    const std::vector<double> moved = margins_at(job, nudged, points);
    for (std::size_t i = 0; i < moved.size(); ++i) {
      out[n].push_back(static_cast<float>((moved[i] - margin[i]) * numbers[n].step / step));
    }
  });
  return out;
}

std::vector<std::vector<float>> scanner_columns(const MeasuredJob& job, const EffectList& model,
                                                const std::vector<SurfacePoint>& points) {
  if (!job.scanned) return {};
  // About as far as a scanner blurs: the differences at both sides are shift and, added, blur.
  constexpr double kStepMm = 0.06;
  std::array<std::vector<double>, 2> ahead;
  std::array<std::vector<double>, 2> behind;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::array<double, 2> step{};
    step[axis] = kStepMm / job.grid.voxel_mm(static_cast<int>(axis));
    ahead[axis] = margins_at(job, model, points, step);
    behind[axis] = margins_at(job, model, points, {-step[0], -step[1]});
  }
  const std::vector<double> margin = margins_at(job, model, points);
  std::vector<std::vector<float>> out(4);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double by_x = (behind[0][i] - ahead[0][i]) / (2 * kStepMm);
    const double by_y = (behind[1][i] - ahead[1][i]) / (2 * kStepMm);
    const DosePlace place = points[i].place();
    const Spot spot = spot_at(job.grid, job.place, place.x_vx, place.y_vx, 0);
    const double turn =
        by_y * (spot.x_mm - job.place.center_mm(0)) - by_x * (spot.y_mm - job.place.center_mm(1));
    const double blur = ahead[0][i] + behind[0][i] + ahead[1][i] + behind[1][i] - 4 * margin[i];
    out[0].push_back(static_cast<float>(by_x));
    out[1].push_back(static_cast<float>(by_y));
    out[2].push_back(static_cast<float>(turn));
    out[3].push_back(static_cast<float>(blur));
  }
  return out;
}

EffectList refit(const MeasuredJob& job, EffectList model, const std::vector<FreeNumber>& numbers,
                 const LayerChoice& layers, int rounds) {
  double wrong = wrong_share(job, model, layers);
  constexpr double kEnough = 0.003;  // a smaller relative gain ends the fit
  Stage stage(job.work, "fitting", rounds, "rounds");
  for (int round = 0; round < rounds; ++round) {
    stage.reach(round);
    const auto points = surface_points(job, model, layers, kFitPoints, kPairReachMm);
    if (points.size() < 10 * numbers.size() + 100) break;
    auto columns = slopes(job, model, points, numbers);
    // The scanner's share is fitted along and forgotten.
    for (auto& column : scanner_columns(job, model, points)) columns.push_back(std::move(column));
    const Eigen::VectorXd move = gauss_newton(columns, points);
    const double before = wrong;
    for (const double damping : {1.0, 0.5, 0.2}) {
      EffectList next = model;
      for (std::size_t n = 0; n < numbers.size(); ++n) {
        constexpr double kMaxSteps = 60;
        number_of(next, numbers[n]) +=
            numbers[n].step *
            std::clamp(damping * move[static_cast<Eigen::Index>(n)], -kMaxSteps, kMaxSteps);
      }
      if (!valid(next)) continue;
      const double after = wrong_share(job, next, layers);
      if (after < wrong) {
        model = std::move(next);
        wrong = after;
        break;
      }
    }
    if (wrong > before * (1 - kEnough)) break;
  }
  return model;
}

}  // namespace binderjet
