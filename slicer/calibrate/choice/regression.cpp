// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/choice/regression.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "slicer/calibrate/choice/null_draws.h"
#include "slicer/model/effects/level.h"

namespace binderjet::regression {

Field field_of(const MeasuredJob& job, const EffectList& model,
               const std::vector<SurfacePoint>& points) {
  Field field;
  field.margin = margins_at(job, model, points);
  const double level = level_of(model);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::array<double, 2> step{};
    step[axis] = 0.5;
    const auto behind = margins_at(job, model, points, {-step[0], -step[1]});
    const auto ahead = margins_at(job, model, points, step);
    const double voxel_mm = job.grid.voxel_mm(static_cast<int>(axis));
    for (std::size_t i = 0; i < points.size(); ++i) {
      field.shift[axis].push_back(static_cast<float>((behind[i] - ahead[i]) / voxel_mm));
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint& point = points[i];
    const DosePlace place = point.place();
    const Spot spot =
        spot_at(job.grid, job.place, place.x_vx, place.y_vx, job.first_layer + point.layer);
    field.spots.push_back(spot);
    field.residual.push_back(static_cast<float>(point.missing));
    field.dose.push_back(static_cast<float>(field.margin[i] + level));
    const RunLayer& mask = *job.masks.front();
    field.cell.push_back(cell_of(slab_of(point.x, mask.width() * job.grid.detail_vx[0]),
                                 slab_of(point.y, mask.height() * job.grid.detail_vx[1]),
                                 slab_of(point.layer, job.layers())));
  }
  return field;
}

std::vector<float> values(const Column& column, const MeasuredJob& job, const Field& field,
                          const std::vector<SurfacePoint>& points) {
  const std::size_t count = points.size();
  std::vector<float> out(count, 1);
  if (column.basis == Column::Basis::kModel) {
    const std::vector<double> nudged = margins_at(job, column.nudged, points);
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = static_cast<float>((nudged[i] - field.margin[i]) / column.step);
    }
  } else if (column.basis != Column::Basis::kLevel) {
    out = column.basis == Column::Basis::kDose     ? field.dose
          : column.basis == Column::Basis::kShiftX ? field.shift[0]
                                                   : field.shift[1];
  }
  if (column.of) {
    for (std::size_t i = 0; i < count; ++i) {
      out[i] *= static_cast<float>(column.of(field.spots[i]));
    }
  }
  return out;
}

FittedAlready::FittedAlready(const std::vector<std::vector<float>>& columns, const Field& field)
    : columns_(columns), count_(static_cast<Eigen::Index>(columns.size())) {
  gram_.assign(kCells, Matrix::Zero(count_, count_));
  right_.assign(kCells, Vector::Zero(count_));
  residual_ = field.residual;
  if (count_ == 0) return;
  Matrix all = Matrix::Zero(count_, count_);
  Vector sum = Vector::Zero(count_);
  for (std::size_t i = 0; i < residual_.size(); ++i) {
    const Vector row = at(i);
    gram_[cell(field, i)] += row * row.transpose();
    sum += row * residual_[i];
  }
  for (const Matrix& gram : gram_) all += gram;
  solver_.compute(all);
  const Vector fit = solver_.solve(sum);
  for (std::size_t i = 0; i < residual_.size(); ++i) {
    const Vector row = at(i);
    residual_[i] -= static_cast<float>(row.dot(fit));
    right_[cell(field, i)] += row * residual_[i];
  }
}

Vector FittedAlready::at(std::size_t i) const {
  Vector row(count_);
  for (Eigen::Index c = 0; c < count_; ++c) row[c] = columns_[static_cast<std::size_t>(c)][i];
  return row;
}

Normal FittedAlready::normal(const std::vector<std::vector<float>>& columns,
                             const Field& field) const {
  const auto q = static_cast<Eigen::Index>(columns.size());
  Normal out;
  out.gram.assign(kCells, Matrix::Zero(q, q));
  out.right.assign(kCells, Vector::Zero(q));
  std::vector<Matrix> cross(kCells, Matrix::Zero(count_, q));
  Vector row(q);
  for (std::size_t i = 0; i < residual_.size(); ++i) {
    bool any = false;
    for (Eigen::Index c = 0; c < q; ++c) {
      row[c] = columns[static_cast<std::size_t>(c)][i];
      any = any || row[c] != 0;
    }
    if (!any) continue;
    const std::size_t k = cell(field, i);
    for (Eigen::Index a = 0; a < q; ++a) {
      out.right[k][a] += row[a] * residual_[i];
      for (Eigen::Index b = 0; b <= a; ++b) out.gram[k](a, b) += row[a] * row[b];
      for (Eigen::Index b = 0; b < count_; ++b) {
        cross[k](b, a) += row[a] * columns_[static_cast<std::size_t>(b)][i];
      }
    }
  }
  Matrix all = Matrix::Zero(count_, q);
  for (int k = 0; k < kCells; ++k) {
    Matrix& gram = out.gram[static_cast<std::size_t>(k)];
    gram = Matrix(gram.selfadjointView<Eigen::Lower>());
    all += cross[static_cast<std::size_t>(k)];
  }
  if (count_ == 0) return out;
  const Matrix alpha = solver_.solve(all);
  for (std::size_t k = 0; k < kCells; ++k) {
    out.gram[k] += alpha.transpose() * gram_[k] * alpha - cross[k].transpose() * alpha -
                   alpha.transpose() * cross[k];
    out.right[k] -= alpha.transpose() * right_[k];
  }
  return out;
}

namespace {

Vector solve(const Matrix& gram, const Vector& right) {
  // A trace of the diagonal keeps columns apart that this part cannot tell apart.
  Matrix steady = gram;
  steady.diagonal() *= 1 + 1e-6;
  return steady.ldlt().solve(right);
}

// What a candidate takes of each cell when fitted on the other slabs along one axis.
struct HeldOut {
  std::vector<double> gain = std::vector<double>(kCells, 0);
  std::array<double, kSlabs> folds{};
};

HeldOut held_out(const Normal& normal, const Matrix& gram, const Vector& right, int axis) {
  HeldOut out;
  for (int fold = 0; fold < kSlabs; ++fold) {
    Matrix rest_gram = gram;
    Vector rest_right = right;
    for (int k = 0; k < kCells; ++k) {
      if (slab_of_cell(k, axis) != fold) continue;
      rest_gram -= normal.gram[static_cast<std::size_t>(k)];
      rest_right -= normal.right[static_cast<std::size_t>(k)];
    }
    const Vector fit = solve(rest_gram, rest_right);
    if (!fit.allFinite()) continue;
    double sum = 0;
    for (int k = 0; k < kCells; ++k) {
      if (slab_of_cell(k, axis) != fold) continue;
      const auto cell = static_cast<std::size_t>(k);
      const double gain = 2 * fit.dot(normal.right[cell]) - fit.dot(normal.gram[cell] * fit);
      out.gain[cell] = gain;
      sum += gain;
    }
    out.folds[static_cast<std::size_t>(fold)] = sum;
  }
  return out;
}

}  // namespace

Score score_of(const Candidate& candidate, const Normal& normal, double power) {
  Score out;
  const Eigen::Index q = normal.right.front().size();
  Matrix gram = Matrix::Zero(q, q);
  Vector right = Vector::Zero(q);
  for (std::size_t k = 0; k < kCells; ++k) {
    gram += normal.gram[k];
    right += normal.right[k];
  }
  constexpr double kTooLittle = 1e-9;
  if (gram.diagonal().minCoeff() <= kTooLittle) return out;
  const Vector scale = gram.diagonal().cwiseSqrt().cwiseInverse();
  Matrix unit = scale.asDiagonal() * gram * scale.asDiagonal();
  unit.diagonal().array() += 1e-6;
  const Eigen::LLT<Matrix> factor(unit);
  if (factor.info() != Eigen::Success) return out;
  out.fit = solve(gram, right);
  if (!out.fit.allFinite()) return out;
  out.usable = true;
  out.white.resize(q, kCells);
  for (int k = 0; k < kCells; ++k) {
    const Vector scaled = scale.cwiseProduct(normal.right[static_cast<std::size_t>(k)]);
    out.white.col(k) = factor.matrixL().solve(scaled);
  }
  out.gain.assign(kCells, 0);
  out.folds_agree = true;
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if ((candidate.along & (1U << axis)) != 0) continue;
    const HeldOut folds = held_out(normal, gram, right, axis);
    for (std::size_t k = 0; k < kCells; ++k) out.gain[k] += folds.gain[k];
    out.folds_agree = out.folds_agree && most_agree(folds.folds);
    ++axes;
  }
  for (double& gain : out.gain) out.held_out += (gain /= axes) / power;
  return out;
}

// How often a residual with the signs of its cells drawn at random looks as good to any candidate.
double p_over_all_columns(const std::vector<Score>& scores, double best_gain) {
  std::vector<Vector> signs;
  for (const std::vector<int>& draw : sign_draws(kCells)) {
    signs.push_back(Eigen::Map<const Eigen::VectorXi>(draw.data(), kCells).cast<double>());
  }
  std::vector<char> beaten(kNullDraws, 0);
  oneapi::tbb::parallel_for(0, kNullDraws, [&](int draw) {
    const auto d = static_cast<std::size_t>(draw);
    for (const Score& one : scores) {
      if (one.usable && (one.white * signs[d]).squaredNorm() >= best_gain) {
        beaten[d] = 1;
        return;
      }
    }
  });
  const auto count = std::count(beaten.begin(), beaten.end(), 1);
  return (1.0 + static_cast<double>(count)) / (1 + kNullDraws);
}

}  // namespace binderjet::regression
