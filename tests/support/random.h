// SPDX-License-Identifier: GPL-3.0-or-later
// Random volumes and printer models for properties; every test prints the seed that repeats it.
#pragma once

#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "slicer/model/printer_model.h"
#include "tests/support/volume.h"

namespace binderjet::whole {

class Random {
 public:
  // A new seed each time, or that of BINDERJET_SEED.
  Random() {
    const char* given = std::getenv("BINDERJET_SEED");
    const auto seed =
        given != nullptr ? static_cast<unsigned>(std::stoul(given)) : std::random_device{}();
    std::cout << "BINDERJET_SEED=" << seed << '\n';
    engine_.seed(seed);
  }
  // From `low` to `high`, both included.
  int number(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool chance(double p) { return std::bernoulli_distribution(p)(engine_); }

  Grid grid() {
    // Voxels of 1/8 mm, so that widths in mm are exact in voxels.
    const std::array<int, 3> r{number(1, 3), number(1, 3), number(1, 3)};
    return {{r[0] / 8.0, r[1] / 8.0, r[2] / 8.0}, r};
  }

  // Voxel noise, or boxes put in and taken out, in `margin` voxels of powder in x and y.
  Volume volume(int nx, int ny, int nz, int margin = 0) {
    Volume v(nx, ny, nz);
    if (nx <= 2 * margin || ny <= 2 * margin) return v;
    if (chance(0.4)) {
      const double density = number(1, 9) / 10.0;
      v.fill([&](int x, int y, int) {
        return x >= margin && y >= margin && x < nx - margin && y < ny - margin && chance(density);
      });
      return v;
    }
    for (int boxes = number(1, 6); boxes > 0; --boxes) {
      const auto [x0, x1] = range(margin, nx - margin);
      const auto [y0, y1] = range(margin, ny - margin);
      const auto [z0, z1] = range(0, nz);
      const bool solid = chance(0.7);
      for (int z = z0; z < z1; ++z)
        for (int y = y0; y < y1; ++y)
          for (int x = x0; x < x1; ++x) v.set(x, y, z, solid);
    }
    return v;
  }

  // What kernels a model may have.
  enum class Kernels { kSymmetric, kAny };

  PrinterModel model(const Grid& grid, Kernels kernels) {
    const int kind = number(0, kernels == Kernels::kAny ? 4 : 2);
    std::vector<EffectSpec> effects;
    const auto mm = [&](int most) { return number(1, most) / 64.0; };
    if (kind > 0) {
      effects.push_back({"spread",
                         {{"shape", kind == 1 ? "gaussian" : "box"}},
                         {{"width_mm", {mm(40), mm(30)}}}});
    }
    effects.push_back(
        {chance(0.5) ? "fill" : "threshold", {}, {{"level", {number(1, 15) / 16.0}}}});
    if (chance(0.4)) effects.push_back({"survive", {}, {{"width_mm", {mm(30), mm(30)}}}});
    PrinterModel model(effects, grid);
    if (kind < 3) return model;
    AssembledModel form = model.form();
    form.terms.clear();
    for (int terms = number(1, 3); terms > 0; --terms) {
      form.terms.push_back({number(-2, 2), kernel(), kernel(), number(1, 8) / 8.0});
    }
    return {form, grid};
  }

 private:
  std::pair<int, int> range(int low, int high) {
    const int a = number(low, high);
    const int b = number(low, high);
    return std::minmax(a, b);
  }
  // Lopsided weights that add up to 64, so that doses are exact in binary.
  Kernel kernel() {
    Kernel kernel{number(-3, 1), {}};
    std::int64_t rest = 64;
    for (int count = number(1, 5); count > 1; --count) {
      kernel.weights.push_back(number(0, static_cast<int>(rest)));
      rest -= kernel.weights.back();
    }
    kernel.weights.push_back(rest);
    return kernel;
  }

  std::mt19937 engine_;
};

}  // namespace binderjet::whole
