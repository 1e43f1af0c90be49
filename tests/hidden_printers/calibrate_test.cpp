// SPDX-License-Identifier: GPL-3.0-or-later
// Calibration on hidden printers, small and few; all of them: binderjet_calibrate_trials.
#include "slicer/calibrate/calibrate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <set>

#include "slicer/calibrate/residual/surface.h"
#include "slicer/layers/rows.h"
#include "tests/hidden_printers/hidden_printer.h"

namespace binderjet {
namespace {

using hidden::Printer;

Printer printer_named(const std::vector<Printer>& printers, const std::string& name) {
  return *std::find_if(printers.begin(), printers.end(),
                       [&](const Printer& printer) { return printer.name == name; });
}

Calibration calibrated(const Printer& printer, std::array<double, 3> size_mm = {7, 7, 1.7}) {
  MeasuredJob a = hidden::part("a", size_mm, 0);
  hidden::print(printer, a, 1);
  hidden::print(printer, a, 2);
  MeasuredJob b = hidden::part("b", {6, 7, 1.5}, 1);
  hidden::print(printer, b, 3);
  return calibrate(a, {b}, hidden::declared(), {});
}

TEST(Calibrate, ClaimsNothingOfAPrinterThatIsAsDeclared) {
  Printer nothing;
  const Calibration found = calibrated(nothing);
  EXPECT_EQ(found.verdict, Verdict::kNone);
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
  EXPECT_EQ(found.verdict, Verdict::kUnexplained);
  EXPECT_EQ(found.effects[0].kind, "empirical");
  EXPECT_FALSE(found.effects[0].named);
  EXPECT_EQ(found.effects[0].covariate.axis, Covariate::Axis::kLayer);
  EXPECT_EQ(found.effects[0].covariate.form, Covariate::Form::kPeriodic);
  EXPECT_NEAR(found.effects[0].covariate.numbers.at("period_layers")[0], 7.3, 0.3);
  EXPECT_LT(found.scores[0].after.wrong, 0.6 * found.scores[0].before.wrong);
}

// Voxels that are not the same in two prints of a job.
std::int64_t difference(const std::vector<Shared<RunLayer>>& a,
                        const std::vector<Shared<RunLayer>>& b) {
  std::int64_t count = 0;
  std::vector<int> row;
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (int y = 0; y < a[k]->height(); ++y) {
      rows::difference(a[k]->row(y), b[k]->row(y), row);
      for (std::size_t i = 0; i < row.size(); i += 2) count += row[i + 1] - row[i];
    }
  }
  return count;
}

// How far a level of 0.4 and a fourth of the binder wicking up at a level of 0.5 are apart. Below a
// straight wall there is as much binder as in it, and 0.5 / (1 + 1/4) is 0.4.
std::int64_t level_against_wicking(const MeasuredJob& job) {
  std::vector<EffectSpec> level = hidden::declared();
  level[1].numbers["level"] = {0.4};
  std::vector<EffectSpec> wicking = hidden::declared();
  wicking.push_back({"z_wick_up", {}, {{"share", {0.25}}}});
  const LayerChoice all(job.masks.size(), true);
  return difference(print_layers(job, level, all), print_layers(job, wicking, all));
}

// One block: its side walls do not say why it grew (notes: "only flat up and down faces and
// overhangs separate them").
TEST(Calibrate, NamesTheRivalsThatStraightWallsCannotTellApart) {
  Printer printer;
  printer.level = 0.4;
  MeasuredJob block = hidden::part("block", {6, 6, 1.7}, 0);
  const int width = block.masks.front()->width();
  RunLayer mask(width);
  for (int y = 0; y < block.masks.front()->height(); ++y) {
    const bool inside = y >= 25 && y < block.masks.front()->height() - 25;
    mask.append_row(inside ? std::vector{15, width - 15} : std::vector<int>{});
  }
  for (Shared<RunLayer>& layer : block.masks) layer = std::make_shared<const RunLayer>(mask);
  hidden::print(printer, block, 1);
  hidden::print(printer, block, 2);
  ASSERT_LT(level_against_wicking(block), difference(block.prints[0], block.prints[1]))
      << "the two must be closer than two prints";

  const Calibration found = calibrate(block, {}, hidden::declared(), {});
  ASSERT_EQ(found.effects.size(), 1U);
  std::vector<std::string> named = found.effects[0].rivals;
  named.push_back(found.effects[0].kind);
  EXPECT_THAT(named, testing::IsSupersetOf({"threshold", "z_wick_up"}));

  // Stairs would tell them apart: on each step there is binder below the edge.
  MeasuredJob stairs = hidden::part("stairs", {8, 8, 1.7}, 0);
  const int height = stairs.masks.front()->height();
  for (int k = 0; k < stairs.layers(); ++k) {
    RunLayer step(stairs.masks.front()->width());
    const int in = 6 * (k / 3);
    for (int y = 0; y < height; ++y) {
      const bool inside = y >= 20 + in && y < height - 20 - in;
      step.append_row(inside ? std::vector{12 + in, step.width() - 12 - in} : std::vector<int>{});
    }
    stairs.masks[static_cast<std::size_t>(k)] = std::make_shared<const RunLayer>(std::move(step));
  }
  hidden::print(printer, stairs, 1);
  hidden::print(printer, stairs, 2);
  EXPECT_GT(level_against_wicking(stairs), difference(stairs.prints[0], stairs.prints[1]));
}

FoundEffect found_effect(bool named) {
  FoundEffect effect;
  effect.named = named;
  return effect;
}

TEST(Calibrate, SaysUnexplainedWhereNothingHasANameOrPrintsAgreeAgainstTheModel) {
  EXPECT_EQ(verdict_of({}, false), Verdict::kNone);
  EXPECT_EQ(verdict_of({}, true), Verdict::kUnexplained);
  EXPECT_EQ(verdict_of({found_effect(false)}, false), Verdict::kUnexplained);
  EXPECT_EQ(verdict_of({found_effect(false), found_effect(true)}, true), Verdict::kEffect);

  BeforeAfter score;
  score.after.wrong = 0.02;
  EXPECT_FALSE(far_above_floor(score, false)) << "one print has no floor";
  score.floor = PrintError{0.013, 0, 0, 0};
  EXPECT_TRUE(far_above_floor(score, false));
  EXPECT_FALSE(far_above_floor(score, true)) << "that may be the scanner's blur";
  score.floor->wrong = 0.014;
  EXPECT_FALSE(far_above_floor(score, false));
  score.floor->wrong = 0.006;
  EXPECT_TRUE(far_above_floor(score, true));
}

// Pits strewn over a print, the same for the same seed: no covariate tells where they are.
void strew_pits(std::vector<Shared<RunLayer>>& print, unsigned seed) {
  constexpr int kSize = 3;
  constexpr int kSpacing = 24;  // in voxels; a layer has one in every such square
  std::mt19937 engine(seed);
  for (Shared<RunLayer>& layer : print) {
    std::set<std::pair<int, int>> corners;  // y, x
    for (int y = 0; y + kSpacing <= layer->height(); y += kSpacing) {
      for (int x = 0; x + kSpacing <= layer->width(); x += kSpacing) {
        const auto offset = [&] { return static_cast<int>(engine() % (kSpacing - kSize)); };
        const int down = offset();
        corners.insert({y + down, x + offset()});
      }
    }
    RunLayer pitted(layer->width());
    for (int y = 0; y < layer->height(); ++y) {
      std::vector<int> pits;
      for (const auto& [top, left] : corners) {
        if (y < top || y >= top + kSize) continue;
        pits.push_back(left);
        pits.push_back(left + kSize);
      }
      std::sort(pits.begin(), pits.end());
      std::vector<int> row;
      rows::subtract(layer->row(y), pits, row);
      pitted.append_row(row);
    }
    layer = std::make_shared<const RunLayer>(std::move(pitted));
  }
}

TEST(Calibrate, LeavesUnexplainedWhatTwoPrintsShareAndNoCovariateTells) {
  MeasuredJob a = hidden::part("a", {6, 6, 1.7}, 0);
  hidden::print({}, a, 1);
  hidden::print({}, a, 2);
  for (auto& print : a.prints) strew_pits(print, 1);
  const Calibration found = calibrate(a, {}, hidden::declared(), {});
  EXPECT_TRUE(found.effects.empty()) << found.effects.front().kind;
  EXPECT_EQ(found.verdict, Verdict::kUnexplained);
}

// A pyramid whose steps are `step_of` a layer; from layer 7 on each layer is printed as the next.
Calibration calibrated_without_layer_7(const std::function<int(int)>& step_of) {
  MeasuredJob a = hidden::part("a", {7, 7, 1.7}, 0);
  const int width = a.masks.front()->width();
  const int height = a.masks.front()->height();
  for (int k = 0; k < a.layers(); ++k) {
    const int step = step_of(k);
    RunLayer mask(width);
    for (int y = 0; y < height; ++y) {
      const bool inside = y >= 16 + 2 * step && y < height - 16 - 2 * step;
      mask.append_row(inside ? std::vector{12 + step, width - 12 - step} : std::vector<int>{});
    }
    a.masks[static_cast<std::size_t>(k)] = std::make_shared<const RunLayer>(std::move(mask));
  }
  hidden::print({}, a, 1);
  std::vector<Shared<RunLayer>>& print = a.prints.front();
  for (std::size_t k = 7; k + 1 < print.size(); ++k) print[k] = print[k + 1];
  print.back() = std::make_shared<const RunLayer>(
      RunLayer::powder(print.back()->width(), print.back()->height()));
  return calibrate(a, {}, hidden::declared(), {});
}

TEST(Calibrate, FindsALostLayerThatNoRegressionSees) {
  const Calibration found = calibrated_without_layer_7([](int k) { return k; });
  ASSERT_EQ(found.effects.size(), 1U);
  EXPECT_EQ(found.effects[0].kind, "slice_dropout");
  EXPECT_EQ(found.effects[0].parameters.at("layers")[0], 1);
  EXPECT_NEAR(found.effects[0].parameters.at("at_mm")[0], 7 * 0.102, 1e-9);
  // A height compressed by a layer from its middle on prints the same.
  EXPECT_EQ(found.effects[0].rivals, std::vector<std::string>{"recoat_compress"});
}

TEST(Calibrate, TakesTheMiddleOfTheLayersThatMayBeTheLostOne) {
  // Layers 5 to 13 are alike, so any of them may be missing.
  const Calibration found = calibrated_without_layer_7([](int k) {
    return k < 5 ? k : k <= 13 ? 5 : k - 8;
  });
  ASSERT_EQ(found.effects.size(), 1U);
  EXPECT_EQ(found.effects[0].kind, "slice_dropout");
  // The layers next to them may be held out, which moves the middle by half a layer each.
  EXPECT_NEAR(found.effects[0].parameters.at("at_mm")[0], 9 * 0.102, 0.102 + 1e-9);
}

TEST(Calibrate, NamesJitterWhereLayersAreShiftedByChance) {
  constexpr double kSigmaMm = 0.04;
  for (const unsigned seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal(0, kSigmaMm);
    std::vector<std::array<double, 2>> shifts(25);
    for (std::array<double, 2>& shift : shifts) shift = {normal(engine), normal(engine)};
    Printer printer;
    printer.shift_mm = [&](const hidden::At& at) {
      return shifts.at(static_cast<std::size_t>(at.layer));
    };
    MeasuredJob a = hidden::part("a", {7, 7, 2.5}, 0);
    hidden::print(printer, a, 1);
    const Calibration found = calibrate(a, {}, hidden::declared(), {});
    ASSERT_EQ(found.effects.size(), 1U);
    EXPECT_EQ(found.effects[0].kind, "jitter");
    for (const double sigma : found.effects[0].parameters.at("sigma_mm")) {
      EXPECT_NEAR(sigma, kSigmaMm, 0.015);
    }
  }
}

TEST(Calibrate, GivesTheSameTwice) {
  const Printer printer = printer_named(hidden::catalogue(1), "parity");
  const std::array<double, 3> small{5, 5, 1.3};
  const Calibration one = calibrated(printer, small);
  const Calibration two = calibrated(printer, small);
  ASSERT_FALSE(one.effects.empty());
  ASSERT_EQ(one.effects.size(), two.effects.size());
  for (std::size_t i = 0; i < one.effects.size(); ++i) {
    EXPECT_EQ(one.effects[i].parameters, two.effects[i].parameters);
  }
}

}  // namespace
}  // namespace binderjet
