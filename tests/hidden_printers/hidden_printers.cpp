// SPDX-License-Identifier: GPL-3.0-or-later
// The printers of the trials.
#include <cmath>
#include <numbers>

#include "tests/hidden_printers/hidden_printer.h"

namespace binderjet::hidden {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Printer named(const std::string& name, std::vector<std::string> kinds,
              std::vector<std::string> axes) {
  Printer printer;
  printer.name = name;
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
  const auto add = [&](const std::string& name, std::vector<std::string> kinds,
                       std::vector<std::string> axes, auto set) {
    out.push_back(named(name, std::move(kinds), std::move(axes)));
    set(out.back());
  };
  add("threshold", {"threshold"}, {}, [s](Printer& p) { p.level = 0.5 - 0.1 * s; });
  add("kernel_x", {"kernel_x"}, {}, [s](Printer& p) { p.width_mm[0] = 0.7 + 0.3 * s; });
  add("kernel_y", {"kernel_y"}, {}, [s](Printer& p) { p.width_mm[1] = 0.3 + 0.25 * s; });
  add("kernel_shape", {"kernel_shape"}, {}, [s](Printer& p) {
    p.tail_share = 0.3 * s;
    p.tail_mm = 0.5;
  });
  add("z_bleed_down", {"z_bleed_down"}, {}, [s](Printer& p) { p.bleed_down = 0.25 * s; });
  add("z_wick_up", {"z_wick_up"}, {}, [s](Printer& p) { p.wick_up = 0.2 * s; });
  add("density", {"density"}, {"density"}, [s](Printer& p) { p.density = 0.3 * s; });
  add("rounding", {"rounding"}, {}, [s](Printer& p) { p.wear_mm = 0.08 + 0.08 * s; });
  add("registration_drift", {"registration_drift"}, {}, [s](Printer& p) {
    p.shift_mm = [s](const At& at) { return std::array<double, 2>{0.04 * s * at.z, 0}; };
  });
  add("layer_shift_low", {"layer_shift_low"}, {}, [s](Printer& p) {
    p.shift_mm = [s](const At& at) {
      return std::array<double, 2>{0.25 * s * std::exp(-at.z / 0.7), 0};
    };
  });
  add("parity", {"parity"}, {"layer"}, [s](Printer& p) {
    p.shift_mm = [s](const At& at) {
      return std::array<double, 2>{(at.layer % 2 == 0 ? 0.05 : -0.05) * s, 0};
    };
  });
  add("scale", {"scale_xyz"}, {}, [s](Printer& p) {
    p.shift_mm = [s](const At& at) {
      return std::array<double, 2>{0.008 * s * (at.x - 12), 0.008 * s * (at.y - 12)};
    };
  });
  add("grad_bed", {"grad_bed"}, {"x"},
      [s](Printer& p) { p.gain = [s](const At& at) { return 1 + 0.012 * s * (at.x - 12); }; });
  add("bowl", {"grad_bed"}, {"position"}, [s](Printer& p) {
    p.gain = [s](const At& at) {
      return 1 - 0.0012 * s * ((at.x - 11) * (at.x - 11) + (at.y - 13) * (at.y - 13));
    };
  });
  add("grad_z", {"grad_z"}, {"z"},
      [s](Printer& p) { p.gain = [s](const At& at) { return 1 - 0.06 * s * at.z; }; });
  add("pause", {"pause"}, {"z"}, [s](Printer& p) {
    p.gain = [s](const At& at) { return at.layer >= 17 ? 1 - 0.15 * s : 1.0; };
  });
  add("band_swath", {"band_swath"}, {"y"}, [s](Printer& p) {
    p.gain = [s](const At& at) { return 1 + 0.12 * s * std::cos(kTurn * at.y / 5.3 + 1); };
  });
  add("jet_out", {"jet_out"}, {"y"}, [s](Printer& p) {
    p.drops = [s](const At& at) { return at.y > 8.1 && at.y < 8.3 ? 1 - 0.7 * s : 1.0; };
  });
  add("first_layers", {"first_layers"}, {}, [s](Printer& p) {
    p.gain = [s](const At& at) { return 1 + 0.4 * s * std::exp(-at.layer / 3.0); };
  });
  return out;
}

std::vector<Printer> nameless() {
  std::vector<Printer> out;
  out.push_back(named("diagonal bands", {}, {"direction"}));
  out.back().gain = [](const At& at) {
    return 1 + 0.12 * std::cos(kTurn * (at.x * 0.8 + at.y * 0.6) / 4.1);
  };
  out.push_back(named("layer wave of shift", {}, {"layer"}));
  out.back().shift_mm = [](const At& at) {
    return std::array<double, 2>{0, 0.05 * std::sin(kTurn * at.layer / 7.3)};
  };
  out.push_back(named("damp spot", {}, {"position"}));
  out.back().gain = [](const At& at) {
    return 1 + 0.35 * std::exp(-((at.x - 7) * (at.x - 7) + (at.y - 4) * (at.y - 4)) / 8);
  };
  out.push_back(named("half of the bed", {}, {"x"}));
  out.back().gain = [](const At& at) { return at.x > 5.3 ? 1.12 : 1.0; };
  out.push_back(named("every sixth layer", {}, {"layer"}));
  out.back().gain = [](const At& at) { return at.layer % 6 == 2 ? 0.82 : 1.0; };
  out.push_back(named("belt wave", {}, {"x", "y"}));
  out.back().shift_mm = [](const At& at) {
    return std::array<double, 2>{0.05 * std::sin(kTurn * at.y / 6.7), 0};
  };
  return out;
}

std::vector<Printer> pairs() {
  std::vector<Printer> out;
  out.push_back(named("bleed + bands", {"z_bleed_down", "band_swath"}, {}));
  out.back().bleed_down = 0.2;
  out.back().gain = [](const At& at) { return 1 + 0.1 * std::cos(kTurn * at.y / 5.3); };
  out.push_back(named("gradient + parity", {"grad_bed", "parity"}, {}));
  out.back().gain = [](const At& at) { return 1 + 0.012 * (at.x - 12); };
  out.back().shift_mm = [](const At& at) {
    return std::array<double, 2>{at.layer % 2 == 0 ? 0.04 : -0.04, 0};
  };
  out.push_back(named("threshold + drift", {"threshold", "registration_drift"}, {}));
  out.back().level = 0.43;
  out.back().shift_mm = [](const At& at) { return std::array<double, 2>{0, 0.03 * at.z}; };
  return out;
}

}  // namespace binderjet::hidden
