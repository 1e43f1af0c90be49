// SPDX-License-Identifier: GPL-3.0-or-later
// What a pixel adds to the dose.
#include "slicer/enhance/inverse/search/stamps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "slicer/model/printer_model.h"
#include "tests/support/random.h"
#include "tests/support/rows.h"

namespace binderjet {
namespace {

using whole::Random;

constexpr int kUnit = 8192;
const Grid kGrid{{0.1, 0.1, 0.1}, {2, 2, 2}};

// The dose of a column and row, counted from the pixel's voxel; 0 beside the stamp.
int dose_at(const Stamp& stamp, int x, int y) {
  const int i = x - stamp.first[0];
  const int j = y - stamp.first[1];
  if (i < 0 || j < 0 || i >= stamp.width || j >= stamp.height) return 0;
  return stamp.dose[static_cast<std::size_t>(j * stamp.width + i)];
}

std::vector<int> row_of(const Stamp& stamp, int y, int x0, int x1) {
  std::vector<int> out;
  for (int x = x0; x < x1; ++x) out.push_back(dose_at(stamp, x, y));
  return out;
}

TEST(Stamps, WithoutSpreadAreThePixel) {
  Stamps stamps(std::vector{DoseTerm{}}, 0, kGrid, kUnit);
  const Stamp& pixel = stamps.pixel({0, 2 * kFine, 0});
  EXPECT_EQ(row_of(pixel, 0, -2, 4), (std::vector<int>{0, 0, kUnit, kUnit, 0, 0}));
  EXPECT_EQ(row_of(pixel, 1, -2, 4), (std::vector<int>{0, 0, kUnit, kUnit, 0, 0}));
  EXPECT_EQ(row_of(pixel, 2, -2, 4), (std::vector<int>{0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(pixel.width % 8, 0) << "whole vectors";
}

// Weights 1 2 1 over two voxels: 1 3 3 1 quarters; from there on without an end: 1 3 4 4.
TEST(Stamps, AreTheKernelOverThePixelsVoxels) {
  const std::vector terms{DoseTerm{0, {-1, {1, 2, 1}}, {0, {1}}, 1}};
  Stamps stamps(terms, 0, kGrid, kUnit);
  EXPECT_EQ(row_of(stamps.pixel({0, 2 * kFine, 0}), 0, -2, 4),
            (std::vector<int>{0, kUnit / 4, 3 * kUnit / 4, 3 * kUnit / 4, kUnit / 4, 0}));
  EXPECT_EQ(row_of(stamps.half_line(0, 0), 1, -2, 2),
            (std::vector<int>{0, kUnit / 4, 3 * kUnit / 4, kUnit}));
}

// 5/16 voxels beyond along x and 1/4 along y.
TEST(Stamps, LandBetweenVoxels) {
  Stamps stamps(std::vector{DoseTerm{}}, 0, kGrid, kUnit);
  const Stamp& pixel = stamps.pixel({5, 2 * kFine, 4});
  EXPECT_EQ(row_of(pixel, 1, 0, 4), (std::vector<int>{kUnit * 11 / 16, kUnit, kUnit * 5 / 16, 0}));
  EXPECT_EQ(dose_at(pixel, 1, 0), kUnit * 3 / 4);
  EXPECT_EQ(dose_at(pixel, 1, 2), kUnit / 4);
  EXPECT_EQ(dose_at(pixel, 1, 3), 0);
}

TEST(Stamps, TakeTheTermsOfTheirLayerOnly) {
  const std::vector terms{DoseTerm{0, {}, {}, 0.75}, DoseTerm{1, {}, {}, 0.25}};
  EXPECT_EQ(dose_at(Stamps(terms, 0, kGrid, kUnit).pixel({0, 32, 0}), 0, 0), kUnit * 3 / 4);
  EXPECT_EQ(dose_at(Stamps(terms, 1, kGrid, kUnit).pixel({0, 32, 0}), 0, 0), kUnit / 4);
}

std::vector<DoseTerm> own_terms(const PrinterModel& model) {
  std::vector<DoseTerm> terms;
  for (DoseTerm term : model.form().terms) {
    term.layer = 0;
    terms.push_back(term);
  }
  return terms;
}

TEST(Stamps, HoldAllOfThePixelsBinder) {
  Random random;
  for (int round = 0; round < 50; ++round) {
    const Grid grid = random.grid();
    const auto terms = own_terms(random.model(grid, Random::Kernels::kAny));
    double gain = 0;
    for (const DoseTerm& term : terms) gain += term.gain;
    const int width = grid.detail_vx[0] * kFine + random.number(-8, 8);
    Stamps stamps(terms, 0, grid, kUnit / 4);
    const Stamp& pixel = stamps.pixel({random.number(0, 15), width, random.number(0, 15)});
    const double sum = std::accumulate(pixel.dose.begin(), pixel.dose.end(), 0.0);
    // Each end of each row is rounded; errors within a row of voxels cancel but for its ends.
    ASSERT_NEAR(sum, gain * kUnit / 4 * width / kFine * grid.detail_vx[1],
                static_cast<double>(pixel.width) * pixel.height);
  }
}

// However the pixels of a row are shifted and stretched, no unit is lost between them.
TEST(Stamps, OfARowAddUpToTheRow) {
  Random random;
  for (int round = 0; round < 50; ++round) {
    SCOPED_TRACE(round);
    const Grid grid = random.grid();
    Stamps stamps(own_terms(random.model(grid, Random::Kernels::kAny)), 0, grid, kUnit / 4);
    const int part_y = random.number(0, 15);
    std::vector<int> sides{random.number(-20, 20)};  // in 1/kFine voxels
    for (int i = random.number(1, 5); i > 0; --i) {
      sides.push_back(sides.back() + grid.detail_vx[0] * kFine + random.number(-5, 5));
    }
    const auto half_line = [&](int side, int x, int y) {
      const auto [whole, part] = split_fine(side);
      const Stamp& line = stamps.half_line(part, part_y);
      return dose_at(line, std::min(x - whole, line.first[0] + line.width - 1), y);
    };
    for (int y = -12; y < 12; ++y) {
      for (int x = -20; x < 40; ++x) {
        int sum = 0;
        for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
          const auto [whole, part] = split_fine(sides[i]);
          sum += dose_at(stamps.pixel({part, sides[i + 1] - sides[i], part_y}), x - whole, y);
        }
        ASSERT_EQ(sum, half_line(sides.front(), x, y) - half_line(sides.back(), x, y))
            << x << ", " << y;
      }
    }
  }
}

TEST(Stamps, AreWhatThePrinterModelBindsOfOnePixel) {
  Random random;
  for (int round = 0; round < 50; ++round) {
    SCOPED_TRACE(round);
    const Grid grid = random.grid();
    AssembledModel form = random.model(grid, Random::Kernels::kAny).form();
    for (DoseTerm& term : form.terms) term.layer = 0;
    form.wear.clear();
    form.level = random.number(1, 20) / 64.0;
    Stamps stamps(form.terms, 0, grid, kUnit / 4);
    const auto [rx, ry, rz] = grid.detail_vx;
    const Stamp& pixel = stamps.pixel({0, rx * kFine, 0});
    const RunLayer printed =
        PrinterModel(form, grid).print(window(rows_of(1, {{0, 1}}), -9, -9, 19, 19));
    for (int y = 0; y < printed.height(); ++y) {
      for (int x = 0; x < printed.width(); ++x) {
        const double over = dose_at(pixel, x - 9 * rx, y - 9 * ry) - form.level * kUnit / 4;
        if (std::abs(over) > 1) {
          ASSERT_EQ(printed.at(x, y), over > 0) << x << ", " << y;
        }
      }
    }
  }
}

}  // namespace
}  // namespace binderjet
