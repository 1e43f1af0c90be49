// SPDX-License-Identifier: GPL-3.0-or-later
// What every printer model has in common, whatever its effects.
#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

// A mask with room for binder and for a shift around it.
Volume random_mask(Random& random) { return random.volume(40, 40, 1, 14); }

RunLayer print(const PrinterModel& model, const Volume& mask) {
  return model.print(whole::slice(mask, 0));
}

TEST(PrinterModel, PrintsMoreWhereTheMaskIsMore) {
  Random random;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    const Grid grid = random.grid();
    const PrinterModel model = random.model(grid, Random::Kernels::kAny);
    const Volume less = random_mask(random);
    Volume more = random_mask(random);
    more.fill([&](int x, int y, int z) { return more.at(x, y, z) + less.at(x, y, z) > 0; });
    const RunLayer little = print(model, less);
    const RunLayer much = print(model, more);
    for (int y = 0; y < little.height(); ++y) {
      for (int x = 0; x < little.width(); ++x) {
        ASSERT_LE(little.at(x, y), much.at(x, y)) << x << ", " << y;
      }
    }
  }
}

TEST(PrinterModel, PrintsTheMirrorImageOfAMirroredMask) {
  Random random;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    const Grid grid = random.grid();
    const PrinterModel model = random.model(grid, Random::Kernels::kSymmetric);
    const Volume mask = random_mask(random);
    const bool in_x = random.chance(0.5);
    Volume mirrored = mask;
    mirrored.fill([&](int x, int y, int z) {
      return mask.at(in_x ? mask.nx - 1 - x : x, in_x ? y : mask.ny - 1 - y, z) == 1;
    });
    const RunLayer one = print(model, mask);
    const RunLayer other = print(model, mirrored);
    for (int y = 0; y < one.height(); ++y) {
      for (int x = 0; x < one.width(); ++x) {
        ASSERT_EQ(one.at(x, y),
                  other.at(in_x ? one.width() - 1 - x : x, in_x ? y : one.height() - 1 - y));
      }
    }
  }
}

TEST(PrinterModel, PrintsTheSameWhereverThePixelsAre) {
  Random random;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    const Grid grid = random.grid();
    const PrinterModel model = random.model(grid, Random::Kernels::kAny);
    // Farther than any of these models reaches, and no farther than the margin.
    const std::array<int, 2> by{random.number(-6, 6), random.number(-6, 6)};
    Volume mask = random.volume(60, 60, 1, 26);
    Volume moved = mask;
    moved.fill([&](int x, int y, int z) { return mask.at(x - by[0], y - by[1], z) == 1; });
    const RunLayer one = print(model, mask);
    const RunLayer other = print(model, moved);
    const int dx = by[0] * grid.detail_vx[0];
    const int dy = by[1] * grid.detail_vx[1];
    ASSERT_EQ(window(other, dx, dy, one.width(), one.height()), one);
  }
}

}  // namespace
}  // namespace binderjet
