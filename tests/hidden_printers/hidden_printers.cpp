// SPDX-License-Identifier: GPL-3.0-or-later
// The printers of the trials.
#include <cmath>
#include <numbers>
#include <random>

#include "tests/hidden_printers/hidden_printer.h"

namespace binderjet::hidden {
namespace {

using Axis = Covariate::Axis;

constexpr double kTurn = 2 * std::numbers::pi;

Printer named(const std::string& name, const std::string& effect, std::vector<std::string> kinds,
              std::vector<Axis> axes) {
  Printer printer;
  printer.name = name;
  printer.effect = effect;
  printer.kinds = std::move(kinds);
  printer.axes = std::move(axes);
  return printer;
}

}  // namespace

std::vector<EffectSpec> declared() {
  return {{"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.3}}}},
          {"threshold", {}, {{"level", {0.5}}}}};
}

std::vector<Printer> catalogue(double s) {
  std::vector<Printer> out;
  const auto add_as = [&](const std::string& name, const std::string& effect,
                          std::vector<std::string> kinds, std::vector<Axis> axes, auto set) {
    out.push_back(named(name, effect, std::move(kinds), std::move(axes)));
    set(out.back());
  };
  // Most are named by their effect's own word.
  const auto add = [&](const std::string& effect, std::vector<Axis> axes, auto set) {
    add_as(effect, effect, {effect}, std::move(axes), set);
  };
  add("threshold", {}, [s](Printer& p) { p.level = 0.5 - 0.1 * s; });
  add_as("kernel_x", "spread", {"kernel_x"}, {},
         [s](Printer& p) { p.width_mm[0] = 0.7 + 0.3 * s; });
  add_as("kernel_y", "spread", {"kernel_y"}, {},
         [s](Printer& p) { p.width_mm[1] = 0.3 + 0.25 * s; });
  add_as("kernel_shape", "tail", {"kernel_shape"}, {}, [s](Printer& p) {
    p.tail_share = 0.3 * s;
    p.tail_mm = 0.5;
  });
  add("z_bleed_down", {}, [s](Printer& p) { p.bleed_down = 0.25 * s; });
  add("z_wick_up", {}, [s](Printer& p) { p.wick_up = 0.2 * s; });
  add("density", {Axis::kDensity}, [s](Printer& p) { p.density = 0.3 * s; });
  add("rounding", {}, [s](Printer& p) { p.wear_mm = 0.08 + 0.08 * s; });
  add("registration_drift", {}, [s](Printer& p) {
    p.shift_mm = [s](const At& at) { return std::array<double, 2>{0.04 * s * at.z, 0}; };
  });
  add("layer_shift_low", {}, [s](Printer& p) {
    p.shift_mm = [s](const At& at) {
      return std::array<double, 2>{0.25 * s * std::exp(-at.z / 0.7), 0};
    };
  });
  add("parity", {Axis::kLayer}, [s](Printer& p) {
    p.shift_mm = [s](const At& at) {
      return std::array<double, 2>{(at.layer % 2 == 0 ? 0.05 : -0.05) * s, 0};
    };
  });
  add_as("scale", "scale_xyz", {"scale_xyz"}, {}, [s](Printer& p) {
    p.shift_mm = [s](const At& at) {
      return std::array<double, 2>{0.008 * s * (at.x - 12), 0.008 * s * (at.y - 12)};
    };
  });
  add("grad_bed", {Axis::kX},
      [s](Printer& p) { p.gain = [s](const At& at) { return 1 + 0.012 * s * (at.x - 12); }; });
  add_as("bowl", "grad_bed", {"grad_bed"}, {Axis::kPosition}, [s](Printer& p) {
    p.gain = [s](const At& at) {
      return 1 - 0.0012 * s * ((at.x - 11) * (at.x - 11) + (at.y - 13) * (at.y - 13));
    };
  });
  add("grad_z", {Axis::kZ},
      [s](Printer& p) { p.gain = [s](const At& at) { return 1 - 0.06 * s * at.z; }; });
  add("pause", {Axis::kZ}, [s](Printer& p) {
    p.gain = [s](const At& at) { return at.layer >= 17 ? 1 - 0.15 * s : 1.0; };
  });
  add("band_swath", {Axis::kY}, [s](Printer& p) {
    p.gain = [s](const At& at) { return 1 + 0.12 * s * std::cos(kTurn * at.y / 5.3 + 1); };
  });
  add("jet_out", {Axis::kY}, [s](Printer& p) {
    p.drops = [s](const At& at) { return at.y > 8.1 && at.y < 8.3 ? 1 - 0.7 * s : 1.0; };
  });
  add("first_layers", {}, [s](Printer& p) {
    p.gain = [s](const At& at) { return 1 + 0.4 * s * std::exp(-at.layer / 3.0); };
  });
  add_as("fill", "fill", {"threshold"}, {}, [s](Printer& p) { p.level = 0.5 + 0.1 * s; });
  add("survive", {}, [s](Printer& p) { p.thinnest_mm = 0.5 * s; });
  add_as("shift", "shift", {}, {Axis::kFacing}, [s](Printer& p) {
    p.shift_mm = [s](const At&) { return std::array<double, 2>{0.07 * s, -0.04 * s}; };
  });
  add("jitter", {}, [s](Printer& p) {
    p.shift_mm = [s](const At& at) {
      std::mt19937 engine(static_cast<unsigned>(at.layer) * 7919U + 1);
      std::normal_distribution<double> normal(0, 0.05 * s);
      const double x = normal(engine);
      return std::array<double, 2>{x, normal(engine)};
    };
  });
  add("recoat_streak", {}, [s](Printer& p) {
    p.gain = [s](const At& at) {
      return at.x > 4.1 && at.x < 4.9 && at.layer >= 7 ? 1 - 0.4 * s : 1.0;
    };
  });
  add("first_drops", {}, [s](Printer& p) {
    p.drop_of_line = [s](double mm) { return 1 - 0.7 * s * std::exp(-mm / 0.6); };
  });
  add("slice_dropout", {}, [s](Printer& p) {
    p.layer_of = [by = s < 1 ? -1 : 1](int k) { return k >= 9 ? k + by : k; };
  });
  add("recoat_compress", {}, [s](Printer& p) {
    p.layer_of = [s](int k) { return static_cast<int>(std::floor((k + 0.5) / (1 - 0.1 * s))); };
  });
  add("infiltrant", {}, [s](Printer& p) {
    p.soak_mm = 0.2;
    p.skin_mm = 0.06 * s;
  });
  return out;
}

std::vector<Printer> nameless() {
  std::vector<Printer> out;
  out.push_back(named("diagonal bands", "empirical", {}, {Axis::kDirection}));
  out.back().gain = [](const At& at) {
    return 1 + 0.12 * std::cos(kTurn * (at.x * 0.8 + at.y * 0.6) / 4.1);
  };
  out.push_back(named("layer wave of shift", "empirical", {}, {Axis::kLayer}));
  out.back().shift_mm = [](const At& at) {
    return std::array<double, 2>{0, 0.05 * std::sin(kTurn * at.layer / 7.3)};
  };
  out.push_back(named("damp spot", "empirical", {}, {Axis::kPosition}));
  out.back().gain = [](const At& at) {
    return 1 + 0.35 * std::exp(-((at.x - 7) * (at.x - 7) + (at.y - 4) * (at.y - 4)) / 8);
  };
  out.push_back(named("half of the bed", "empirical", {}, {Axis::kX}));
  out.back().gain = [](const At& at) { return at.x > 5.3 ? 1.12 : 1.0; };
  out.push_back(named("every sixth layer", "empirical", {}, {Axis::kLayer}));
  out.back().gain = [](const At& at) { return at.layer % 6 == 2 ? 0.82 : 1.0; };
  out.push_back(named("belt wave", "empirical", {}, {Axis::kX, Axis::kY}));
  out.back().shift_mm = [](const At& at) {
    return std::array<double, 2>{0.05 * std::sin(kTurn * at.y / 6.7), 0};
  };
  return out;
}

std::vector<Printer> pairs() {
  std::vector<Printer> out;
  out.push_back(named("bleed + bands", "", {"z_bleed_down", "band_swath"}, {}));
  out.back().bleed_down = 0.2;
  out.back().gain = [](const At& at) { return 1 + 0.1 * std::cos(kTurn * at.y / 5.3); };
  out.push_back(named("gradient + parity", "", {"grad_bed", "parity"}, {}));
  out.back().gain = [](const At& at) { return 1 + 0.012 * (at.x - 12); };
  out.back().shift_mm = [](const At& at) {
    return std::array<double, 2>{at.layer % 2 == 0 ? 0.04 : -0.04, 0};
  };
  out.push_back(named("threshold + drift", "", {"threshold", "registration_drift"}, {}));
  out.back().level = 0.43;
  out.back().shift_mm = [](const At& at) { return std::array<double, 2>{0, 0.03 * at.z}; };
  return out;
}

}  // namespace binderjet::hidden
