// SPDX-License-Identifier: GPL-3.0-or-later
// Empirical: a measured dependence without a mechanism, by what it depends on.
//
//   acts = "dose" | "shift_x" | "shift_y": the dose is multiplied by 1 + f(u), or the masks are
//          shifted by f(u) mm
//   axis = "x" | "y" | "z": u is the place on the bed in mm
//        | "layer": the number of the layer, from 0 on the bed
//        | "direction": the place along direction_deg (from x, 0, to y, 90), in mm
//        | "density": the solid share within radius_mm
//        | "edge_distance": the way from the side of the job's box, in mm (a trap: of the box, not
//        of
//          the part within it)
//        | "position": the way from center_mm = [x, y]
//   form = "trend":    f(u) = amount (u - from), within -0.9 and 0.9
//        | "step":     amount from `at` on
//        | "window":   amount from `from` to `to`
//        | "local":    amount exp(-(u - at)^2 / (2 width^2))
//        | "periodic": c cos(2 pi u / period) + s sin(2 pi u / period), wave = [c, s]
//        | "pulse":    amount from `at` on over `width`, again after each period
//
// What an axis and a form need must be there; amounts are above -5 and at most 5. Its candidates,
// the scan for what has no name, are in empirical_scan.cpp.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "slicer/base/error.h"
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/covariate.h"

namespace binderjet {

void add_empirical_candidates(CandidateList& list);  // empirical_scan.cpp

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

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
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
  std::array<double, 2> max_mm{};
  max_mm[axis] = most;
  form.shift(
      [place, of = of, axis](const Spot& spot) {
        std::array<double, 2> by{};
        by[axis] = of(place(spot));
        return by;
      },
      max_mm);
}

// Which layers a pulse is in is found by the scan: between two of them there is nothing to fit.
bool is_no_pulse(const EffectSpec& spec, double) { return spec.words.at("form") != "pulse"; }
// Every second layer is every second layer.
bool is_no_pulse_nor_parity(const EffectSpec& spec, double period) {
  return is_no_pulse(spec, period) && period != 2;
}
// What runs along an axis of the printer has no reason to be turned by a little.
bool is_askew(const EffectSpec& spec, double direction_deg) {
  return is_no_pulse(spec, direction_deg) && std::fmod(direction_deg, 90) != 0;
}

// A place along an axis that has layers or voxels.
double one_cell(const EffectSpec& spec, double, const Grid& grid) {
  const std::string& axis = spec.words.at("axis");
  return axis == "z"   ? grid.pitch_mm[2]
         : axis == "x" ? grid.voxel_mm(0)
         : axis == "y" ? grid.voxel_mm(1)
                       : 0;
}

EffectSpec effect(const char* acts, const char* axis, const char* form,
                  std::map<std::string, std::vector<double>> numbers) {
  return {"empirical", {{"acts", acts}, {"axis", axis}, {"form", form}}, std::move(numbers)};
}

void update_covariate(const EffectSpec& fitted, Covariate& covariate) {
  const auto copy = [&](const char* from, const char* to) {
    if (covariate.numbers.contains(to) && fitted.numbers.contains(from)) {
      covariate.numbers[to] = fitted.numbers.at(from);
    }
  };
  copy("period", covariate.axis == Covariate::Axis::kLayer ? "period_layers" : "period_mm");
  copy("direction_deg", "direction_deg");
  copy("center_mm", "centre_mm");
}

constexpr double kFar = 10000;

NumberRule place_rule(const char* name) {
  return {.name = name, .min = -kFar, .max = kFar, .optional = true, .search_step = one_cell};
}

}  // namespace

EffectKind empirical_effect() {
  return {
      .name = "empirical",
      .words = {{"acts", {"dose", "shift_x", "shift_y"}},
                {"axis",
                 {"x", "y", "z", "layer", "direction", "density", "edge_distance", "position"}},
                {"form", {"trend", "periodic", "pulse", "step", "window", "local"}}},
      .numbers =
          {{.name = "amount", .min = -5, .max = 5, .optional = true, .fit_step = 0.005},
           {.name = "wave",
            .count = 2,
            .min = -5,
            .max = 5,
            .optional = true,
            .fit_step = 0.003,
            .fits = is_no_pulse},
           place_rule("from"),
           place_rule("to"),
           place_rule("at"),
           {.name = "width",
            .min = 0,
            .max = kFar,
            .optional = true,
            .fit_share = 0.05,
            .fits = is_no_pulse},
           {.name = "period",
            .min = 0,
            .max = kFar,
            .optional = true,
            .fit_share = 0.002,
            .fits = is_no_pulse_nor_parity},
           {.name = "direction_deg",
            .min = -360,
            .max = 360,
            .optional = true,
            .fit_step = 0.5,
            .fits = is_askew},
           {.name = "radius_mm", .min = 0, .max = 10, .optional = true, .search_step = one_tenth},
           {.name = "center_mm",
            .count = 2,
            .min = -kFar,
            .max = kFar,
            .optional = true,
            .fit_step = 0.05,
            .fits = is_no_pulse}},
      .write_into = write_into,
      .examples = {effect("shift_x", "y", "periodic", {{"period", {0.9}}, {"wave", {0.1, 0.05}}}),
                   effect("dose", "layer", "pulse",
                          {{"period", {3}}, {"at", {1}}, {"width", {1}}, {"amount", {-0.4}}}),
                   effect(
                       "dose", "position", "local",
                       {{"center_mm", {4.5, 6}}, {"at", {0}}, {"width", {0.5}}, {"amount", {0.4}}}),
                   effect("shift_y", "z", "step", {{"at", {0.25}}, {"amount", {0.1}}}),
                   effect("dose", "x", "window", {{"from", {4}}, {"to", {5}}, {"amount", {-0.4}}}),
                   effect("dose", "direction", "trend",
                          {{"direction_deg", {30}}, {"from", {5.5}}, {"amount", {0.3}}}),
                   effect("dose", "density", "trend",
                          {{"radius_mm", {0.4}}, {"from", {0.3}}, {"amount", {0.5}}}),
                   effect("dose", "edge_distance", "local",
                          {{"at", {0}}, {"width", {0.5}}, {"amount", {-0.4}}})},
      .nameless = true,
      .add_candidates = add_empirical_candidates,
      .update_covariate = update_covariate};
}

}  // namespace binderjet
