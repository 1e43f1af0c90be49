// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/residual/dose_probe.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "slicer/model/dose/density_field.h"

namespace binderjet {

DoseProbe::Rise DoseProbe::rise_of(const Kernel& kernel) {
  Rise out{kernel.first, {}};
  double sum = 0;
  const auto total = static_cast<double>(kernel.total());
  for (const std::int64_t weight : kernel.weights) {
    sum += static_cast<double>(weight) / total;
    out.rise.push_back(sum);
  }
  return out;
}

// Linear between whole offsets, as the dose is between voxels.
double DoseProbe::Rise::at(double offset) const {
  const double place = offset - first;
  if (place <= -1) return 0;
  const auto last = static_cast<double>(rise.size()) - 1;
  if (place >= last) return 1;
  const int below = static_cast<int>(std::floor(place));
  const double part = place - below;
  const double low = below < 0 ? 0 : rise[static_cast<std::size_t>(below)];
  return low + part * (rise[static_cast<std::size_t>(below + 1)] - low);
}

DoseProbe::DoseProbe(AssembledModel form, const Grid& grid, const JobPlace& place)
    : form_(std::move(form)), grid_(grid), place_(place) {
  const Reach reach = form_.reach(grid);
  window_reach_ = std::max(reach.layers_below, reach.layers_above);
  for (const MaskShift& shift : form_.placed.shifts) {
    max_shift_vx_ += pixels_for(shift.max_mm, grid.voxel_mm(1));
  }
  for (const DoseTerm& term : form_.terms) {
    terms_.push_back(
        {term.layer, term.gain, rise_of(term.x), rise_of(term.y), term.y.first, term.y.last()});
  }
}

double DoseProbe::term_dose(const Term& term, const RunLayer& mask, int layer,
                            DosePlace place) const {
  const auto [rx, ry, rz] = grid_.detail_vx;
  const bool shifted = !form_.placed.shifts.empty();
  const int low = static_cast<int>(std::floor(place.y_vx)) - term.y_last - max_shift_vx_ - 1;
  const int high = static_cast<int>(std::ceil(place.y_vx)) - term.y_first + max_shift_vx_ + 1;
  const int last = std::min(mask.height() - 1, high / ry);
  double dose = 0;
  for (int row = std::max(0, low / ry); row <= last; ++row) {
    const std::span<const int> flips = mask.row(row);
    if (flips.empty()) continue;
    double y = place.y_vx - row * ry;
    Spot spot;
    if (shifted) {
      spot = spot_at(grid_, place_, rx * mask.width() / 2.0, (row + 0.5) * ry - 0.5, layer);
      y -= form_.placed.shift_at(spot)[1] / grid_.voxel_mm(1);
    }
    const double weight = term.y.at(y) - term.y.at(y - ry);
    if (weight == 0) continue;
    // The share of a flip's binder that lands at or left of the place.
    const auto risen = [&](int flip) {
      double x = place.x_vx - flip * rx;
      if (shifted) {
        spot.x_mm = place_.origin_mm[0] + flip * grid_.pitch_mm[0];
        x -= form_.placed.shift_at(spot)[0] / grid_.voxel_mm(0);
      }
      return term.x.at(x);
    };
    double sum = 0;
    double sign = 1;
    for (const int flip : flips) {
      sum += sign * risen(flip);
      sign = -sign;
    }
    form_.placed.for_each_weakening(flips,
                                    [&](int pixel, double share) { sum -= share * risen(pixel); });
    dose += weight * sum;
  }
  return dose * term.gain;
}

void DoseProbe::margins(const RunWindow& window, int layer, std::span<const DosePlace> places,
                        std::span<double> out) const {
  const AssembledModel::Received received = form_.received(window, layer);
  const std::optional<DensityField> density = density_of(received.masks, grid_, form_.placed);
  for (std::size_t i = 0; i < places.size(); ++i) {
    double dose = 0;
    for (const Term& term : terms_) {
      const RunLayer* mask = received.masks.at(term.layer);
      if (mask != nullptr) dose += term_dose(term, *mask, layer + term.layer, places[i]);
    }
    if (!form_.placed.gains.empty()) {
      Spot spot = spot_at(grid_, place_, places[i].x_vx, places[i].y_vx, layer);
      if (density) spot.density = density->at(places[i].x_vx, places[i].y_vx);
      dose *= form_.placed.gain_at(spot);
    }
    out[i] = dose - form_.level;
  }
}

}  // namespace binderjet
