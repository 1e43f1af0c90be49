// SPDX-License-Identifier: GPL-3.0-or-later
// The candidates of the empirical effect: a dose or a shift that depends on a coordinate, whatever
// the reason. Where an effect of the catalogue has the same columns there is no candidate here.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

using Axis = Covariate::Axis;
using Basis = Column::Basis;
using Form = Covariate::Form;
using Numbers = std::map<std::string, std::vector<double>>;

const std::string& acts_word(Basis basis) {
  static const std::string dose = "dose";
  static const std::string x = "shift_x";
  static const std::string y = "shift_y";
  return basis == Basis::kDose ? dose : basis == Basis::kShiftX ? x : y;
}

class Scan {
 public:
  explicit Scan(CandidateList& list) : list_(list), job_(list.job()) {}

  void add_all() {
    for (const Basis acts : {Basis::kDose, Basis::kShiftX, Basis::kShiftY}) {
      add_layers(acts);
      for (std::size_t axis = 0; axis < 2; ++axis) add_along(acts, axis);
    }
    add_directions();
    add_places();
  }

 private:
  // amount * of(spot), or c cos + s sin of it with `of` in turns.
  Candidate& add(Basis acts, Covariate covariate, unsigned along, Numbers numbers,
                 const std::string& axis, const std::string& form,
                 const std::function<double(const Spot&)>& of) {
    const EffectSpec effect = list_.effect(
        {{"acts", acts_word(acts)}, {"axis", axis}, {"form", form}}, std::move(numbers));
    std::vector<Column> columns;
    if (form == "periodic") {
      constexpr double kTurn = 2 * std::numbers::pi;
      columns = {{.basis = acts, .of = [of](const Spot& s) { return std::cos(kTurn * of(s)); }},
                 {.basis = acts, .of = [of](const Spot& s) { return std::sin(kTurn * of(s)); }}};
    } else {
      columns = {{.basis = acts, .of = of}};
    }
    return list_.add_effect(std::move(covariate), std::move(columns), along,
                            [effect](Coefficients c) {
                              EffectSpec found = effect;
                              if (c.size() == 2) {
                                found.numbers["wave"] = {c[0], c[1]};
                              } else {
                                found.numbers["amount"] = {std::clamp(c[0], -4.9, 4.9)};
                              }
                              return found;
                            });
  }

  void add_layers(Basis acts) {
    const int count = job_.layers;
    const double pitch = job_.grid.pitch_mm[2];
    constexpr double kShortestLayers = 2.2;
    for (const double f : frequencies(count, kShortestLayers)) {
      add(acts, {Axis::kLayer, Form::kPeriodic, {{"period_layers", {1 / f}}}}, kAlongZ,
          {{"period", {1 / f}}}, "layer", "periodic", [f](const Spot& s) { return f * s.layer; });
    }
    if (acts == Basis::kDose) {
      // Every second layer; as a shift this is the catalogue's parity.
      Candidate& second =
          add(acts, {Axis::kLayer, Form::kPeriodic, {{"period_layers", {2}}}}, kAlongZ,
              {{"period", {2}}}, "layer", "periodic", [](const Spot& s) { return s.layer / 2.0; });
      second.columns.pop_back();
      const EffectSpec wave = list_.effect(
          {{"acts", acts_word(acts)}, {"axis", "layer"}, {"form", "periodic"}}, {{"period", {2}}});
      second.apply = [model = list_.model(), wave](Coefficients c) {
        EffectSpec found = wave;
        found.numbers["wave"] = {c[0], 0};
        return with_effect(model, found);
      };
    }
    add_pulses(acts);
    if (acts != Basis::kDose) {
      // As a dose this is the catalogue's pause.
      for (int k = 2; k <= count - 2; ++k) {
        const double at = (job_.first_layer + k) * pitch;
        add(acts, {Axis::kZ, Form::kStep, {{"at_mm", {at}}}}, kAlongZ, {{"at", {at}}}, "z", "step",
            [at](const Spot& s) { return s.z_mm >= at ? 1.0 : 0.0; });
      }
    }
    for (const int width : {1, 2, 3, 5, 8, 12}) {
      for (int k = 0; k + width <= count; k += std::max(1, width / 3)) {
        const double from = (job_.first_layer + k) * pitch;
        const double to = from + width * pitch;
        add(acts, {Axis::kZ, Form::kWindow, {{"from_mm", {from}}, {"to_mm", {to}}}}, kAlongZ,
            {{"from", {from}}, {"to", {to}}}, "z", "window",
            [from, to](const Spot& s) { return s.z_mm >= from && s.z_mm < to ? 1.0 : 0.0; });
      }
    }
  }

  // One layer of every so many is another: a refill, a cleaning. No few waves add up to that.
  void add_pulses(Basis acts) {
    constexpr int kMaxLayers = 12;
    constexpr int kFewest = 3;  // twice could be two windows
    for (int period = 3; period <= std::min(kMaxLayers, job_.layers / kFewest); ++period) {
      for (int at = 0; at < period; ++at) {
        add(acts,
            {Axis::kLayer, Form::kPeriodic, {{"period_layers", {static_cast<double>(period)}}}},
            kAlongZ,
            {{"period", {static_cast<double>(period)}},
             {"at", {static_cast<double>(at)}},
             {"width", {1}}},
            "layer", "pulse",
            [period, at](const Spot& s) { return (s.layer - at) % period == 0 ? 1.0 : 0.0; });
      }
    }
  }

  void add_along(Basis acts, std::size_t axis) {
    const std::string name = axis == 0 ? "x" : "y";
    const Axis covariate = axis == 0 ? Axis::kX : Axis::kY;
    const unsigned along = axis == 0 ? kAlongX : kAlongY;
    const auto place = [axis](const Spot& s) { return axis == 0 ? s.x_mm : s.y_mm; };
    const double origin = job_.place.origin_mm[axis];
    const double size = job_.place.size_mm[axis];
    if (acts != Basis::kDose) {
      // As a dose this is the catalogue's band_swath.
      constexpr double kShortestMm = 0.9;
      for (const double f : frequencies(size, kShortestMm)) {
        add(acts, {covariate, Form::kPeriodic, {{"period_mm", {1 / f}}}}, along,
            {{"period", {1 / f}}}, name, "periodic",
            [f, place](const Spot& s) { return f * place(s); });
      }
      const double center = job_.place.center_mm(axis);
      const bool skew = (acts == Basis::kShiftX) != (axis == 0);
      if (skew) {
        // The axes are not square to each other: that has a name.
        Candidate& askew =
            add(acts, {covariate, Form::kTrend, {}}, along, {{"from", {center}}}, name, "trend",
                [center, place](const Spot& s) { return place(s) - center; });
        askew.kind = "axis_calib";
        askew.named = true;
      }
    }
    constexpr double kStepMm = 0.2;
    for (double at = origin + kStepMm; at < origin + size; at += kStepMm) {
      add(acts, {covariate, Form::kStep, {{"at_mm", {at}}}}, along, {{"at", {at}}}, name, "step",
          [at, place](const Spot& s) { return place(s) >= at ? 1.0 : 0.0; });
    }
    // Narrow windows of the dose along y are the catalogue's jet_out.
    for (const double width : {0.3, 0.6, 1.2, 2.4, 4.8}) {
      if (acts == Basis::kDose && axis == 1 && width < 2) continue;
      for (double from = origin; from + width <= origin + size; from += width / 4) {
        const double to = from + width;
        add(acts, {covariate, Form::kWindow, {{"from_mm", {from}}, {"to_mm", {to}}}}, along,
            {{"from", {from}}, {"to", {to}}}, name, "window", [from, to, place](const Spot& s) {
              return place(s) >= from && place(s) < to ? 1. : 0.;
            });
      }
    }
  }

  // Waves of the dose across any direction, on a grid of frequencies along x and y.
  void add_directions() {
    constexpr double kShortestMm = 1.8;
    const double step_x = 1 / (2 * job_.place.size_mm[0]);
    const double step_y = 1 / (2 * job_.place.size_mm[1]);
    const int max_x = static_cast<int>(1 / kShortestMm / step_x);
    const int max_y = static_cast<int>(1 / kShortestMm / step_y);
    for (int j = 1; j <= max_y; ++j) {
      for (int i = -max_x; i <= max_x; ++i) {
        const double fx = i * step_x;
        const double fy = j * step_y;
        const double f = std::hypot(fx, fy);
        const double angle = std::atan2(fy, fx) * 180 / std::numbers::pi;
        // Along the axes it is the catalogue's band_swath.
        constexpr double kNearAxisDeg = 8;
        const double off_axis = std::abs(std::remainder(angle, 90));
        if (f > 1 / kShortestMm || f < 2 * std::min(step_x, step_y) || off_axis < kNearAxisDeg) {
          continue;
        }
        add(Basis::kDose,
            {Axis::kDirection,
             Form::kPeriodic,
             {{"direction_deg", {angle}}, {"period_mm", {1 / f}}}},
            kAlongX | kAlongY, {{"direction_deg", {angle}}, {"period", {1 / f}}}, "direction",
            "periodic", [fx, fy](const Spot& s) { return fx * s.x_mm + fy * s.y_mm; });
      }
    }
  }

  void add_places() {
    for (const double width : {0.8, 1.6, 3.2}) {
      const auto count = [&](std::size_t axis) {
        return std::max(1, static_cast<int>(job_.place.size_mm[axis] / width));
      };
      for (int j = 0; j < count(1); ++j) {
        for (int i = 0; i < count(0); ++i) {
          const double x = job_.place.origin_mm[0] + (i + 0.5) * job_.place.size_mm[0] / count(0);
          const double y = job_.place.origin_mm[1] + (j + 0.5) * job_.place.size_mm[1] / count(1);
          add(Basis::kDose,
              {Axis::kPosition, Form::kLocal, {{"centre_mm", {x, y}}, {"radius_mm", {2 * width}}}},
              kAlongX | kAlongY, {{"center_mm", {x, y}}, {"at", {0}}, {"width", {width}}},
              "position", "local", [x, y, width](const Spot& s) {
                const double d2 = (s.x_mm - x) * (s.x_mm - x) + (s.y_mm - y) * (s.y_mm - y);
                return std::exp(-d2 / (2 * width * width));
              });
        }
      }
    }
    // How far from the side of the job's box.
    const JobPlace& place = job_.place;
    const auto inward = [place](const Spot& s) { return edge_distance(place, s); };
    for (const double width : {0.5, 1.0, 2.0, 4.0}) {
      add(Basis::kDose,
          {Axis::kEdgeDistance, Form::kWindow, {{"from_mm", {0}}, {"to_mm", {2 * width}}}},
          kAlongX | kAlongY, {{"at", {0}}, {"width", {width}}}, "edge_distance", "local",
          [inward, width](const Spot& s) {
            const double d = inward(s);
            return std::exp(-d * d / (2 * width * width));
          });
    }
    add(Basis::kDose, {Axis::kEdgeDistance, Form::kTrend, {}}, kAlongX | kAlongY, {{"from", {0}}},
        "edge_distance", "trend", inward);
  }

  CandidateList& list_;
  const JobExtent& job_;
};

}  // namespace

void add_empirical_candidates(CandidateList& list) { Scan(list).add_all(); }

}  // namespace binderjet
