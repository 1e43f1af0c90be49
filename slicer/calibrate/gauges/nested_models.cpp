// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/gauges/nested_models.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <map>

namespace binderjet {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Rows = std::vector<Eigen::Index>;

MatrixXd joined(const MatrixXd& a, const MatrixXd& b) {
  MatrixXd out(b.rows(), a.cols() + b.cols());
  if (a.cols() > 0) out.leftCols(a.cols()) = a;
  out.rightCols(b.cols()) = b;
  return out;
}

struct Fold {
  Rows inside, outside;
};

std::vector<Fold> folds_of(std::span<const int> groups) {
  std::map<int, Fold> folds;
  for (const int group : groups) folds[group];
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (auto& [group, fold] : folds) {
      (groups[i] == group ? fold.inside : fold.outside).push_back(static_cast<Eigen::Index>(i));
    }
  }
  std::vector<Fold> out;
  for (auto& [group, fold] : folds) out.push_back(std::move(fold));
  return out;
}

// By the normal equations: columns are few, and counts, millimeters or 0 and 1, so they are far
// from the limits of a double; the decomposition gives the least norm where they do not suffice.
VectorXd solve(const MatrixXd& design, const VectorXd& readings) {
  const MatrixXd square = design.transpose() * design;
  return square.completeOrthogonalDecomposition().solve(design.transpose() * readings);
}

// Each fold predicted by the form that fits the other readings best.
VectorXd held_out(const std::vector<MatrixXd>& designs, const VectorXd& readings,
                  std::span<const int> groups) {
  VectorXd errors(readings.size());
  for (const Fold& fold : folds_of(groups)) {
    double least = std::numeric_limits<double>::infinity();
    for (const MatrixXd& design : designs) {
      const VectorXd fit = solve(design(fold.outside, Eigen::all), readings(fold.outside));
      const double squares =
          (readings(fold.outside) - design(fold.outside, Eigen::all) * fit).squaredNorm();
      if (squares >= least) continue;
      least = squares;
      errors(fold.inside) = readings(fold.inside) - design(fold.inside, Eigen::all) * fit;
    }
  }
  return errors;
}

std::size_t best_form(const std::vector<MatrixXd>& designs, const VectorXd& readings) {
  std::vector<double> squares;
  for (const MatrixXd& design : designs) {
    squares.push_back((readings - design * solve(design, readings)).squaredNorm());
  }
  return static_cast<std::size_t>(std::min_element(squares.begin(), squares.end()) -
                                  squares.begin());
}

void judge(Rung& rung, const VectorXd& before, const VectorXd& after, std::span<const int> groups) {
  std::map<int, double> gains;
  for (Eigen::Index i = 0; i < before.size(); ++i) {
    gains[groups[static_cast<std::size_t>(i)]] += before[i] * before[i] - after[i] * after[i];
  }
  const auto count = static_cast<double>(gains.size());
  double mean = 0;
  for (const auto& [group, gain] : gains) mean += gain / count;
  double squares = 0;
  for (const auto& [group, gain] : gains) squares += (gain - mean) * (gain - mean);
  rung.gain = 1 - after.squaredNorm() / before.squaredNorm();
  if (gains.size() < 3 || squares <= 0) return;
  rung.t = mean / std::sqrt(squares / (count - 1) / count);
  const boost::math::students_t student(count - 1);
  rung.p = 2 * boost::math::cdf(boost::math::complement(student, std::abs(rung.t)));
}

// Readings of one group lean together (one part, one caliper, one layer that slipped).
VectorXd grouped_errors(const MatrixXd& design, const VectorXd& residual,
                        std::span<const int> groups) {
  const MatrixXd inverse =
      (design.transpose() * design).completeOrthogonalDecomposition().pseudoInverse();
  MatrixXd middle = MatrixXd::Zero(design.cols(), design.cols());
  for (const Fold& fold : folds_of(groups)) {
    const VectorXd pull =
        design(fold.inside, Eigen::all).transpose() * VectorXd(residual(fold.inside));
    middle += pull * pull.transpose();
  }
  return (inverse * middle * inverse).diagonal().cwiseSqrt();
}

}  // namespace

double rms(const VectorXd& errors) {
  return std::sqrt(errors.squaredNorm() / static_cast<double>(errors.size()));
}

double median_absolute(const VectorXd& errors) {
  std::vector<double> sizes(errors.begin(), errors.end());
  for (double& size : sizes) size = std::abs(size);
  std::sort(sizes.begin(), sizes.end());
  const std::size_t half = sizes.size() / 2;
  return sizes.size() % 2 == 1 ? sizes[half] : (sizes[half - 1] + sizes[half]) / 2;
}

VectorXd leave_group_out(const MatrixXd& design, const VectorXd& readings,
                         std::span<const int> groups) {
  return held_out({design}, readings, groups);
}

Ladder climb(const VectorXd& readings, std::span<const int> groups, std::span<const Term> terms,
             double min_gain) {
  Ladder ladder;
  ladder.rms_without = rms(readings);
  ladder.median_without = median_absolute(readings);
  ladder.heldout = readings;
  ladder.design = MatrixXd(readings.size(), 0);
  for (const Term& term : terms) {
    const MatrixXd kept = term.replaces ? MatrixXd(readings.size(), 0) : ladder.design;
    std::vector<MatrixXd> designs;
    for (const TermForm& form : term.forms) designs.push_back(joined(kept, form.columns));
    const VectorXd errors = held_out(designs, readings, groups);
    const std::size_t best = best_form(designs, readings);
    Rung rung;
    rung.name = term.name;
    rung.form = term.forms[best].name;
    rung.parameters = static_cast<int>(designs[best].colPivHouseholderQr().rank());
    rung.rms = rms(errors);
    rung.median = median_absolute(errors);
    judge(rung, ladder.heldout, errors, groups);
    rung.accepted = rung.t >= 2 && rung.gain >= min_gain;
    if (rung.accepted) {
      if (term.replaces) ladder.columns.clear();
      for (const std::string& name : term.forms[best].names) {
        ladder.columns.push_back({term.name, name});
      }
      ladder.design = designs[best];
      ladder.heldout = errors;
    }
    ladder.rungs.push_back(std::move(rung));
  }
  if (ladder.design.cols() > 0) {
    ladder.coefficients = solve(ladder.design, readings);
    ladder.standard_errors =
        grouped_errors(ladder.design, readings - ladder.design * ladder.coefficients, groups);
  }
  return ladder;
}

}  // namespace binderjet
