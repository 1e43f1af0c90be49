// SPDX-License-Identifier: GPL-3.0-or-later
// Calibration on hidden printers, small and few; all of them: binderjet_calibrate_trials.
#include "slicer/calibrate/calibrate.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/calibrate/hidden_printer.h"

namespace binderjet {
namespace {

using hidden::Printer;

const std::vector<EffectSpec> kDeclared = {
    {"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.3}}}},
    {"threshold", {}, {{"level", {0.5}}}}};

Printer printer_named(const std::vector<Printer>& printers, const std::string& name) {
  return *std::find_if(printers.begin(), printers.end(),
                       [&](const Printer& printer) { return printer.name == name; });
}

Calibration calibrated(const Printer& printer) {
  MeasuredJob a = hidden::part("a", {9, 9, 1.7}, 0);
  hidden::print(printer, a, 1);
  hidden::print(printer, a, 2);
  MeasuredJob b = hidden::part("b", {8, 9, 1.5}, 1);
  hidden::print(printer, b, 3);
  return calibrate(a, {b}, kDeclared, {}, [](const std::string&) {});
}

TEST(Calibrate, ClaimsNothingOfAPrinterThatIsAsDeclared) {
  Printer nothing;
  const Calibration found = calibrated(nothing);
  EXPECT_EQ(found.verdict, "none");
  EXPECT_TRUE(found.effects.empty());
  EXPECT_EQ(found.scores[0].before.wrong, found.scores[0].after.wrong);
}

TEST(Calibrate, NamesBleedingDownAndPredictsAPartThatItNeverSaw) {
  const Calibration found = calibrated(printer_named(hidden::catalogue(1), "z_bleed_down"));
  ASSERT_EQ(found.effects.size(), 1U);
  EXPECT_EQ(found.effects[0].kind, "z_bleed_down");
  // The hidden share is 0.25; nothing else differs, so what is left is noise.
  EXPECT_NEAR(found.effects[0].parameters.at("share")[0], 0.25, 0.03);
  EXPECT_LT(found.scores[0].after.wrong, 0.3 * found.scores[0].before.wrong);
}

TEST(Calibrate, SaysOnWhatAnEffectWithoutANameDepends) {
  const Calibration found = calibrated(printer_named(hidden::nameless(), "layer wave of shift"));
  ASSERT_FALSE(found.effects.empty());
  EXPECT_EQ(found.verdict, "unexplained");
  EXPECT_EQ(found.effects[0].kind, "empirical");
  EXPECT_EQ(found.effects[0].covariate.axis, "layer");
  EXPECT_EQ(found.effects[0].covariate.form, "periodic");
  EXPECT_NEAR(found.effects[0].covariate.numbers.at("period_layers")[0], 7.3, 0.3);
  EXPECT_LT(found.scores[0].after.wrong, 0.6 * found.scores[0].before.wrong);
}

// One block: its side walls do not say why it grew (notes: "only flat up and down faces and
// overhangs separate them").
TEST(Calibrate, NamesTheRivalsThatStraightWallsCannotTellApart) {
  Printer printer;
  printer.level = 0.4;
  MeasuredJob block = hidden::part("block", {8, 8, 1.7}, 0);
  const int width = block.masks.front()->width();
  RunLayer mask(width);
  for (int y = 0; y < block.masks.front()->height(); ++y) {
    const bool inside = y >= 25 && y < block.masks.front()->height() - 25;
    mask.append_row(inside ? std::vector{15, width - 15} : std::vector<int>{});
  }
  for (Shared<RunLayer>& layer : block.masks) layer = std::make_shared<const RunLayer>(mask);
  hidden::print(printer, block, 1);
  hidden::print(printer, block, 2);
  const Calibration found = calibrate(block, {}, kDeclared, {}, [](const std::string&) {});
  ASSERT_EQ(found.effects.size(), 1U);
  EXPECT_EQ(found.effects[0].kind, "threshold");
  const std::vector<std::string>& rivals = found.effects[0].rivals;
  EXPECT_FALSE(rivals.empty()) << "on straight side walls they look alike";
  EXPECT_NE(std::find(rivals.begin(), rivals.end(), "z_wick_up"), rivals.end())
      << testing::PrintToString(rivals);
}

TEST(Calibrate, FindsALostLayerThatNoRegressionSees) {
  // A pyramid, so that every layer is another.
  MeasuredJob a = hidden::part("a", {9, 9, 1.7}, 0);
  const int width = a.masks.front()->width();
  const int height = a.masks.front()->height();
  for (int k = 0; k < a.layers(); ++k) {
    RunLayer mask(width);
    for (int y = 0; y < height; ++y) {
      const bool inside = y >= 16 + 3 * k && y < height - 16 - 3 * k;
      mask.append_row(inside ? std::vector{12 + 2 * k, width - 12 - 2 * k} : std::vector<int>{});
    }
    a.masks[static_cast<std::size_t>(k)] = std::make_shared<const RunLayer>(std::move(mask));
  }
  hidden::print({}, a, 1);
  // From layer 7 on each layer is printed as the next.
  std::vector<Shared<RunLayer>>& print = a.prints.front();
  for (std::size_t k = 7; k + 1 < print.size(); ++k) print[k] = print[k + 1];
  print.back() = std::make_shared<const RunLayer>(
      RunLayer::powder(print.back()->width(), print.back()->height()));
  const Calibration found = calibrate(a, {}, kDeclared, {}, [](const std::string&) {});
  ASSERT_EQ(found.effects.size(), 1U);
  EXPECT_EQ(found.effects[0].kind, "slice_dropout");
  EXPECT_EQ(found.effects[0].parameters.at("layers")[0], 1);
  EXPECT_NEAR(found.effects[0].parameters.at("at_mm")[0], 7 * 0.102, 1e-9);
  // A height compressed by a layer from its middle on prints the same.
  EXPECT_EQ(found.effects[0].rivals, std::vector<std::string>{"recoat_compress"});
}

TEST(Calibrate, GivesTheSameTwice) {
  const Printer printer = printer_named(hidden::catalogue(1), "parity");
  const Calibration one = calibrated(printer);
  const Calibration two = calibrated(printer);
  ASSERT_EQ(one.effects.size(), two.effects.size());
  for (std::size_t i = 0; i < one.effects.size(); ++i) {
    EXPECT_EQ(one.effects[i].parameters, two.effects[i].parameters);
  }
}

}  // namespace
}  // namespace binderjet
