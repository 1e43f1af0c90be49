// SPDX-License-Identifier: GPL-3.0-or-later
// Effects that depend on the place on the bed, by hand and against the probe's real numbers.
#include <gtest/gtest.h>

#include "slicer/base/error.h"
#include "slicer/calibrate/residual/dose_probe.h"
#include "slicer/model/dose/density_field.h"
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/printer_model.h"
#include "tests/support/examples.h"
#include "tests/support/random.h"
#include "tests/support/rows.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

// Voxels of 0.1 mm; a pixel is one voxel.
const Grid kPlacedGrid{{0.1, 0.1, 0.1}, {1, 1, 1}};
const EffectSpec kSpread{"spread", {{"shape", "box"}}, {{"width_mm", {0.5, 0.3}}}};
const EffectSpec kThreshold{"threshold", {}, {{"level", {0.5}}}};

// A bar along y from x = 15 to 25 in 40 x 20 pixels.
RunLayer bar() {
  RunLayer layer(40);
  for (int y = 0; y < 20; ++y) layer.append_row(std::vector<int>{15, 25});
  return layer;
}
PrinterModel model(const EffectSpec& effect, const JobPlace& place = {{0, 0}, {4, 2}}) {
  return {{kSpread, kThreshold, effect}, kPlacedGrid, place};
}
std::vector<int> printed(const EffectSpec& effect, int layer = 0) {
  const PrinterModel printer = model(effect);
  const RunLayer mask = bar();
  const RunWindow window = RunWindow::around(
      printer.window_reach(), [&](int offset) { return offset == 0 ? &mask : nullptr; });
  return middle_row(printer.print(window, layer));
}

TEST(PlacedEffects, ShiftsTheMaskByWholeAndHalfVoxels) {
  EXPECT_EQ(printed({"shift", {}, {{"by_mm", {0.3, 0}}}}), (std::vector<int>{18, 28}));
  // Half a voxel: at both edges the dose of the voxel under the edge is exactly 1/2.
  EXPECT_EQ(printed({"shift", {}, {{"by_mm", {0.05, 0}}}}), (std::vector<int>{15, 26}));
}

TEST(PlacedEffects, ShiftsEvenAndOddLayersApart) {
  const EffectSpec parity{"parity", {}, {{"by_mm", {0.2, 0}}}};
  EXPECT_EQ(printed(parity, 4), (std::vector<int>{17, 27}));
  EXPECT_EQ(printed(parity, 5), (std::vector<int>{13, 23}));
}

TEST(PlacedEffects, ShiftsWhatBleedsDownLikeTheLayerThatItComesFrom) {
  const PrinterModel printer(
      {kThreshold, {"z_bleed_down", {}, {{"share", {0.6}}}}, {"parity", {}, {{"by_mm", {0.2, 0}}}}},
      kPlacedGrid);
  const RunLayer mask = bar();
  const RunLayer powder = RunLayer::powder(mask.width(), mask.height());
  const RunWindow window = RunWindow::around(
      printer.window_reach(), [&](int offset) { return offset == 1 ? &mask : &powder; });
  EXPECT_EQ(middle_row(printer.print(window, 4)), (std::vector<int>{13, 23})) << "from layer 5";
  EXPECT_EQ(middle_row(printer.print(window, 5)), (std::vector<int>{17, 27})) << "from layer 6";
}

TEST(PlacedEffects, DriftsWithHeight) {
  // The middle of layer 9 is at 0.95 mm: 0.2 mm of shift there, up to rounding to 1/16 voxel.
  const EffectSpec drift{"registration_drift", {}, {{"per_mm", {0.2 / 0.95, 0}}}};
  EXPECT_EQ(printed(drift, 9), (std::vector<int>{17, 27}));
}

TEST(PlacedEffects, TellsTheBedsAxesApart) {
  // Level 1/2 needs a dose of 1/2 / gain: 3/5 stand under the bar's edges, 2/5 beside them.
  const JobPlace place{{0, 50}, {4, 2}};
  const RunLayer along_y =
      model({"grad_bed", {}, {{"per_mm", {0, 0.4}}, {"per_mm2", {0}}, {"center_mm", {2, 51}}}},
            place)
          .print(bar());
  const auto row = [](const RunLayer& layer, int y) {
    return std::vector<int>(layer.row(y).begin(), layer.row(y).end());
  };
  EXPECT_EQ(row(along_y, 2), (std::vector<int>{16, 24})) << "a gain of 0.7";
  EXPECT_EQ(row(along_y, 10), (std::vector<int>{15, 25})) << "1.02";
  EXPECT_EQ(row(along_y, 17), (std::vector<int>{14, 26})) << "1.3";
  const RunLayer along_x =
      model({"grad_bed", {}, {{"per_mm", {0.4, 0}}, {"per_mm2", {0}}, {"center_mm", {2, 51}}}},
            place)
          .print(bar());
  EXPECT_EQ(row(along_x, 2), row(along_x, 17));
  EXPECT_EQ(row(along_x, 2), (std::vector<int>{16, 25}))
      << "0.82 at the left edge, 1.2 at the right";
}

TEST(PlacedEffects, WeakensTheDoseFromALayerOn) {
  // At 3/5 of the dose the level 1/2 needs 5/6 of the box: the edges draw back.
  const EffectSpec pause{"pause", {}, {{"at_mm", {1}}, {"amount", {-0.4}}}};
  EXPECT_EQ(printed(pause, 9), (std::vector<int>{15, 25}));
  EXPECT_EQ(printed(pause, 10), (std::vector<int>{17, 23}));
}

TEST(PlacedEffects, LosesARowWhoseJetIsOut) {
  const RunLayer mask = bar();
  const PrinterModel printer =
      model({"jet_out", {}, {{"from_mm", {0.9}}, {"to_mm", {1.1}}, {"amount", {-0.9}}}});
  const RunLayer out = printer.print(mask);
  EXPECT_EQ(out.row(8).size(), 2U);
  EXPECT_TRUE(out.row(9).empty());
  EXPECT_TRUE(out.row(10).empty());
  EXPECT_EQ(out.row(11).size(), 2U);
}

TEST(PlacedEffects, WeakensRowsAroundAJetByTheBinderThatTheyWouldGetFromIt) {
  RunLayer without(40);
  for (int y = 0; y < 20; ++y) {
    without.append_row(y == 10 ? std::vector<int>{} : std::vector<int>{15, 25});
  }
  const PrinterModel plain({kSpread, kThreshold}, kPlacedGrid, {{0, 0}, {4, 2}});
  const PrinterModel out =
      model({"jet_out", {}, {{"from_mm", {1.0}}, {"to_mm", {1.1}}, {"amount", {-1}}}});
  EXPECT_EQ(out.print(bar()), plain.print(without));
  // Half of a jet's row, whatever the grid: half as much is missing in all.
  const auto missing = [](double to_mm) {
    const PrinterModel printer =
        model({"jet_out", {}, {{"from_mm", {1.0}}, {"to_mm", {to_mm}}, {"amount", {-1}}}});
    double sum = 0;
    for (int y = 0; y < 20; ++y) {
      sum += 1 - printer.form().placed.gain_at(Spot{.y_mm = (y + 0.5) * 0.1});
    }
    return sum;
  };
  const double whole = missing(1.1);
  const double half = missing(1.05);
  EXPECT_NEAR(whole, 1, 1e-9);
  EXPECT_NEAR(half, 0.5, 1e-9);
}

TEST(PlacedEffects, PulsesInOneOfSoManyLayers) {
  const EffectSpec pulse{"empirical",
                         {{"acts", "dose"}, {"axis", "layer"}, {"form", "pulse"}},
                         {{"amount", {-0.4}}, {"period", {7}}, {"at", {3}}, {"width", {1}}}};
  for (int layer = 0; layer < 30; ++layer) {
    const bool weak = layer % 7 == 3;
    EXPECT_EQ(printed(pulse, layer), weak ? (std::vector<int>{17, 23}) : (std::vector<int>{15, 25}))
        << "layer " << layer;
  }
}

TEST(PlacedEffects, KnowsWhereTheJobIsOnTheBed) {
  const EffectSpec gradient{
      "grad_bed", {}, {{"per_mm", {0.05, 0}}, {"per_mm2", {0}}, {"center_mm", {100, 100}}}};
  const RunLayer mask = bar();
  const auto count = [&](double x_mm) {
    return model(gradient, {{x_mm, 100}, {4, 2}}).print(mask).count();
  };
  EXPECT_LT(count(94), count(98));
  EXPECT_LT(count(98), count(104));
}

TEST(PlacedEffects, BindsFlatFieldsWhereTheGainLiftsThemOverTheLevel) {
  // A wide field at a dose of 0.45 everywhere; the gain passes 1/0.9 in the middle of the bed only.
  AssembledModel form;
  form.level = 0.5;
  form.terms.front().gain = 0.45;
  form.placed.gains.push_back(
      {[](const Spot& s) { return s.x_mm > 1 && s.x_mm < 2 ? 0.2 : 0.0; }, 0.2});
  const PrinterModel printer(form, kPlacedGrid);
  RunLayer mask(40);
  for (int y = 0; y < 5; ++y) mask.append_row(std::vector<int>{0, 40});
  EXPECT_EQ(middle_row(printer.print(mask)), (std::vector<int>{10, 20}));
}

TEST(PlacedEffects, CountsTheSolidShareOfABox) {
  const RunLayer mask = bar();
  const RunWindow window{nullptr, &mask, &mask};
  // A box far wider than the layer: 200 solid pixels in two of three layers.
  const DensityField field(window, kPlacedGrid, 10);
  const double side = 2 * 25 * 4 - 4;  // whole cells around the middle one
  EXPECT_NEAR(field.at(20, 10), 2 * 200 / (3 * side * side), 1e-3);
}

TEST(PlacedEffects, RefusesTwoRadiiOfDensity) {
  const auto density = [](double radius) {
    return EffectSpec{
        "density", {}, {{"strength", {0.1}}, {"radius_mm", {radius}}, {"reference", {0.5}}}};
  };
  EXPECT_THROW(PrinterModel({kThreshold, density(1), density(2)}, kPlacedGrid), Error);
}

// The streamed engine on runs and integers against the probe's plain sums of real numbers.
TEST(PlacedEffects, PrintWhatTheProbeSays) {
  Random random;
  for (const EffectSpec& effect : whole::examples_beside_a_level()) {
    SCOPED_TRACE(effect.kind);
    const Grid grid{{0.1, 0.08, 0.1}, {2, 2, 2}};
    const int layers = 6;
    const Volume mask = random.volume(30, 24, layers, 4);
    std::vector<RunLayer> masks;
    for (int k = 0; k < layers; ++k) masks.push_back(whole::slice(mask, k));
    const JobPlace place{{3, 5}, {3, 1.92}};
    const PrinterModel printer({kSpread, kThreshold, effect}, grid, place);
    if (!printer.form().wear.empty()) continue;  // the probe knows of the dose alone
    const DoseProbe probe(printer.form(), grid, place);
    for (int k = 0; k < layers; ++k) {
      const RunWindow window = runs_around(masks, k, printer.window_reach());
      const RunLayer out = printer.print(window, k);
      std::vector<DosePlace> places;
      for (int y = 0; y < out.height(); ++y) {
        for (int x = 0; x < out.width(); ++x) {
          places.push_back({static_cast<double>(x), static_cast<double>(y)});
        }
      }
      std::vector<double> margins(places.size());
      probe.margins(window, k, places, margins);
      for (std::size_t i = 0; i < places.size(); ++i) {
        // Flips are placed to 1/32 of a voxel, which is 1/32 of a voxel's share of the kernel.
        constexpr double kRounding = 0.03;
        if (std::abs(margins[i]) < kRounding) continue;
        ASSERT_EQ(out.at(static_cast<int>(places[i].x_vx), static_cast<int>(places[i].y_vx)),
                  margins[i] > 0)
            << k << ": " << places[i].x_vx << ", " << places[i].y_vx << " margin " << margins[i];
      }
    }
  }
}

}  // namespace
}  // namespace binderjet
