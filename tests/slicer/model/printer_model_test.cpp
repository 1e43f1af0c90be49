// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/printer_model.h"

#include <gtest/gtest.h>

#include "slicer/base/error.h"
#include "tests/support/rows.h"

namespace binderjet {
namespace {

// Voxels of 0.1 mm; a pixel is one voxel.
const Grid kWholePixels{{0.1, 0.1, 0.1}, {1, 1, 1}};

EffectSpec spread(const std::string& shape, double x_mm, double y_mm) {
  return {"spread", {{"shape", shape}}, {{"width_mm", {x_mm, y_mm}}}};
}
EffectSpec level(const std::string& kind, double at) { return {kind, {}, {{"level", {at}}}}; }
EffectSpec survive(double x_mm, double y_mm) {
  return {"survive", {}, {{"width_mm", {x_mm, y_mm}}}};
}

// Bars that run along y over the whole layer, from x to x + width.
RunLayer bars(const std::vector<int>& flips) {
  RunLayer layer(60);
  for (int y = 0; y < 30; ++y) layer.append_row(flips);
  return layer;
}

TEST(PrinterModelForm, FillsANarrowSlotAndKeepsAThinWallAtALowLevel) {
  // A slot of 2 in a block, and a wall of 2; the box is 5 wide.
  const PrinterModel model({spread("box", 0.5, 0.1), level("fill", 0.25)}, kWholePixels);
  const auto row = middle_row(model.print(bars({5, 15, 17, 30, 40, 42})));
  // Blocks grow by (1/2 - 1/4) of 5 = 1.25 voxels on each side, of which whole ones count; the
  // wall's dose is 2/5.
  EXPECT_EQ(row, (std::vector<int>{4, 31, 39, 43}));
}

TEST(PrinterModelForm, BrushesOffWhatIsTooThinToSurvive) {
  // The same, and nothing thinner than 0.5 mm in x survives: the slot is filled *and* the wall is
  // gone, which no single level gives.
  const PrinterModel model({spread("box", 0.5, 0.1), level("fill", 0.25), survive(0.5, 0.1)},
                           kWholePixels);
  EXPECT_EQ(middle_row(model.print(bars({5, 15, 17, 30, 40, 42}))), (std::vector<int>{4, 31}));
}

TEST(PrinterModelForm, KeepsWhatIsJustAsWideAsItMustBeToSurvive) {
  const PrinterModel model({level("fill", 0.5), survive(0.3, 0.1)}, kWholePixels);
  EXPECT_EQ(middle_row(model.print(bars({5, 8, 20, 22}))), (std::vector<int>{5, 8}));
}

TEST(PrinterModelForm, MovesNoStraightEdgeWithAGaussianAtHalf) {
  const PrinterModel model({spread("gaussian", 0.7, 0.3), level("threshold", 0.5)}, kWholePixels);
  // The cut tails take 2^-12 of the dose, the same inside and outside.
  EXPECT_EQ(middle_row(model.print(bars({15, 45}))), (std::vector<int>{15, 45}));
}

TEST(PrinterModelForm, FillsMoreWithAGaussianThanWithABoxAsWide) {
  // At 1/2 a slot stays open if more than half of the kernel fits into it: half the width of a box,
  // but 0.573 of the width of a gaussian (1.349 sigma of 2.355), which has tails.
  const auto open = [](const std::string& shape, int slot) {
    const PrinterModel model({spread(shape, 1.1, 0.1), level("threshold", 0.5)}, kWholePixels);
    return middle_row(model.print(bars({5, 30, 30 + slot, 55}))).size() == 4;
  };
  EXPECT_FALSE(open("box", 5));
  EXPECT_TRUE(open("box", 6));
  EXPECT_FALSE(open("gaussian", 6));
  EXPECT_TRUE(open("gaussian", 7));
}

TEST(PrinterModelForm, BindsTheLayerBelowThroughATermThatReachesThere) {
  // Half of a layer's binder seeps one layer down, as a calibration may find.
  AssembledModel form;
  form.level = 0.5;
  form.terms.push_back({1, {}, {}, 0.5});
  const PrinterModel model(form, kWholePixels);
  EXPECT_EQ(model.reach().layers_above, 1);
  EXPECT_EQ(model.reach().layers_below, 0);
  EXPECT_EQ(model.window_reach(), 1);
  const RunLayer low = bars({10, 20});
  const RunLayer high = bars({15, 25});
  const RunWindow window{nullptr, &low, &high};
  EXPECT_EQ(middle_row(model.print(window)), (std::vector<int>{10, 25}));
  EXPECT_EQ(model.print(low), low);
}

TEST(PrinterModelForm, AddsUpWhatItsEffectsReach) {
  const PrinterModel model({spread("box", 0.7, 0.3), level("fill", 0.5), survive(0.2, 0.4)},
                           kWholePixels);
  EXPECT_EQ(model.reach().xy_vx, (std::array<int, 2>{3 + 1, 1 + 3}));
}

TEST(PrinterModelForm, RefusesTwoLevelsAndNone) {
  EXPECT_THROW(PrinterModel({level("fill", 0.5), level("threshold", 0.5)}, kWholePixels), Error);
  EXPECT_THROW(PrinterModel({spread("box", 0.7, 0.3)}, kWholePixels), Error);
}

TEST(DoseFilter, AgreesWithTheBoxFilterOnABox) {
  const BoxWeights x = box_weights(5.3);
  const BoxWeights y = box_weights(2.6);
  const DoseTerm term{0, box_kernel(x), box_kernel(y), 1};
  RunLayer mask(30);
  for (int row = 0; row < 12; ++row) mask.append_row(std::vector<int>{row, 2 * row + 3});
  const RunWindow window{&mask};
  for (const double at : {0.1, 0.25, 0.5, 0.9, 1.0}) {
    EXPECT_EQ(DoseFilter({&term, 1}, at, {{0.2, 0.3, 0.1}, {2, 3, 1}})(window),
              box_threshold(mask, {2, 3}, x, y, min_sum(x, y, at)));
  }
}

}  // namespace
}  // namespace binderjet
