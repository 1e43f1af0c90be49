// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/choice/random_layers.h"

#include <algorithm>
#include <cmath>

#include "slicer/calibrate/choice/rank_candidates.h"

namespace binderjet {
namespace {

// More layers make the equations too many, and the finding no surer.
constexpr int kMaxLayers = 100;

// How much the shift of a layer says of the next one's: 0 for random ones, 1 for a trend, -1 where
// even and odd layers are apart.
double follows(const std::vector<double>& shifts) {
  double product = 0;
  double square = 0;
  for (std::size_t k = 0; k < shifts.size(); ++k) {
    if (k > 0) product += shifts[k - 1] * shifts[k];
    square += shifts[k] * shifts[k];
  }
  return square > 0 ? product / square : 0;
}

}  // namespace

std::optional<RandomLayers> find_random_layers(const MeasuredJob& job, const EffectList& model,
                                               const std::vector<SurfacePoint>& points,
                                               const std::vector<std::vector<float>>& known) {
  std::vector<char> has_points(job.masks.size(), 0);
  for (const SurfacePoint& point : points) has_points[static_cast<std::size_t>(point.layer)] = 1;
  Candidate candidate{.along = kAlongZ, .effect = model.size()};
  for (int k = 0; k < std::min(job.layers(), kMaxLayers); ++k) {
    if (has_points[static_cast<std::size_t>(k)] == 0) continue;
    const int layer = job.first_layer + k;
    const auto here = [layer](const Spot& spot) { return spot.layer == layer ? 1.0 : 0.0; };
    candidate.columns.push_back(shift_column(0, here));
    candidate.columns.push_back(shift_column(1, here));
  }
  if (candidate.columns.size() < 10) return std::nullopt;
  candidate.apply = [&model](std::span<const double>) { return model; };
  const auto ranked = rank_candidates(job, model, points, known, {candidate});
  if (ranked.empty() || !ranked.front().folds_agree) return std::nullopt;

  RandomLayers out;
  out.p = ranked.front().p;
  out.share = ranked.front().share;
  bool any = false;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    // Where masks are moved by whole voxels the rest of any shift, 1 / sqrt 12 of a voxel, looks
    // random too.
    const double nothing_mm = 0.4 * job.grid.voxel_mm(static_cast<int>(axis));
    std::vector<double> shifts;
    for (std::size_t i = axis; i < ranked.front().coefficients.size(); i += 2) {
      shifts.push_back(ranked.front().coefficients[i]);
    }
    constexpr double kFollows = 0.4;
    double square = 0;
    for (const double shift : shifts) square += shift * shift;
    out.sigma_mm[axis] = std::sqrt(square / static_cast<double>(shifts.size()));
    if (out.sigma_mm[axis] <= nothing_mm) continue;
    if (std::abs(follows(shifts)) > kFollows) return std::nullopt;
    any = true;
  }
  return any ? std::optional(out) : std::nullopt;
}

}  // namespace binderjet
