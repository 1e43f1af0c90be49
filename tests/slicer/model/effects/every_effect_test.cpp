// SPDX-License-Identifier: GPL-3.0-or-later
// What every kind of effect in the catalogue must do, whichever it is: a new one is tested here by
// being in the catalogue.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "slicer/layers/stream.h"
#include "slicer/model/effects/candidates.h"
#include "slicer/model/print_masks.h"
#include "tests/hidden_printers/hidden_printer.h"
#include "tests/support/examples.h"
#include "tests/support/random.h"
#include "tests/support/whole_print.h"

namespace binderjet {
namespace {

using whole::kExampleGrid;
using whole::kExamplePlace;
using whole::Random;
using whole::Volume;
using whole::WholePrint;

TEST(EveryEffect, HasExamplesThatAProfileMayHold) {
  for (const EffectKind& kind : effect_kinds()) {
    SCOPED_TRACE(kind.name);
    EXPECT_EQ(find_effect_kind(kind.name), &kind) << "two kinds have this name";
    EXPECT_FALSE(kind.examples.empty());
    for (const EffectSpec& example : kind.examples) {
      EXPECT_EQ(example.kind, kind.name);
      EXPECT_EQ(check_effect(example).what, "");
    }
  }
}

TEST(EveryEffect, HasAnExampleOfEachOfItsWords) {
  for (const EffectKind& kind : effect_kinds()) {
    for (const WordRule& rule : kind.words) {
      // The free form has far more pairs of words than examples; the forms of one word are alike.
      if (kind.nameless) continue;
      for (const std::string& allowed : rule.allowed) {
        EXPECT_TRUE(std::any_of(
            kind.examples.begin(), kind.examples.end(),
            [&](const EffectSpec& example) { return example.words.at(rule.name) == allowed; }))
            << kind.name << ": " << rule.name << " = " << allowed;
      }
    }
  }
}

Volume random_mask(Random& random) { return random.volume(30, 24, 6, 4); }

// The print as a stream, from windows no larger than the model asks for.
Volume streamed(const PrinterModel& model, const Volume& mask, int block) {
  const Pipeline<RunLayer> masks("masks", {0, mask.nz}, whole::layer_stream(mask));
  const auto print = print_masks(masks, std::make_shared<const PrinterModel>(model)).all_layers();
  std::vector<Shared<RunLayer>> out;
  while (print->rest().size() > 0) {
    for (const Shared<RunLayer>& layer : print->next(block)) out.push_back(layer);
  }
  return whole::stacked(out);
}

// The same of the whole volume, in plain loops (whole_print.h).
WholePrint whole_print(const EffectSpec& example, const PrinterModel& model, const Volume& mask) {
  WholePrint print = whole::bound(mask, model.form(), kExampleGrid, kExamplePlace);
  const std::optional<WholePrint> worn = whole::worn(print.voxels, example, kExampleGrid);
  EXPECT_EQ(worn.has_value(), !model.form().wear.empty()) << "whole_print.h lacks this wear";
  return worn ? *worn : print;
}

TEST(EveryEffect, IsStreamedAsTheWholeVolumeIsPrinted) {
  Random random;
  for (const EffectKind& kind : effect_kinds()) {
    for (const EffectSpec& example : kind.examples) {
      SCOPED_TRACE(kind.name);
      const PrinterModel model(whole::model_with_example(example), kExampleGrid, kExamplePlace);
      for (int round = 0; round < 3; ++round) {
        const Volume mask = random_mask(random);
        const Volume print = streamed(model, mask, random.number(1, 4));
        const WholePrint expected = whole_print(example, model, mask);
        int unsure = 0;
        for (int z = 0; z < print.nz; ++z) {
          for (int y = 0; y < print.ny; ++y) {
            for (int x = 0; x < print.nx; ++x) {
              unsure += expected.unsure.at(x, y, z);
              if (expected.unsure.at(x, y, z) == 1) continue;
              ASSERT_EQ(print.at(x, y, z), expected.voxels.at(x, y, z))
                  << x << ", " << y << ", layer " << z;
            }
          }
        }
        EXPECT_LT(unsure, print.nx * print.ny * print.nz / 20) << "the comparison is worth nothing";
      }
    }
  }
}

TEST(EveryEffect, ShowsInThePrintOfItsExampleOrIsRandom) {
  Random random;
  for (const EffectKind& kind : effect_kinds()) {
    for (const EffectSpec& example : kind.examples) {
      SCOPED_TRACE(kind.name);
      const PrinterModel with(whole::model_with_example(example), kExampleGrid, kExamplePlace);
      const PrinterModel without({{"spread", {{"shape", "box"}}, {{"width_mm", {0.5, 0.3}}}},
                                  {"threshold", {}, {{"level", {0.5}}}}},
                                 kExampleGrid, kExamplePlace);
      bool shows = false;
      // Not every random part has an edge where the effect acts.
      for (int round = 0; round < 60 && !shows; ++round) {
        const Volume mask = random_mask(random);
        shows = streamed(with, mask, 3) != streamed(without, mask, 3);
      }
      EXPECT_EQ(shows, kind.random_layers == nullptr);
    }
  }
}

TEST(EveryEffect, IsSoughtByCalibrateOrSaysWhyNot) {
  for (const EffectKind& kind : effect_kinds()) {
    SCOPED_TRACE(kind.name);
    const bool sought = kind.add_candidates != nullptr || kind.add_trials != nullptr ||
                        kind.random_layers != nullptr;
    EXPECT_NE(sought, !kind.not_sought.empty());
  }
}

// Large enough for whatever repeats over the bed.
const JobExtent kJob{kExampleGrid, {{3, 5}, {24, 18}}, 0, 20};

// The kinds that become part of a model by a candidate or a trial.
std::set<std::string> offered(const EffectList& model) {
  std::set<std::string> kinds;
  for (const Candidate& candidate : all_candidates(kJob, model)) {
    const std::vector<double> coefficients(candidate.columns.size(), 0.1);
    const EffectList with = candidate.apply(coefficients);
    if (!with.empty()) kinds.insert(with.at(candidate.effect).kind);
  }
  const TrialList trials = all_trials(kJob, model);
  for (const OrderTrial& trial : trials.orders) kinds.insert(trial.effect.kind);
  for (const WearTrial& trial : trials.wears) kinds.insert(trial.effect.kind);
  return kinds;
}

TEST(EveryEffect, IsOfferedToCalibrateWithNumbersThatAProfileMayHold) {
  const EffectList model = hidden::declared();
  const std::set<std::string> kinds = offered(model);
  for (const EffectKind& kind : effect_kinds()) {
    if (kind.add_candidates == nullptr && kind.add_trials == nullptr) continue;
    EXPECT_TRUE(kinds.contains(kind.name)) << kind.name;
  }
  for (const Candidate& candidate : all_candidates(kJob, model)) {
    const std::vector<double> coefficients(candidate.columns.size(), 0.05);
    for (const EffectSpec& effect : candidate.apply(coefficients)) {
      ASSERT_EQ(check_effect(effect).what, "") << effect.kind;
    }
  }
}

TEST(EveryEffect, ThatIsThereOnceIsNotOfferedAgain) {
  EffectList model = hidden::declared();
  for (const EffectKind& kind : effect_kinds()) {
    if (kind.once) model.push_back(kind.examples.front());
  }
  const std::set<std::string> kinds = offered(model);
  for (const EffectKind& kind : effect_kinds()) {
    if (kind.once) {
      EXPECT_FALSE(kinds.contains(kind.name)) << kind.name;
    }
  }
}

// Where a candidate or a trial puts the effect into a model, its numbers are brought to the print:
// by the fit along slopes, by the search over places and sizes, or by the trials' own values.
TEST(EveryEffect, ThatIsSoughtHasNumbersThatAreFittedOrSearched) {
  for (const EffectKind& kind : effect_kinds()) {
    SCOPED_TRACE(kind.name);
    if (!kind.add_candidates && !kind.add_trials) continue;
    bool moves = false;
    for (const EffectSpec& example : kind.examples) {
      for (const auto& [name, values] : example.numbers) {
        const NumberRule& rule = kind.rule(name);
        const bool fits = rule.fits == nullptr || rule.fits(example, values.front());
        const double fit = rule.fit_step + rule.fit_share * values.front();
        const double search = rule.search_step == nullptr
                                  ? 0
                                  : rule.search_step(example, values.front(), kExampleGrid);
        moves = moves || (fits && fit > 0) || search > 0;
      }
    }
    EXPECT_TRUE(moves);
  }
}

TEST(EveryEffect, HasAHiddenPrinterWithItsPhysics) {
  std::set<std::string> physics;
  for (const auto& printers : {hidden::catalogue(1), hidden::nameless()}) {
    for (const hidden::Printer& printer : printers) physics.insert(printer.effect);
  }
  for (const EffectKind& kind : effect_kinds())
    EXPECT_TRUE(physics.contains(kind.name)) << kind.name;
}

TEST(Catalogue, HasOneNamelessKindAndAtMostOneNamedCauseOfALengthTerm) {
  int nameless = 0;
  std::set<LengthTerm> named;
  for (const EffectKind& kind : effect_kinds()) {
    nameless += kind.nameless ? 1 : 0;
    for (const LengthCause& cause : kind.length_causes) {
      if (cause.named) {
        EXPECT_TRUE(named.insert(cause.term).second) << kind.name;
      }
    }
  }
  EXPECT_EQ(nameless, 1);
}

}  // namespace
}  // namespace binderjet
