// SPDX-License-Identifier: GPL-3.0-or-later
// The effect catalogue as candidates (shared data: effect_catalogue.csv).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "slicer/calibrate/candidate.h"

namespace binderjet {
namespace {

using Basis = Column::Basis;
using Coefficients = std::span<const double>;

class Catalogue {
 public:
  Catalogue(const MeasuredJob& job, const Model& model) : job_(job), model_(model) {}

  std::vector<Candidate> take() {
    add_dose_effects();
    add_kernel_effects();
    add_layer_effects();
    add_shift_effects();
    add_bed_effects();
    add_bands();
    add_jets();
    return std::move(out_);
  }

 private:
  double height_mm() const { return job_.layers() * job_.grid.pitch_mm[2]; }
  double bottom_mm() const { return job_.first_layer * job_.grid.pitch_mm[2]; }
  bool has(const std::string& kind) const { return find_effect(model_, kind) != nullptr; }

  void add(const std::string& kind, Covariate covariate, std::vector<Column> columns,
           unsigned along, std::function<Model(Coefficients)> apply) {
    out_.push_back(
        {kind, std::move(covariate), std::move(columns), along, std::move(apply), model_.size()});
  }
  // An effect whose parameter goes from 0: its column is the forward model's own difference.
  void add_from_zero(const std::string& kind, Covariate covariate, double step,
                     const std::function<EffectSpec(double)>& effect, double least, double most) {
    Column column;
    column.basis = Basis::kModel;
    column.nudged = with_effect(model_, effect(step));
    column.step = step;
    add(kind, std::move(covariate), {column}, kNowhere,
        [model = model_, effect, least, most](Coefficients c) {
          return c[0] < least || c[0] > most ? Model{} : with_effect(model, effect(c[0]));
        });
  }

  void add_dose_effects() {
    add("threshold", {"facing", "", {}}, {{Basis::kLevel, {}, {}, 1}}, kNowhere,
        [model = model_](Coefficients c) {
          Model out = model;
          for (EffectSpec& effect : out) {
            if (!effect.numbers.contains("level")) continue;
            double& level = effect.numbers["level"].front();
            level = std::clamp(level - c[0], 0.02, 1.0);
          }
          return out;
        });
    out_.back().effect = level_place();
    for (const double radius_mm : {0.75, 1.1, 1.5, 2.0, 2.5, 3.2, 4.0}) {
      if (has("density")) break;
      const auto effect = [radius_mm](double strength) {
        return EffectSpec{
            "density",
            {},
            {{"strength", {strength}}, {"radius_mm", {radius_mm}}, {"reference", {0.5}}}};
      };
      Column column{Basis::kModel, {}, with_effect(model_, effect(0.05)), 0.05};
      add("density", {"density", "trend", {}}, {column, {Basis::kDose, {}, {}, 1}}, kNowhere,
          [model = model_, effect](Coefficients c) {
            return with_effect(with_level_gain(model, c[1]), effect(c[0]));
          });
    }
  }

  std::size_t level_place() const {
    const auto found = std::find_if(model_.begin(), model_.end(), [](const EffectSpec& effect) {
      return effect.numbers.contains("level");
    });
    return static_cast<std::size_t>(found - model_.begin());
  }

  void add_kernel_effects() {
    const EffectSpec* spread = find_effect(model_, "spread");
    if (spread == nullptr) return;
    const auto place = static_cast<std::size_t>(spread - model_.data());
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto widened = [model = model_, place, axis](Coefficients c) {
        Model out = model;
        double& width = out[place].numbers["width_mm"][axis];
        width *= std::clamp(1 + c[0], 0.2, 4.0);
        return out;
      };
      constexpr double kStep = 0.05;
      add(axis == 0 ? "kernel_x" : "kernel_y", {axis == 0 ? "x" : "y", "local", {}},
          {{Basis::kModel, {}, widened(std::array{kStep}), kStep}}, kNowhere, widened);
      out_.back().effect = place;
    }
    if (spread->words.at("shape") == "box") {
      const auto gaussian = [model = model_, place](Coefficients) {
        // The gaussian with the box's second moment.
        const double same_moment = 2 * std::sqrt(2 * std::log(2.0)) / std::sqrt(12.0);
        Model out = model;
        out[place].words["shape"] = "gaussian";
        for (double& width : out[place].numbers["width_mm"]) width *= same_moment;
        return out;
      };
      add("kernel_shape", {"x", "local", {}}, {{Basis::kModel, {}, gaussian({}), 1}}, kNowhere,
          gaussian);
      out_.back().effect = place;
    }
    for (const double width_mm : {0.6, 1.0, 1.6}) {
      if (has("tail")) break;
      add_from_zero(
          "kernel_shape", {"x", "local", {}}, 0.05,
          [width_mm](double share) {
            return EffectSpec{"tail", {}, {{"share", {share}}, {"width_mm", {width_mm, width_mm}}}};
          },
          0.01, 0.8);
    }
    for (const double radius_mm : {0.06, 0.15}) {
      if (has("rounding")) break;
      const auto effect = [radius_mm](double power) {
        return EffectSpec{"rounding", {}, {{"radius_mm", {radius_mm * std::sqrt(power)}}}};
      };
      add_from_zero("rounding", {"facing", "local", {}}, 1, effect, 0.05, 8);
    }
  }

  void add_layer_effects() {
    for (const char* kind : {"z_bleed_down", "z_wick_up"}) {
      if (has(kind)) continue;
      add_from_zero(
          kind, {"z", "trend", {}}, 0.1,
          [kind](double share) {
            return EffectSpec{kind, {}, {{"share", {share}}}};
          },
          0.01, 0.85);
    }
    add("grad_z", {"z", "trend", {}},
        {{Basis::kDose, [](const Spot& s) { return s.z_mm; }, {}, 1}, {Basis::kDose, {}, {}, 1}},
        kAlongZ, [model = model_](Coefficients c) {
          return with_effect(with_level_gain(model, c[1]),
                             {"grad_z", {}, {{"per_mm", {c[0] / (1 + c[1])}}, {"from_mm", {0}}}});
        });
    for (int k = 2; k <= job_.layers() - 2; ++k) {
      const double at_mm = bottom_mm() + k * job_.grid.pitch_mm[2];
      add("pause", {"z", "step", {{"at_mm", {at_mm}}}},
          {{Basis::kDose, [at_mm](const Spot& s) { return s.z_mm >= at_mm ? 1.0 : 0.0; }, {}, 1}},
          kAlongZ, [model = model_, at_mm](Coefficients c) {
            return with_effect(
                model,
                {"pause", {}, {{"at_mm", {at_mm}}, {"amount", {std::clamp(c[0], -0.9, 1.9)}}}});
          });
    }
    for (const double height_mm : {0.1, 0.2, 0.4, 0.8}) {
      add("first_layers", {"z", "window", {{"from_mm", {0}}, {"to_mm", {2 * height_mm}}}},
          {{Basis::kDose,
            [height_mm](const Spot& s) { return std::exp(-s.z_mm / height_mm); },
            {},
            1}},
          kAlongZ, [model = model_, height_mm](Coefficients c) {
            return with_effect(
                model, {"first_layers",
                        {},
                        {{"amount", {std::clamp(c[0], -0.9, 4.5)}}, {"height_mm", {height_mm}}}});
          });
    }
  }

  // Two columns: the mask shifted along x and along y by of(spot).
  void add_shift(const std::string& kind, Covariate covariate, unsigned along,
                 std::function<double(const Spot&)> of,
                 std::function<EffectSpec(double, double)> effect) {
    add(kind, std::move(covariate), {{Basis::kShiftX, of, {}, 1}, {Basis::kShiftY, of, {}, 1}},
        along, [model = model_, effect](Coefficients c) {
          return with_effect(model, effect(c[0], c[1]));
        });
  }

  void add_shift_effects() {
    if (!has("shift")) {
      add_shift("empirical", {"facing", "trend", {}}, kNowhere, {}, [](double x, double y) {
        return EffectSpec{"shift", {}, {{"by_mm", {x, y}}}};
      });
    }
    add_shift(
        "registration_drift", {"z", "trend", {}}, kAlongZ, [](const Spot& s) { return s.z_mm; },
        [](double x, double y) {
          return EffectSpec{"registration_drift", {}, {{"per_mm", {x, y}}}};
        });
    for (const double height_mm : {0.2, 0.4, 0.8, 1.6}) {
      add_shift(
          "layer_shift_low", {"z", "window", {{"from_mm", {0}}, {"to_mm", {2 * height_mm}}}},
          kAlongZ, [height_mm](const Spot& s) { return std::exp(-s.z_mm / height_mm); },
          [height_mm](double x, double y) {
            return EffectSpec{
                "layer_shift_low", {}, {{"by_mm", {x, y}}, {"height_mm", {height_mm}}}};
          });
    }
    add_shift(
        "parity", {"layer", "periodic", {{"period_layers", {2}}}}, kAlongZ,
        [](const Spot& s) { return s.layer % 2 == 0 ? 1.0 : -1.0; },
        [](double x, double y) {
          return EffectSpec{"parity", {}, {{"by_mm", {x, y}}}};
        });
    if (!has("scale_xyz")) {
      const std::array<double, 2> center{job_.place.center_mm(0), job_.place.center_mm(1)};
      add("scale_xyz", {"x", "trend", {}},
          {{Basis::kShiftX, [center](const Spot& s) { return s.x_mm - center[0]; }, {}, 1},
           {Basis::kShiftY, [center](const Spot& s) { return s.y_mm - center[1]; }, {}, 1}},
          kAlongX | kAlongY, [model = model_](Coefficients c) {
            return with_effect(model, {"scale_xyz", {}, {{"by", {c[0], c[1]}}}});
          });
    }
  }

  void add_bed_effects() {
    const std::array<double, 2> center{job_.place.center_mm(0), job_.place.center_mm(1)};
    const Column x{Basis::kDose, [center](const Spot& s) { return s.x_mm - center[0]; }, {}, 1};
    const Column y{Basis::kDose, [center](const Spot& s) { return s.y_mm - center[1]; }, {}, 1};
    const Column bowl{Basis::kDose,
                      [center](const Spot& s) {
                        const double dx = s.x_mm - center[0];
                        const double dy = s.y_mm - center[1];
                        return dx * dx + dy * dy;
                      },
                      {},
                      1};
    const Column all{Basis::kDose, {}, {}, 1};
    const auto effect = [model = model_, center](double per_x, double per_y, double per2,
                                                 double gain) {
      const double g = 1 + gain;
      return with_effect(with_level_gain(model, gain), {"grad_bed",
                                                        {},
                                                        {{"per_mm", {per_x / g, per_y / g}},
                                                         {"per_mm2", {per2 / g}},
                                                         {"center_mm", {center[0], center[1]}}}});
    };
    add("grad_bed", {"x", "trend", {}}, {x, all}, kAlongX,
        [effect](Coefficients c) { return effect(c[0], 0, 0, c[1]); });
    add("grad_bed", {"y", "trend", {}}, {y, all}, kAlongY,
        [effect](Coefficients c) { return effect(0, c[0], 0, c[1]); });
    add("grad_bed", {"position", "trend", {}}, {x, y, all}, kAlongX | kAlongY,
        [effect](Coefficients c) { return effect(c[0], c[1], 0, c[2]); });
    add("grad_bed", {"position", "local", {}}, {bowl, x, y, all}, kAlongX | kAlongY,
        [effect](Coefficients c) { return effect(c[1], c[2], c[0], c[3]); });
  }

  void add_bands() {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      constexpr double kShortestMm = 0.9;
      for (const double f : frequencies(job_.place.size_mm[axis], kShortestMm)) {
        const double turn = 2 * std::numbers::pi * f;
        const auto along = [axis](const Spot& s) { return axis == 0 ? s.x_mm : s.y_mm; };
        const double period = 1 / f;
        add("band_swath", {axis == 0 ? "x" : "y", "periodic", {{"period_mm", {period}}}},
            {{Basis::kDose, [=](const Spot& s) { return std::cos(turn * along(s)); }, {}, 1},
             {Basis::kDose, [=](const Spot& s) { return std::sin(turn * along(s)); }, {}, 1}},
            axis == 0 ? kAlongX : kAlongY, [model = model_, axis, period](Coefficients c) {
              return with_effect(model, {"band_swath",
                                         {},
                                         {{"direction_deg", {axis == 0 ? 0.0 : 90.0}},
                                          {"period_mm", {period}},
                                          {"wave", {c[0], c[1]}}}});
            });
      }
    }
  }

  void add_jets() {
    const double pixel = job_.grid.pitch_mm[1];
    const double end = job_.place.origin_mm[1] + job_.place.size_mm[1];
    for (const int width_px : {2, 4, 6, 8, 11, 16, 24}) {
      const double width = width_px * pixel;
      const double step = std::max(1, width_px / 4) * pixel;
      for (double from = job_.place.origin_mm[1]; from + width <= end; from += step) {
        const double to = from + width;
        add("jet_out", {"y", "window", {{"from_mm", {from}}, {"to_mm", {to}}}},
            {{Basis::kDose,
              [from, to](const Spot& s) { return s.y_mm >= from && s.y_mm < to ? 1.0 : 0.0; },
              {},
              1}},
            kAlongY, [model = model_, from, to](Coefficients c) {
              return with_effect(model, {"jet_out",
                                         {},
                                         {{"from_mm", {from}},
                                          {"to_mm", {to}},
                                          {"amount", {std::clamp(c[0], -0.99, 1.9)}}}});
            });
      }
    }
  }

  const MeasuredJob& job_;
  const Model& model_;
  std::vector<Candidate> out_;
};

}  // namespace

Model with_effect(Model model, EffectSpec effect) {
  model.push_back(std::move(effect));
  return model;
}

Model with_level_gain(Model model, double gain) {
  for (EffectSpec& effect : model) {
    if (!effect.numbers.contains("level")) continue;
    double& level = effect.numbers["level"].front();
    level = std::clamp(level / std::max(0.2, 1 + gain), 0.02, 1.0);
  }
  return model;
}

const EffectSpec* find_effect(const Model& model, const std::string& kind) {
  for (const EffectSpec& effect : model) {
    if (effect.kind == kind) return &effect;
  }
  return nullptr;
}

std::vector<double> frequencies(double extent, double shortest) {
  std::vector<double> out;
  const double step = 1 / (3 * extent);
  for (double f = 1 / extent; f <= 1 / shortest; f += step) out.push_back(f);
  return out;
}

std::vector<Candidate> named_candidates(const MeasuredJob& job, const Model& model) {
  return Catalogue(job, model).take();
}

}  // namespace binderjet
