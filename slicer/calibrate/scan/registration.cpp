// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/scan/registration.h"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "slicer/base/error.h"

namespace binderjet {
namespace {

constexpr double kRadian = std::numbers::pi / 180;
constexpr int kMaxLayers = 24;  // enough edges, and the time does not grow with the part's height

// One round of Gauss-Newton: images blurred to `sigma_mm`, and how large a difference still counts.
struct Round {
  double sigma_mm;
  double cutoff;
};
constexpr Round kRounds[] = {{0.8, 2.0}, {0.3, 1.0}, {0.1, 0.5}};

// A point on a predicted edge.
struct EdgePoint {
  double x, y, value, slope_x, slope_y;
};

// What one round compares: per layer the predicted edge points and the scan's image.
struct Pair {
  int layer;
  std::vector<EdgePoint> points;
  GrayPlane scan;
};

// Shift x, shift y, turn (radians), scale x, scale y; and how far faces across x and across y grew,
// which is nothing of the pose but would be taken for it on a part that is not symmetric.
using Parameters = Eigen::Matrix<double, 7, 1>;

Parameters slopes(const EdgePoint& p, std::array<double, 2> center) {
  const double x = p.x - center[0];
  const double y = p.y - center[1];
  const double steep = std::hypot(p.slope_x, p.slope_y);
  Parameters slope;
  slope << p.slope_x, p.slope_y, p.slope_y * x - p.slope_x * y, p.slope_x * x, p.slope_y * y,
      p.slope_x * p.slope_x / steep, p.slope_y * p.slope_y / steep;
  return slope;
}

std::array<int, 2> cell_factor(std::array<double, 2> pitch_mm, double sigma_mm) {
  std::array<int, 2> factor{};
  for (std::size_t a = 0; a < 2; ++a) {
    factor[a] = std::max(1, static_cast<int>(sigma_mm / 1.5 / pitch_mm[a]));
  }
  return factor;
}

std::array<double, 2> xy(const std::array<double, 3>& v) { return {v[0], v[1]}; }

std::vector<EdgePoint> edge_points(const GrayPlane& plane, double sigma_mm) {
  // A straight edge of the blurred image is this steep in its middle.
  const double steepest = 1 / (sigma_mm * std::sqrt(2 * std::numbers::pi));
  std::vector<EdgePoint> points;
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      const double slope_x = (plane.at(x + 1, y) - plane.at(x - 1, y)) / (2 * plane.pitch_mm[0]);
      const double slope_y = (plane.at(x, y + 1) - plane.at(x, y - 1)) / (2 * plane.pitch_mm[1]);
      if (std::hypot(slope_x, slope_y) < 0.1 * steepest) continue;
      points.push_back(
          {plane.center_mm(0, x), plane.center_mm(1, y), plane.at(x, y), slope_x, slope_y});
    }
  }
  return points;
}

GrayPlane blurred_scan(const GrayPlane& slice, double sigma_mm) {
  return blurred(coarsened(slice, cell_factor(slice.pitch_mm, sigma_mm)), sigma_mm);
}

struct Problem {
  const Scan& scan;
  std::span<const RunLayer> predicted;
  const StackInfo& frame;
  std::array<double, 2> center;

  double layer_low_mm(int layer) const { return frame.origin_mm[2] + layer * frame.pitch_mm[2]; }
  std::vector<int> layers() const {
    std::vector<int> solid;
    for (int k = 0; k < static_cast<int>(predicted.size()); ++k) {
      if (!predicted[static_cast<std::size_t>(k)].empty()) solid.push_back(k);
    }
    if (solid.size() <= kMaxLayers) return solid;
    std::vector<int> some;
    for (std::size_t i = 0; i < kMaxLayers; ++i) {
      some.push_back(solid[i * (solid.size() - 1) / (kMaxLayers - 1)]);
    }
    return some;
  }
  std::vector<Pair> predicted_edges(double sigma_mm) const {
    std::vector<Pair> pairs;
    for (const int layer : layers()) pairs.push_back({layer, {}, {}});
    oneapi::tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t i) {
      const auto pitch = xy(frame.pitch_mm);
      const GrayPlane cells = coverage(predicted[static_cast<std::size_t>(pairs[i].layer)], pitch,
                                       xy(frame.origin_mm), cell_factor(pitch, sigma_mm));
      pairs[i].points = edge_points(blurred(cells, sigma_mm), sigma_mm);
    });
    return pairs;
  }
  std::vector<Pair> pairs(double shift_z, double sigma_mm) const {
    std::vector<Pair> all = predicted_edges(sigma_mm);
    oneapi::tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
      const double low = layer_low_mm(all[i].layer) + shift_z;
      all[i].scan = blurred_scan(scan.mean(low, low + frame.pitch_mm[2]), sigma_mm);
    });
    return all;
  }
};

struct Fit {
  Parameters at;
  double misfit;
};

// Tukey's weight: 1 for no difference, 0 from the cutoff on.
double weight(double difference, double cutoff) {
  const double t = difference / cutoff;
  return std::abs(t) >= 1 ? 0 : (1 - t * t) * (1 - t * t);
}

// Scan - prediction where the point comes to lie.
double difference(const EdgePoint& p, const GrayPlane& scan, const Parameters& at,
                  std::array<double, 2> center) {
  const double x = (1 + at[3]) * (p.x - center[0]);
  const double y = (1 + at[4]) * (p.y - center[1]);
  const double c = std::cos(at[2]);
  const double s = std::sin(at[2]);
  return scan.sample(center[0] + at[0] + c * x - s * y, center[1] + at[1] + s * x + c * y) -
         p.value;
}

double mean_square(const std::vector<Pair>& pairs, const Parameters& at,
                   std::array<double, 2> center) {
  double squares = 0;
  double count = 0;
  for (const Pair& pair : pairs) {
    for (const EdgePoint& p : pair.points) {
      const double d = difference(p, pair.scan, at, center);
      squares += d * d;
      ++count;
    }
  }
  return squares / std::max(1.0, count);
}

// Where the scan is off by a small motion e in the job's frame, scan - prediction is the slope of
// the prediction along e; so one linear system in e per step. Growth is solved anew in each.
Fit gauss_newton(const std::vector<Pair>& pairs, Parameters at, std::array<double, 2> center,
                 double cutoff) {
  constexpr int kMaxSteps = 30;
  constexpr double kStill = 1e-5;  // mm at 1 mm, radians, shares
  using Square = Eigen::Matrix<double, 7, 7>;
  for (int step = 0; step < kMaxSteps; ++step) {
    std::vector<Square> lefts(pairs.size(), Square::Zero());
    std::vector<Parameters> rights(pairs.size(), Parameters::Zero());
    oneapi::tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t i) {
      for (const EdgePoint& p : pairs[i].points) {
        const Parameters slope = slopes(p, center);
        const double d = difference(p, pairs[i].scan, at, center);
        const double w = weight(d - at.tail<2>().dot(slope.tail<2>()), cutoff);
        if (w == 0) continue;
        lefts[i] += w * slope * slope.transpose();
        rights[i] += w * d * slope;
      }
    });
    Square left = Square::Zero();
    Parameters right = Parameters::Zero();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      left += lefts[i];
      right += rights[i];
    }
    // Where edges do not tell a scale from growth (a plain block has two faces across an axis),
    // both are held near none; and what no edge tells stays.
    for (Eigen::Index i = 3; i < 7; ++i) {
      constexpr double kHold = 1e-3;  // of what the edges say
      right[i] += kHold * left(i, i) * (i < 5 ? at[i] : 0);
      left(i, i) *= 1 + kHold;
    }
    left.diagonal().array() += 1e-9 * left.trace();
    const Parameters e = left.ldlt().solve(right);
    const double c = std::cos(at[2]);
    const double s = std::sin(at[2]);
    at[0] -= c * e[0] - s * e[1];
    at[1] -= s * e[0] + c * e[1];
    at.segment<3>(2) -= e.segment<3>(2);
    at.tail<2>() = e.tail<2>();
    if (e.head<5>().cwiseAbs().maxCoeff() < kStill) break;
  }
  return {at, std::sqrt(mean_square(pairs, at, center))};
}

// Volume (in layers and samples) and its center, for a start.
struct Centroid {
  double volume = 0;
  std::array<double, 3> sum{};
  void add(const GrayPlane& plane, double z_mm, double share) {
    for (int y = 0; y < plane.height; ++y) {
      for (int x = 0; x < plane.width; ++x) {
        // Noise of the powder around must not pull.
        const double solid = plane.at(x, y) >= 0.5F ? share : 0;
        volume += solid;
        sum[0] += solid * plane.center_mm(0, x);
        sum[1] += solid * plane.center_mm(1, y);
        sum[2] += solid * z_mm;
      }
    }
  }
  double at(std::size_t axis) const { return sum[axis] / volume; }
};

std::array<double, 3> centroid_shift(const Problem& problem, const std::string& where) {
  constexpr double kCoarseMm = 0.3;
  Centroid wanted;
  const auto pitch = xy(problem.frame.pitch_mm);
  for (int k = 0; k < static_cast<int>(problem.predicted.size()); ++k) {
    wanted.add(coverage(problem.predicted[static_cast<std::size_t>(k)], pitch,
                        xy(problem.frame.origin_mm), cell_factor(pitch, kCoarseMm)),
               problem.layer_low_mm(k) + 0.5 * problem.frame.pitch_mm[2], 1);
  }
  Centroid found;
  const StackInfo& info = problem.scan.info;
  for (int k = 0; k < info.size[2]; ++k) {
    const GrayPlane slice = problem.scan.slice(k);
    found.add(coarsened(slice, cell_factor(slice.pitch_mm, kCoarseMm)),
              info.origin_mm[2] + (k + 0.5) * info.pitch_mm[2], 1);
  }
  if (wanted.volume <= 0 || found.volume <= 0) {
    throw Error(ErrorKind::kBadInput, where,
                wanted.volume <= 0 ? "cannot be compared: the predicted print is empty"
                                   : "holds nothing solid; is its threshold right?");
  }
  return {found.at(0) - wanted.at(0), found.at(1) - wanted.at(1), found.at(2) - wanted.at(2)};
}

// The least misfit by ever smaller steps on both sides.
double find_shift_z(const Problem& problem, const Parameters& at, double start) {
  constexpr double kSigmaMm = 0.3;
  std::vector<GrayPlane> slices(static_cast<std::size_t>(problem.scan.info.size[2]));
  oneapi::tbb::parallel_for(0, problem.scan.info.size[2], [&](int k) {
    slices[static_cast<std::size_t>(k)] = blurred_scan(problem.scan.slice(k), kSigmaMm);
  });
  const Scan coarse{problem.scan.info, [&](int k) { return slices[static_cast<std::size_t>(k)]; }};
  std::vector<Pair> pairs = problem.predicted_edges(kSigmaMm);
  const double pitch = problem.frame.pitch_mm[2];
  const auto misfit = [&](double shift_z) {
    for (Pair& pair : pairs) {
      const double low = problem.layer_low_mm(pair.layer) + shift_z;
      pair.scan = coarse.mean(low, low + pitch);
    }
    return mean_square(pairs, at, problem.center);
  };
  double best = start;
  double least = misfit(best);
  for (double step = 2 * pitch; step > 0.05 * pitch; step /= 2) {
    for (bool moved = true; moved;) {
      moved = false;
      for (const double z : {best - step, best + step}) {
        const double here = misfit(z);
        if (here >= least) continue;
        least = here;
        best = z;
        moved = true;
      }
    }
  }
  return best;
}

}  // namespace

Registration register_scan(const Scan& scan, std::span<const RunLayer> predicted,
                           const StackInfo& frame, const std::string& where, const Work& work) {
  Stage stage(work, "aligning scan", std::ssize(kRounds), "rounds");
  Problem problem{scan, predicted, frame, {}};
  for (std::size_t a = 0; a < 2; ++a) {
    problem.center[a] = frame.origin_mm[a] + 0.5 * frame.size[a] * frame.pitch_mm[a];
  }
  const std::array<double, 3> start = centroid_shift(problem, where);
  const bool same_layers = scan.has_layers_of(frame);
  double shift_z = same_layers ? 0 : start[2];
  Fit best{Parameters::Zero(), 0};
  for (const Round& round : kRounds) {
    const bool first = &round == std::begin(kRounds);
    const std::vector<Pair> pairs = problem.pairs(shift_z, round.sigma_mm);
    if (first) {
      best.misfit = 2;
      for (const double turn : {0.0, -4.0, 4.0, -8.0, 8.0}) {
        Parameters at = Parameters::Zero();
        at.head<3>() << start[0], start[1], turn * kRadian;
        work.check();
        const Fit fit = gauss_newton(pairs, at, problem.center, round.cutoff);
        if (fit.misfit < best.misfit) best = fit;
      }
    } else {
      best = gauss_newton(pairs, best.at, problem.center, round.cutoff);
    }
    if (!same_layers) {
      shift_z = find_shift_z(problem, best.at, shift_z);
    }
    stage.advance();
  }
  Registration found;
  found.pose = {problem.center, {best.at[0], best.at[1], shift_z}, best.at[2] / kRadian};
  found.scale = {1 + best.at[3], 1 + best.at[4]};
  found.misfit = best.misfit;
  return found;
}

}  // namespace binderjet
