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
