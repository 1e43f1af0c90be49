// SPDX-License-Identifier: GPL-3.0-or-later
// Effects of the catalogue that change how much binder a voxel gets, and from which layers.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "slicer/calibrate/candidates/candidate_list.h"

namespace binderjet {
namespace {

using Basis = Column::Basis;
using Coefficients = std::span<const double>;

std::size_t level_place(const EffectList& model) {
  const auto found = std::find_if(model.begin(), model.end(), [](const EffectSpec& effect) {
    return effect.numbers.contains("level");
  });
  return static_cast<std::size_t>(found - model.begin());
}

void add_dose_effects(CandidateList& list) {
  list.add("threshold", {"facing", "", {}}, {{Basis::kLevel, {}, {}, 1}}, kNowhere,
           [model = list.model()](Coefficients c) {
             EffectList out = model;
             for (EffectSpec& effect : out) {
               if (!effect.numbers.contains("level")) continue;
               double& level = effect.numbers["level"].front();
               level = std::clamp(level - c[0], 0.02, 1.0);
             }
             return out;
           });
  list.last().effect = level_place(list.model());
  for (const double radius_mm : {0.75, 1.1, 1.5, 2.0, 2.5, 3.2, 4.0}) {
    if (list.has("density")) break;
    const auto effect = [radius_mm](double strength) {
      return EffectSpec{
          "density",
          {},
          {{"strength", {strength}}, {"radius_mm", {radius_mm}}, {"reference", {0.5}}}};
    };
    Column column{Basis::kModel, {}, with_effect(list.model(), effect(0.05)), 0.05};
    list.add("density", {"density", "trend", {}}, {column, {Basis::kDose, {}, {}, 1}}, kNowhere,
             [model = list.model(), effect](Coefficients c) {
               return with_effect(with_level_gain(model, c[1]), effect(c[0]));
             });
  }
}

void add_kernel_effects(CandidateList& list) {
  const EffectSpec* spread = find_effect(list.model(), "spread");
  if (spread == nullptr) return;
  const auto place = static_cast<std::size_t>(spread - list.model().data());
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto widened = [model = list.model(), place, axis](Coefficients c) {
      EffectList out = model;
      double& width = out[place].numbers["width_mm"][axis];
      width *= std::clamp(1 + c[0], 0.2, 4.0);
      return out;
    };
    constexpr double kStep = 0.05;
    list.add(axis == 0 ? "kernel_x" : "kernel_y", {axis == 0 ? "x" : "y", "local", {}},
             {{Basis::kModel, {}, widened(std::array{kStep}), kStep}}, kNowhere, widened);
    list.last().effect = place;
  }
  if (spread->words.at("shape") == "box") {
    const auto gaussian = [model = list.model(), place](Coefficients) {
      // The gaussian with the box's second moment.
      const double same_moment = 2 * std::sqrt(2 * std::log(2.0)) / std::sqrt(12.0);
      EffectList out = model;
      out[place].words["shape"] = "gaussian";
      for (double& width : out[place].numbers["width_mm"]) width *= same_moment;
      return out;
    };
    list.add("kernel_shape", {"x", "local", {}}, {{Basis::kModel, {}, gaussian({}), 1}}, kNowhere,
             gaussian);
    list.last().effect = place;
  }
  for (const double width_mm : {0.6, 1.0, 1.6}) {
    if (list.has("tail")) break;
    list.add_from_zero(
        "kernel_shape", {"x", "local", {}}, 0.05,
        [width_mm](double share) {
          return EffectSpec{"tail", {}, {{"share", {share}}, {"width_mm", {width_mm, width_mm}}}};
        },
        0.01, 0.8);
  }
}

void add_layer_effects(CandidateList& list) {
  for (const char* kind : {"z_bleed_down", "z_wick_up"}) {
    if (list.has(kind)) continue;
    list.add_from_zero(
        kind, {"z", "trend", {}}, 0.1,
        [kind](double share) {
          return EffectSpec{kind, {}, {{"share", {share}}}};
        },
        0.01, 0.85);
  }
  list.add("grad_z", {"z", "trend", {}},
           {{Basis::kDose, [](const Spot& s) { return s.z_mm; }, {}, 1}, {Basis::kDose, {}, {}, 1}},
           kAlongZ, [model = list.model()](Coefficients c) {
             return with_effect(
                 with_level_gain(model, c[1]),
                 {"grad_z", {}, {{"per_mm", {c[0] / (1 + c[1])}}, {"from_mm", {0}}}});
           });
  for (int k = 2; k <= list.job().layers() - 2; ++k) {
    const double at_mm = list.bottom_mm() + k * list.job().grid.pitch_mm[2];
    list.add(
        "pause", {"z", "step", {{"at_mm", {at_mm}}}},
        {{Basis::kDose, [at_mm](const Spot& s) { return s.z_mm >= at_mm ? 1.0 : 0.0; }, {}, 1}},
        kAlongZ, [model = list.model(), at_mm](Coefficients c) {
          return with_effect(
              model,
              {"pause", {}, {{"at_mm", {at_mm}}, {"amount", {std::clamp(c[0], -0.9, 1.9)}}}});
        });
  }
  for (const double height_mm : {0.1, 0.2, 0.4, 0.8}) {
    list.add("first_layers", {"z", "window", {{"from_mm", {0}}, {"to_mm", {2 * height_mm}}}},
             {{Basis::kDose,
               [height_mm](const Spot& s) { return std::exp(-s.z_mm / height_mm); },
               {},
               1}},
             kAlongZ, [model = list.model(), height_mm](Coefficients c) {
               return with_effect(model, {"first_layers",
                                          {},
                                          {{"amount", {std::clamp(c[0], -0.9, 4.5)}},
                                           {"height_mm", {height_mm}}}});
             });
  }
}

void add_first_drops(CandidateList& list) {
  if (list.has("first_drops")) return;
  for (const char* after : {"line", "gap"}) {
    for (const double length_mm : {0.2, 0.5, 1.2, 3.0}) {
      list.add_from_zero(
          "first_drops", {"x", "local", {}}, 0.1,
          [after, length_mm](double amount) {
            return EffectSpec{"first_drops",
                              {{"after", after}},
                              {{"amount", {amount}}, {"length_mm", {length_mm}}}};
          },
          0.02, 1);
    }
  }
}

}  // namespace

void add_dose_candidates(CandidateList& list) {
  add_dose_effects(list);
  add_kernel_effects(list);
  add_layer_effects(list);
  add_first_drops(list);
}

}  // namespace binderjet
