// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/residual/residual_by_axis.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "slicer/calibrate/residual/surface.h"
#include "slicer/model/dose/density_field.h"

namespace binderjet {
namespace {

// A surface point with all that a profile may be drawn along.
struct Drawn {
  Spot spot;
  double facing_deg;  // 0: x, 90: y, 180, 270
  double edge_mm;
  double out_mm;  // how far the measured surface lies outside the predicted one
};

std::vector<Drawn> drawn_points(const MeasuredJob& job, const std::vector<EffectSpec>& model) {
  const LayerChoice all(job.masks.size(), true);
  const auto points = surface_points(job, model, all, kChoicePoints, kPairReachMm);
  constexpr double kDensityRadiusMm = 2;
  const int reach = pixels_for(kDensityRadiusMm, job.grid.pitch_mm[2]);
  std::unique_ptr<DensityField> density;
  int layer = -1;
  std::vector<Drawn> out;
  for (const SurfacePoint& point : points) {
    if (point.layer != layer) {
      layer = point.layer;
      density = std::make_unique<DensityField>(mask_window(job, layer, reach), job.grid,
                                               kDensityRadiusMm);
    }
    const DosePlace place = point.place();
    Spot spot = spot_at(job.grid, job.place, place.x_vx, place.y_vx, job.first_layer + layer);
    spot.density = density->at(place.x_vx, place.y_vx);
    const double facing = point.axis * 90 + (point.sign > 0 ? 0 : 180);
    out.push_back({spot, facing, edge_distance(job.place, spot),
                   point.sign * point.offset_vx * job.grid.voxel_mm(point.axis)});
  }
  return out;
}

struct Axis {
  std::string name;
  std::string unit;
  int bins;
  std::function<double(const Drawn&)> of;
};

// Means per bin into `means`; the bins span [low, high].
void fill(const std::vector<Drawn>& points, const Axis& axis, double low, double high,
          std::vector<double>& means, std::vector<std::int64_t>& counts) {
  means.assign(static_cast<std::size_t>(axis.bins), 0);
  counts.assign(static_cast<std::size_t>(axis.bins), 0);
  for (const Drawn& point : points) {
    const double share = (axis.of(point) - low) / std::max(1e-12, high - low);
    const int bin = std::clamp(static_cast<int>(share * axis.bins), 0, axis.bins - 1);
    means[static_cast<std::size_t>(bin)] += point.out_mm;
    ++counts[static_cast<std::size_t>(bin)];
  }
  for (std::size_t i = 0; i < means.size(); ++i) {
    means[i] /= std::max<double>(1, static_cast<double>(counts[i]));
  }
}

}  // namespace

std::vector<ResidualProfile> residual_profiles(const MeasuredJob& job,
                                               const std::vector<EffectSpec>& before,
                                               const std::vector<EffectSpec>& after) {
  const std::vector<Drawn> first = drawn_points(job, before);
  const std::vector<Drawn> last = drawn_points(job, after);
  const std::vector<Axis> axes = {
      {"x", "mm", 48, [](const Drawn& p) { return p.spot.x_mm; }},
      {"y", "mm", 48, [](const Drawn& p) { return p.spot.y_mm; }},
      {"layer", "", std::min(48, job.layers()),
       [](const Drawn& p) { return static_cast<double>(p.spot.layer); }},
      {"facing", "deg", 4, [](const Drawn& p) { return p.facing_deg; }},
      {"edge distance", "mm", 24, [](const Drawn& p) { return p.edge_mm; }},
      {"density", "", 24, [](const Drawn& p) { return p.spot.density; }}};
  std::vector<ResidualProfile> out;
  if (first.empty() || last.empty()) return out;
  for (const Axis& axis : axes) {
    double low = axis.of(first.front());
    double high = low;
    for (const Drawn& point : first) {
      low = std::min(low, axis.of(point));
      high = std::max(high, axis.of(point));
    }
    ResidualProfile profile{axis.name, axis.unit, {}, {}, {}, {}};
    std::vector<std::int64_t> after_points;
    fill(last, axis, low, high, profile.after_mm, after_points);
    fill(first, axis, low, high, profile.before_mm, profile.points);
    for (int i = 0; i < axis.bins; ++i) {
      profile.centers.push_back(low + (i + 0.5) * (high - low) / axis.bins);
    }
    out.push_back(profile);
  }
  return out;
}

}  // namespace binderjet
