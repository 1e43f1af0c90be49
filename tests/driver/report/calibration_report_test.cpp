// SPDX-License-Identifier: GPL-3.0-or-later
// The report says what was found, whole and in itself, whatever names files have.
#include "driver/report/calibration_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "driver/export/layer_pictures.h"
#include "slicer/model/printer_model.h"
#include "tests/support/markup.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<EffectSpec> model(double level) {
  return {{"spread", {{"shape", "box"}}, {{"width_mm", {0.4, 0.4}}}},
          {"threshold", {}, {{"level", {level}}}}};
}

// A block of 20 x 12 pixels in three layers, printed by a model of another level than declared.
MeasuredJob job_printed_at(double level) {
  MeasuredJob job;
  job.name = "a<b>&\"c\".bjob";
  job.grid = {{0.1, 0.1, 0.1}, {2, 2, 2}};
  job.place = {{0, 0}, {4, 3}};
  const PrinterModel printer(model(level), job.grid, job.place);
  job.prints.resize(2);
  for (int k = 0; k < 3; ++k) {
    RunLayer mask(40);
    for (int y = 0; y < 30; ++y) {
      mask.append_row(y >= 8 && y < 20 + k ? std::vector{10, 30} : std::vector<int>{});
    }
    job.masks.push_back(std::make_shared<const RunLayer>(mask));
    for (auto& print : job.prints) {
      print.push_back(std::make_shared<const RunLayer>(printer.print(mask)));
    }
  }
  return job;
}

Calibration found() {
  Calibration calibration;
  calibration.verdict = Verdict::kEffect;
  FoundEffect effect;
  effect.kind = "threshold";
  effect.parameters["level"] = {0.3, 0.01};
  effect.rivals = {"bleed_shell"};
  effect.p = 0.0004;
  effect.heldout_gain = 0.91;
  calibration.effects.push_back(effect);
  calibration.remaining =
      Remaining{{Covariate::Axis::kY, Covariate::Form::kPeriodic, {{"period_mm", {11.8}}}}, 0.07};
  calibration.scores.push_back({"second print",
                                {0.031, 0.02, 0.04, 0.1},
                                {0.012, 0.01, 0.02, 0.1},
                                PrintError{0.01, 0.009, 0.02, 0.1}});
  calibration.profiles.push_back(
      {"edge_distance", "mm", {0, 1, 2}, {0.1, 0.1, 0.09}, {0.01, 0, 0}, {9, 9, 9}});
  calibration.before_model = model(0.5);
  calibration.after_model = model(0.3);
  return calibration;
}

std::string report(const Calibration& calibration, const MeasuredJob& job) {
  return calibration_report(calibration, job, "Calibration <1>");
}

TEST(CalibrationReport, IsWellFormedAndFetchesNothing) {
  const std::string page = report(found(), job_printed_at(0.3));
  EXPECT_EQ(markup_fault(page), "");
  EXPECT_THAT(page, HasSubstr("a&lt;b&gt;&amp;&quot;c&quot;.bjob"));
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,iVBOR"));
}

TEST(CalibrationReport, SaysVerdictErrorsRivalsAndWhatRemains) {
  const std::string page = report(found(), job_printed_at(0.3));
  EXPECT_THAT(page, HasSubstr("The declared model lacks one effect: threshold or bleed shell (this "
                              "print cannot tell)."));
  EXPECT_THAT(page, HasSubstr("wrong voxels fall from 3.10 % to 1.20 %; two prints of the same job "
                              "differ by 1.00 %"));
  EXPECT_THAT(page, HasSubstr("bleed shell"));
  EXPECT_THAT(page, HasSubstr("&lt; 0.001"));
  EXPECT_THAT(page, HasSubstr("7 % of what is left follows y, periodic (period_mm 11.8)"));
  EXPECT_THAT(page, HasSubstr("threshold: level 0.3"));
}

TEST(CalibrationReport, ClaimsNothingWhereNothingWasFound) {
  Calibration none = found();
  none.verdict = Verdict::kNone;
  none.effects.clear();
  none.remaining.reset();
  none.after_model = none.before_model;
  none.scores.front().after = none.scores.front().before;
  const std::string page = report(none, job_printed_at(0.5));
  EXPECT_EQ(markup_fault(page), "");
  EXPECT_THAT(page, HasSubstr("The print is what the declared model says"));
  EXPECT_THAT(page, Not(HasSubstr("lacks")));
}

TEST(LayerPictures, ShowTheLayerThatGainsMost) {
  const MeasuredJob job = job_printed_at(0.3);
  const LayerPictures pictures = picture_layer(job, model(0.5), model(0.3));
  EXPECT_EQ(pictures.layer, 2) << "the largest of three that are wrong along their edges";
  EXPECT_GT(pictures.wrong_before, 0.05);
  EXPECT_EQ(pictures.wrong_after, 0);
  EXPECT_NE(pictures.before, pictures.after);
}

// The look itself must be able to fail.
TEST(Markup, IsLookedAtStrictly) {
  EXPECT_EQ(markup_fault("<p>a &amp; b</p>"), "");
  EXPECT_NE(markup_fault("<p>a & b</p>"), "");
  EXPECT_NE(markup_fault("<p><b></p></b>"), "");
  EXPECT_NE(markup_fault("<p>"), "");
  EXPECT_NE(markup_fault("<img src=\"x.png\"/>"), "");
}

}  // namespace
}  // namespace binderjet
