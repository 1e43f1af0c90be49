// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/empirical.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "slicer/base/error.h"
#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

// A trend may not run away where nobody measured.
constexpr double kMost = 0.9;

// Far below a layer or a voxel: 7 * (3 / 7.0) need not be 3.
constexpr double kRounding = 1e-6;

using Of = std::function<double(double)>;
using Place = std::function<double(const Spot&)>;

double need(const EffectSpec& spec, const std::string& name, std::size_t index = 0) {
  if (!spec.numbers.contains(name)) {
    throw Error(ErrorKind::kBadInput, "effects",
                "empirical with this axis and form needs the key " + name);
  }
  return spec.number(name, index);
}

Place place_of(const EffectSpec& spec, const JobPlace& job) {
  const std::string& axis = spec.words.at("axis");
  if (axis == "x") return [](const Spot& spot) { return spot.x_mm; };
  if (axis == "y") return [](const Spot& spot) { return spot.y_mm; };
  if (axis == "z") return [](const Spot& spot) { return spot.z_mm; };
  if (axis == "layer") return [](const Spot& spot) { return static_cast<double>(spot.layer); };
  if (axis == "density") return [](const Spot& spot) { return spot.density; };
  if (axis == "edge_distance") {
    return [job](const Spot& spot) { return edge_distance(job, spot); };
  }
  if (axis == "direction") {
    const double angle = need(spec, "direction_deg") * std::numbers::pi / 180;
    return [x = std::cos(angle), y = std::sin(angle)](const Spot& spot) {
      return x * spot.x_mm + y * spot.y_mm;
    };
  }
  return [x = need(spec, "center_mm"), y = need(spec, "center_mm", 1)](const Spot& spot) {
    return std::hypot(spot.x_mm - x, spot.y_mm - y);
  };
}

// The dependence, and its largest absolute value.
std::pair<Of, double> shape_of(const EffectSpec& spec) {
  const std::string& form = spec.words.at("form");
  if (form == "periodic") {
    const double turn = 2 * std::numbers::pi / need(spec, "period");
    const double c = need(spec, "wave");
    const double s = need(spec, "wave", 1);
    return {[=](double u) { return c * std::cos(turn * u) + s * std::sin(turn * u); },
            std::hypot(c, s)};
  }
  const double amount = need(spec, "amount");
  const double most = std::abs(amount);
  if (form == "step") {
    return {[amount, at = need(spec, "at")](double u) { return u >= at ? amount : 0; }, most};
  }
  if (form == "window") {
    return {[amount, from = need(spec, "from"), to = need(spec, "to")](double u) {
              return u >= from && u < to ? amount : 0;
            },
            most};
  }
  if (form == "pulse") {
    return {[amount, at = need(spec, "at"), width = need(spec, "width"),
             period = need(spec, "period")](double u) {
              const double turns = (u - at) / period;
              return (turns - std::floor(turns)) * period < width - kRounding ? amount : 0;
            },
            most};
  }
  if (form == "local") {
    return {[amount, at = need(spec, "at"), width = need(spec, "width")](double u) {
              return amount * std::exp(-(u - at) * (u - at) / (2 * width * width));
            },
            most};
  }
  return {[amount, from = need(spec, "from")](double u) {
            return std::clamp(amount * (u - from), -kMost, kMost);
          },
          kMost};
}

void add(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  if (spec.words.at("axis") == "density") form.ask_density(need(spec, "radius_mm"));
  const Place place = place_of(spec, form.place);
  const auto [of, most] = shape_of(spec);
  const std::string& acts = spec.words.at("acts");
  if (acts == "dose") {
    form.placed.gains.push_back(
        {[place, of = of](const Spot& spot) { return of(place(spot)); }, most});
    return;
  }
  const std::size_t axis = acts == "shift_x" ? 0 : 1;
  std::array<double, 2> most_mm{};
  most_mm[axis] = most;
  form.shift(
      [place, of = of, axis](const Spot& spot) {
        std::array<double, 2> by{};
        by[axis] = of(place(spot));
        return by;
      },
      most_mm);
}

}  // namespace

EffectKind empirical_kind() {
  constexpr double kFar = 10000;
  return {"empirical",
          {{"acts", {"dose", "shift_x", "shift_y"}},
           {"axis", {"x", "y", "z", "layer", "direction", "density", "edge_distance", "position"}},
           {"form", {"trend", "periodic", "pulse", "step", "window", "local"}}},
          {{"amount", 1, -5, 5, 0, 0, true},
           {"wave", 2, -5, 5, 0, 0, true},
           {"from", 1, -kFar, kFar, 0, 0, true},
           {"to", 1, -kFar, kFar, 0, 0, true},
           {"at", 1, -kFar, kFar, 0, 0, true},
           {"width", 1, 0, kFar, 0, 0, true},
           {"period", 1, 0, kFar, 0, 0, true},
           {"direction_deg", 1, -360, 360, 0, 0, true},
           {"radius_mm", 1, 0, 10, 0, 0, true},
           {"center_mm", 2, -kFar, kFar, 0, 0, true}},
          add};
}

}  // namespace binderjet
