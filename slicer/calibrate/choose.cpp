// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/choose.h"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace binderjet {
namespace {

constexpr int kFolds = 5;
constexpr int kCells = kFolds * kFolds * kFolds;
constexpr int kNullDraws = 499;

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// What choosing needs of each point, computed once.
struct Field {
  std::vector<Spot> spots;
  std::vector<float> residual;
  std::vector<float> dose;
  std::array<std::vector<float>, 2> shift;  // dose per mm
  std::vector<int> cell;                    // kFolds slabs along x, y and z
};

Field field_of(const MeasuredJob& job, const Model& model,
               const std::vector<SurfacePoint>& points) {
  Field field;
  const std::vector<double> margin = margins_at(job, model, points);
  double level = 0;
  for (const EffectSpec& effect : model) {
    if (effect.numbers.contains("level")) level = effect.number("level");
  }
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
    field.dose.push_back(static_cast<float>(margin[i] + level));
    const auto slab = [](double at, double size) {
      return std::clamp(static_cast<int>(kFolds * at / size), 0, kFolds - 1);
    };
    const int ix = slab(spot.x_mm - job.place.origin_mm[0], job.place.size_mm[0]);
    const int iy = slab(spot.y_mm - job.place.origin_mm[1], job.place.size_mm[1]);
    const int iz = slab(point.layer + 0.5, job.layers());
    field.cell.push_back((iz * kFolds + iy) * kFolds + ix);
  }
  return field;
}

std::vector<float> values(const Column& column, const MeasuredJob& job, const Field& field,
                          const std::vector<SurfacePoint>& points,
                          const std::vector<double>& margin) {
  const std::size_t count = points.size();
  std::vector<float> out(count, 1);
  if (column.basis == Column::Basis::kModel) {
    const std::vector<double> nudged = margins_at(job, column.nudged, points);
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = static_cast<float>((nudged[i] - margin[i]) / column.step);
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

// A candidate's normal equations, cell by cell, with what is known taken out.
struct Normal {
  std::vector<Matrix> gram;   // per cell
  std::vector<Vector> right;  // per cell
};

// Columns of the known effects and their own normal equations.
class Known {
 public:
  Known(const std::vector<std::vector<float>>& columns, const Field& field)
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

  const std::vector<float>& residual() const { return residual_; }

  Normal normal(const std::vector<std::vector<float>>& columns, const Field& field) const {
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

 private:
  Vector at(std::size_t i) const {
    Vector row(count_);
    for (Eigen::Index c = 0; c < count_; ++c) row[c] = columns_[static_cast<std::size_t>(c)][i];
    return row;
  }
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

int slab_of(int cell, int axis) {
  return axis == 0 ? cell % kFolds : axis == 1 ? cell / kFolds % kFolds : cell / kFolds / kFolds;
}

Vector solve(const Matrix& gram, const Vector& right) {
  // A trace of the diagonal keeps columns apart that this part cannot tell apart.
  Matrix steady = gram;
  steady.diagonal() *= 1 + 1e-6;
  return steady.ldlt().solve(right);
}

// What a candidate takes of each cell when fitted on the other slabs along one axis.
struct HeldOut {
  std::vector<double> gain = std::vector<double>(kCells, 0);
  int good_folds = 0;
};

HeldOut held_out(const Normal& normal, const Matrix& gram, const Vector& right, int axis) {
  HeldOut out;
  for (int fold = 0; fold < kFolds; ++fold) {
    Matrix rest_gram = gram;
    Vector rest_right = right;
    for (int k = 0; k < kCells; ++k) {
      if (slab_of(k, axis) != fold) continue;
      rest_gram -= normal.gram[static_cast<std::size_t>(k)];
      rest_right -= normal.right[static_cast<std::size_t>(k)];
    }
    const Vector fit = solve(rest_gram, rest_right);
    if (!fit.allFinite()) continue;
    double sum = 0;
    for (int k = 0; k < kCells; ++k) {
      if (slab_of(k, axis) != fold) continue;
      const auto cell = static_cast<std::size_t>(k);
      const double gain = 2 * fit.dot(normal.right[cell]) - fit.dot(normal.gram[cell] * fit);
      out.gain[cell] = gain;
      sum += gain;
    }
    if (sum > 0) ++out.good_folds;
  }
  return out;
}

struct Tried {
  bool usable = false;
  Vector fit;
  std::vector<double> gain;  // per cell, mean over the axes of the folds
  double held_out = 0;       // sum of gain, as a share of the residual's power
  bool folds_agree = false;
  Matrix white;  // per cell, the right sides as they count in the gain: gain = |sum of columns|^2
};

Tried attempt(const Candidate& candidate, const Normal& normal, double power) {
  Tried out;
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
    out.folds_agree = out.folds_agree && folds.good_folds >= kFolds - 1;
    ++axes;
  }
  for (double& gain : out.gain) out.held_out += (gain /= axes) / power;
  return out;
}

// How often a residual with the signs of its cells drawn at random looks as good to any candidate.
double family_p(const std::vector<Tried>& tried, double best_gain) {
  std::mt19937 engine(1);
  std::vector<Vector> signs(kNullDraws, Vector(kCells));
  for (Vector& draw : signs) {
    for (int k = 0; k < kCells; ++k) draw[k] = (engine() & 1U) != 0 ? 1 : -1;
  }
  std::vector<char> beaten(kNullDraws, 0);
  oneapi::tbb::parallel_for(0, kNullDraws, [&](int draw) {
    const auto d = static_cast<std::size_t>(draw);
    for (const Tried& one : tried) {
      if (one.usable && (one.white * signs[d]).squaredNorm() >= best_gain) {
        beaten[d] = 1;
        return;
      }
    }
  });
  const auto count = std::count(beaten.begin(), beaten.end(), 1);
  return (1.0 + static_cast<double>(count)) / (1 + kNullDraws);
}

// The paired difference of two candidates' gains, cell by cell, and its standard error.
bool alike(const Tried& best, const Tried& other) {
  double sum = 0;
  double squares = 0;
  for (std::size_t k = 0; k < kCells; ++k) {
    const double d = best.gain[k] - other.gain[k];
    sum += d;
    squares += d * d;
  }
  const double error = std::sqrt(std::max(0.0, squares - sum * sum / kCells));
  constexpr double kAlike = 0.01;  // of the gain: less is no difference to a person
  const double total = std::accumulate(best.gain.begin(), best.gain.end(), 0.0);
  return sum <= std::max(error, kAlike * total);
}

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

std::vector<Choice> choose(const MeasuredJob& job, const Model& model,
                           const std::vector<SurfacePoint>& points,
                           const std::vector<std::vector<float>>& known,
                           const std::vector<Candidate>& candidates) {
  constexpr std::size_t kFewestPoints = 500;
  if (points.size() < kFewestPoints) return {};
  const Field field = field_of(job, model, points);
  const std::vector<double> margin = margins_at(job, model, points);
  const Known others(known, field);
  double power = 0;
  for (const float r : others.residual()) power += static_cast<double>(r) * r;
  if (power <= 0) return {};

  std::vector<Tried> tried(candidates.size());
  oneapi::tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
    if (covers_all(candidates[i], field)) return;
    std::vector<std::vector<float>> columns;
    for (const Column& column : candidates[i].columns) {
      columns.push_back(values(column, job, field, points, margin));
    }
    tried[i] = attempt(candidates[i], others.normal(columns, field), power);
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
  // Of those that do as well as the best the simplest goes first.
  constexpr double kWorthTrying = 0.8;
  std::vector<std::size_t> equals;
  std::vector<std::size_t> others_worth;
  for (const std::size_t i : order) {
    if (tried[i].held_out < kWorthTrying * best.held_out) break;
    (alike(best, tried[i]) ? equals : others_worth).push_back(i);
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
  const double p =
      family_p(tried, tried[choices.front().winner].white.rowwise().sum().squaredNorm());
  for (Choice& choice : choices) choice.p = p;
  return choices;
}

}  // namespace binderjet
