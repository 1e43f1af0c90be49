// SPDX-License-Identifier: GPL-3.0-or-later
// Least squares of the residual r on a candidate's columns X, kept as normal equations of each
// cell k, the sums running over the points in k:
//
//   A_k = sum of x x'      b_k = sum of x r
//
// A fit on any set of cells solves (sum of A_k) c = sum of b_k, and what c takes of cell k is
// 2 c.b_k - c.A_k c. So folds and null draws are sums over 125 small systems, and no column is
// evaluated twice, however many folds and draws there are.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "slicer/calibrate/residual/printed_error.h"
#include "slicer/calibrate/residual/surface.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet::regression {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// What is needed of each point, computed once.
struct Field {
  std::vector<Spot> spots;
  std::vector<float> residual;
  std::vector<float> dose;
  std::vector<double> margin;               // dose - level
  std::array<std::vector<float>, 2> shift;  // dose per mm
  std::vector<int> cell;                    // printed_error.h
};
Field field_of(const MeasuredJob& job, const EffectList& model,
               const std::vector<SurfacePoint>& points);

// A candidate's column at each point.
std::vector<float> values(const Column& column, const MeasuredJob& job, const Field& field,
                          const std::vector<SurfacePoint>& points);

// A candidate's normal equations, cell by cell, with what is known taken out.
struct Normal {
  std::vector<Matrix> gram;   // per cell
  std::vector<Vector> right;  // per cell
};

// Columns of the effects that are in the model already and their own normal equations. `columns`
// must outlive it.
class FittedAlready {
 public:
  FittedAlready(const std::vector<std::vector<float>>& columns, const Field& field);

  // The residual less what the known columns take of it.
  const std::vector<float>& residual() const { return residual_; }
  Normal normal(const std::vector<std::vector<float>>& columns, const Field& field) const;

 private:
  Vector at(std::size_t i) const;
  static std::size_t cell(const Field& field, std::size_t i) {
    return static_cast<std::size_t>(field.cell[i]);
  }

  const std::vector<std::vector<float>>& columns_;
  Eigen::Index count_;
  std::vector<float> residual_;
  std::vector<Matrix> gram_;
  std::vector<Vector> right_;
  Eigen::LDLT<Matrix> solver_;
};

// The score of a candidate: fitted on all cells, and what it takes of each where the fit did not
// look.
struct Score {
  bool usable = false;  // its columns are neither empty nor dependent, and apply() takes the fit
  Vector fit;
  std::vector<double> gain;  // per cell, mean over the axes of the folds
  double held_out = 0;       // sum of gain, as a share of the residual's power
  bool folds_agree = false;
  // Per cell a column w_k = L^-1 b_k (L L' = sum of all A_k, columns scaled to unit length): with
  // signs s_k the candidate gains |sum of s_k w_k|^2 on all cells, so a null draw costs as many
  // products as there are columns times cells.
  Matrix white;
};

// `power` is that of the residual.
Score score_of(const Candidate& candidate, const Normal& normal, double power);

// How often a residual with the signs of its cells drawn at random looks as good to any candidate.
double p_over_all_columns(const std::vector<Score>& scores, double best_gain);

}  // namespace binderjet::regression
