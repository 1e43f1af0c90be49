// SPDX-License-Identifier: GPL-3.0-or-later
// The search's view of the printer model is the printer model.
#include "slicer/enhance/inverse/search/doses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "slicer/enhance/inverse/search/prices.h"
#include "slicer/model/process_window.h"
#include "tests/support/examples.h"
#include "tests/support/inverse_scene.h"
#include "tests/support/random.h"
#include "tests/support/rows.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

// Random layers around one of which all pixels may flip.
struct DoseScene {
  Grid grid;
  std::vector<PrinterModel> window;
  int layers;
  Volume target;
  Volume masks;
  whole::InverseScene scene;
  RunLayer open;

  DoseScene(Random& random, const Grid& its_grid, const std::vector<PrinterModel>& its_window)
      : DoseScene(random, its_grid, its_window, random.number(4, 12), random.number(4, 12)) {}
  DoseScene(Random& random, const Grid& its_grid, const std::vector<PrinterModel>& its_window,
            int nx, int ny)
      : grid(its_grid),
        window(its_window),
        layers(4 * window.front().window_reach() + 1),
        target(random.volume(nx * grid.detail_vx[0], ny * grid.detail_vx[1],
                             layers * grid.detail_vx[2])),
        masks(random.volume(target.nx / grid.detail_vx[0], target.ny / grid.detail_vx[1], layers)),
        scene(window, grid, {}, target, masks),
        open(whole::all_of(masks.nx, masks.ny)) {}

  int middle() const { return layers / 2; }
  LayerWindow around() const { return scene.around(middle()); }
  RunLayer mask() const { return whole::slice(masks, middle()); }
  // A random pixel's flip, made in `masks`; the pixel lies that far within the layer.
  OpenPixel flip(Random& random, const Doses& doses, int& sign, std::array<int, 2> within = {}) {
    const int x = random.number(within[0], masks.nx - 1 - within[0]);
    const int y = random.number(within[1], masks.ny - 1 - within[1]);
    sign = masks.at(x, y, middle()) == 1 ? -1 : 1;
    masks.set(x, y, middle(), sign > 0);
    return {doses.runs_of(y)[0], x};
  }
};

PrinterModel without_wear(const PrinterModel& model, const Grid& grid) {
  AssembledModel form = model.form();
  form.wear.clear();
  return {form, grid};
}

// Half a unit for each end of each row of pixels that a kernel reaches.
double most_rounding(const SearchModel& by, const PrinterModel& model) {
  int ends = 0;
  for (const DoseTerm& term : model.form().terms) {
    ends += (static_cast<int>(term.x.weights.size()) / by.grid.detail_vx[0] + 3) *
            (static_cast<int>(term.y.weights.size()) / by.grid.detail_vx[1] + 3);
  }
  return 0.5 * ends / by.unit;
}

// The dose in real numbers and plain loops (slicer/MODEL.md).
double real_dose(const Volume& masks, const AssembledModel& form, const Grid& grid, int x, int y,
                 int k) {
  double dose = 0;
  const auto pixel = [](int voxel, int repeat) { return voxel < 0 ? -1 : voxel / repeat; };
  for (const DoseTerm& term : form.terms) {
    std::int64_t sum = 0;
    for (int j = term.y.first; j <= term.y.last(); ++j)
      for (int i = term.x.first; i <= term.x.last(); ++i)
        if (masks.at(pixel(x - i, grid.detail_vx[0]), pixel(y - j, grid.detail_vx[1]),
                     k + term.layer) == 1)
          sum += term.x.at(i) * term.y.at(j);
    dose += term.gain * static_cast<double>(sum) / static_cast<double>(term.x.total()) /
            static_cast<double>(term.y.total());
  }
  return dose;
}

// Kernels of a random model reach from -3 to 1 voxels or further, so these voxels are reached.
constexpr int kMargin = 4;

template <class Act>
void for_each_reached(const DoseScene& scene, Act act) {
  for (int y = kMargin; y < scene.target.ny - kMargin; ++y) {
    for (int x = kMargin; x < scene.target.nx - kMargin; ++x) act(x, y);
  }
}

TEST(Doses, AreThoseOfTheModelToHalfAUnitForEachEdge) {
  Random random;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const Grid grid = random.grid();
    const DoseScene scene(random, grid, {random.model(grid, Random::Kernels::kAny)});
    const SearchModel& by = scene.scene.model;
    if (!by.offsets.printed.contains(0)) continue;
    const LayerWindow around = scene.around();
    Doses doses(by, around, scene.open);
    doses.fill_nominal(scene.mask());
    const double rounding = most_rounding(by, by.printer);
    for_each_reached(scene, [&](int x, int y) {
      ASSERT_NEAR(doses.dose(x, y),
                  real_dose(scene.masks, by.printer.form(), grid, x, y, scene.middle()), rounding)
          << x << ", " << y;
    });
    if (testing::Test::HasFatalFailure()) return;
  }
}

// See slicer/README.md: drops whose weakness follows the mask, layers that are not where they were
// sent, and wear.
bool only_the_judge_sees(const PrinterModel& model) {
  const AssembledModel& form = model.form();
  return !form.placed.weak_drops.empty() || !form.moves.empty() || !form.wear.empty();
}

const Grid kPlacedGrid{{0.25, 0.2, 0.1}, {2, 2, 2}};

PrinterModel placed_model(const EffectSpec& effect) {
  const EffectSpec spread{"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.5}}}};
  const EffectSpec threshold{"threshold", {}, {{"level", {0.5}}}};
  return {{spread, threshold, effect}, kPlacedGrid, {{3, 5}, {3, 1.92}}};
}

TEST(Doses, BindWhatIsPrintedWithAnyEffect) {
  Random random;
  for (const EffectSpec& effect : whole::examples_beside_a_level()) {
    SCOPED_TRACE(effect.kind);
    const PrinterModel model = placed_model(effect);
    if (only_the_judge_sees(model)) continue;
    std::int64_t sure = 0;
    std::int64_t all = 0;
    for (int round = 0; round < 5 || all == 0; ++round) {
      const DoseScene scene(random, kPlacedGrid, {model});
      const SearchModel& by = scene.scene.model;
      const LayerWindow around = scene.around();
      Doses doses(by, around, scene.open);
      const RunLayer mask = scene.mask();
      doses.fill_nominal(mask);
      const RunLayer printed = print_with(around, 0, model, mask);
      // A gain multiplies what is rounded.
      const double rounding = 3 * most_rounding(by, model);
      const double level = model.form().level;
      for_each_reached(scene, [&](int x, int y) {
        const double dose = doses.dose(x, y);
        ++all;
        if (std::abs(dose - level) < rounding) return;
        ++sure;
        ASSERT_EQ(printed.at(x, y), dose >= level) << x << ", " << y << ": " << dose;
      });
      if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(2 * sure, all);
  }
}

TEST(Doses, FlipsAddUpToTheMaskTheyLeadToWithAnyEffect) {
  Random random;
  for (const EffectSpec& effect : whole::examples_beside_a_level()) {
    SCOPED_TRACE(effect.kind);
    const PrinterModel model = placed_model(effect);
    // The density follows the mask; a search looks at it once, and again in the next turn.
    const bool follows = model.form().placed.density_radius_mm.has_value();
    if (follows || only_the_judge_sees(model)) continue;
    DoseScene scene(random, kPlacedGrid, {model});
    const LayerWindow around = scene.around();
    Doses doses(scene.scene.model, around, scene.open);
    doses.fill_nominal(scene.mask());
    for (int flips = 0; flips < 20; ++flips) {
      int sign = 0;
      const OpenPixel pixel = scene.flip(random, doses, sign);
      doses.flip(pixel, sign);
    }
    Doses again(scene.scene.model, around, scene.open);
    again.fill_nominal(scene.mask());
    for_each_reached(scene, [&](int x, int y) {
      ASSERT_EQ(doses.dose(x, y), again.dose(x, y)) << x << ", " << y;
    });
    if (testing::Test::HasFatalFailure()) return;
  }
}

// A band of the whole layer and what is around it.
const Rect kAround{-12, -12, 14, 14};

// The least and the most that counting gives, whichever way the voxels fall whose dose is at the
// level but for rounding.
struct Bounds {
  std::int64_t least = 0;
  std::int64_t most = 0;
};

// What a change of the middle layer's mask costs in counts under all models: the model in plain
// loops, times the price of each voxel of the layers.
Bounds counted_change(const DoseScene& scene, const Volume& before, const Volume& after) {
  const SearchModel& by = scene.scene.model;
  Bounds sum;
  for (const int offset : by.offsets.printed) {
    const int k = scene.middle() + offset;
    const Band band(scene.open, kAround, {scene.grid.detail_vx[0], scene.grid.detail_vx[1]});
    const auto prices = voxel_prices(*scene.around().at(offset)->target, band);
    const std::vector<int> weights = window_weights(scene.window, scene.grid);
    for (std::size_t m = 0; m < scene.window.size(); ++m) {
      const PrinterModel& model = scene.window[m];
      const int weight = weights[m];
      const double rounding = 2 * most_rounding(by, model);
      for (int y = 0; y < scene.target.ny; ++y) {
        for (int x = 0; x < scene.target.nx; ++x) {
          const AssembledModel& form = model.form();
          const double dose0 = real_dose(before, form, scene.grid, x, y, k);
          const double dose1 = real_dose(after, form, scene.grid, x, y, k);
          if (dose0 == dose1) continue;
          const int price = weight * prices[band.number(x, y)];
          const double over0 = dose0 - form.level;
          const double over1 = dose1 - form.level;
          const int change = price * (static_cast<int>(over1 >= 0) - static_cast<int>(over0 >= 0));
          const bool sure = std::abs(over0) > rounding && std::abs(over1) > rounding;
          sum.least += sure ? change : std::min({change, 0, -std::abs(price)});
          sum.most += sure ? change : std::max({change, 0, std::abs(price)});
        }
      }
    }
  }
  return sum;
}

TEST(Doses, KnowWhatAFlipChangesBeforeItIsMade) {
  Random random;
  int exact = 0;
  int all = 0;
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE(round);
    const Grid grid = random.grid();
    std::vector<PrinterModel> window{without_wear(random.model(grid, Random::Kernels::kAny), grid)};
    // A printer that binds at a lower dose, and two whose binder goes elsewhere.
    AssembledModel drifted = window.front().form();
    drifted.level *= 0.9;
    window.emplace_back(drifted, grid);
    for (DoseTerm& term : drifted.terms) ++term.x.first;
    window.emplace_back(drifted, grid);
    drifted.level *= 1.3;
    window.emplace_back(drifted, grid);
    DoseScene scene(random, grid, window, 32, 32);
    const LayerWindow around = scene.around();
    Doses doses(scene.scene.model, around, scene.open);
    doses.fill_nominal(scene.mask());
    doses.fill_drifted(scene.mask());
    const std::vector<int> weights = window_weights(scene.window, grid);
    EXPECT_EQ(doses.weights(), std::accumulate(weights.begin(), weights.end(), 0));
    // Beyond the layer nothing is counted here.
    const auto [x, y] = doses.pixel_reach();
    if (std::max(x, y) > 15) continue;
    for (int flips = 0; flips < 2; ++flips) {
      const Volume before = scene.masks;
      int sign = 0;
      const OpenPixel pixel = scene.flip(random, doses, sign, {x, y});
      const int change = doses.count_change(pixel, sign);
      doses.flip(pixel, sign);
      const Bounds counted = counted_change(scene, before, scene.masks);
      ASSERT_GE(change, counted.least);
      ASSERT_LE(change, counted.most);
      ++all;
      if (counted.least == counted.most) ++exact;
    }
  }
  std::cout << exact << " of " << all << " without a voxel at the level\n";
  EXPECT_GT(exact, 0);
}

// One box and a mask of even rows: all doses are exact in whole units.
DoseScene exact_scene(Random& random) {
  const Grid grid{{0.125, 0.125, 0.125}, {2, 2, 1}};
  return {random,
          grid,
          {PrinterModel({{"spread", {{"shape", "box"}}, {{"width_mm", {0.25, 0.25}}}},
                         {"threshold", {}, {{"level", {0.5}}}}},
                        grid)},
          9,
          9};
}

// Where the printer's doses would be after a flip, the ramp's formula in plain words.
TEST(Doses, KnowWhatAFlipChangesOnARamp) {
  Random random;
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE(round);
    DoseScene scene = exact_scene(random);
    const SearchModel& by = scene.scene.model;
    const LayerWindow around = scene.around();
    Doses doses(by, around, scene.open);
    Doses after(by, around, scene.open);
    doses.fill_nominal(scene.mask());
    const Ramp ramp{random.number(0, by.unit), random.number(0, by.unit),
                    random.number(1, by.unit)};
    int sign = 0;
    const OpenPixel pixel = scene.flip(random, doses, sign, {2, 2});
    after.fill_nominal(scene.mask());
    const Band band(scene.open, kAround, {2, 2});
    const auto prices = voxel_prices(*around.middle().target, band);
    std::int64_t expected = 0;
    for (int y = 0; y < scene.target.ny; ++y) {
      for (int x = 0; x < scene.target.nx; ++x) {
        const int price = prices[band.number(x, y)];
        const int from = price > 0 ? ramp.powder_from : ramp.solid_from;
        const auto on = [&](const Doses& d) {
          return std::clamp(static_cast<int>(std::lround(d.dose(x, y) * by.unit)) - from, 0,
                            ramp.span);
        };
        expected += std::int64_t{price} * (on(after) - on(doses));
      }
    }
    const double dose = doses.dose(0, 0);
    doses.enter(ramp);
    ASSERT_EQ(doses.ramp_change(pixel, sign, ramp), expected);
    doses.leave(ramp);
    ASSERT_EQ(doses.dose(0, 0), dose);
  }
}

// Six voxels wide the spread takes 1/4 of the dose to the second voxel beyond a straight edge,
// which is bound at a level of 1/4; in whole units it is a little less.
TEST(Doses, BindAnEdgeThatMeetsTheLevel) {
  const Grid grid{{0.1, 0.1, 0.1}, {2, 2, 1}};
  const PrinterModel model({{"spread", {{"shape", "box"}}, {{"width_mm", {0.3, 0.3}}}},
                            {"threshold", {}, {{"level", {0.25}}}}},
                           grid);
  Volume target(60, 60, 1);
  target.fill([](int x, int, int) { return x < 32; });
  Volume masks(30, 30, 1);
  masks.fill([](int x, int, int) { return x < 15; });
  const whole::InverseScene scene({&model, 1}, grid, {}, target, masks);
  const LayerWindow around = scene.around(0);
  const RunLayer before = model.print(whole::slice(masks, 0));
  ASSERT_EQ(middle_row(before), (std::vector<int>{0, 32}));
  Doses doses(scene.model, around, whole::all_of(30, 30));
  doses.fill_nominal(whole::slice(masks, 0));
  const Band band(whole::all_of(30, 30), kAround, {2, 2});
  const auto prices = voxel_prices(*around.middle().target, band);
  for (const int x : {12, 13, 14, 15, 16, 17}) {
    Volume flipped = masks;
    flipped.set(x, 15, 0, x >= 15);
    const RunLayer after = model.print(whole::slice(flipped, 0));
    int expected = 0;
    for (int v = 0; v < 60; ++v) {
      for (int u = 0; u < 60; ++u) {
        expected += kNominalWeight * prices[band.number(u, v)] *
                    (static_cast<int>(after.at(u, v)) - static_cast<int>(before.at(u, v)));
      }
    }
    EXPECT_EQ(doses.count_change({15, x}, x < 15 ? -1 : 1), expected) << x;
    if (x == 14) {
      EXPECT_GT(expected, 0) << "the edge's own pixel takes voxels with it";
    }
  }
}

TEST(Doses, RaiseThePriceOfFaultsTheWayTheyAreWrong) {
  Random random;
  const DoseScene scene = exact_scene(random);
  const LayerWindow around = scene.around();
  const RunLayer powder = RunLayer::powder(scene.masks.nx, scene.masks.ny);
  const RunLayer all = whole::all_of(scene.target.nx, scene.target.ny);
  const OpenPixel pixel{static_cast<std::size_t>(scene.masks.ny / 2), scene.masks.nx / 2};
  const Ramp ramp{0, 0, scene.scene.model.unit};
  for (const bool missing : {true, false}) {
    Doses doses(scene.scene.model, around, scene.open);
    // What one pixel more changes in the empty layer, or one less in the full one: it is wanted,
    // whatever the target is there.
    doses.fill_nominal(missing ? powder : scene.open);
    doses.raise_prices(0, all, missing, 8);
    doses.enter(ramp);
    const int change = doses.ramp_change(pixel, missing ? 1 : -1, ramp);
    // A pixel's four voxels of binder, each at the least price times 8 or more.
    EXPECT_LE(change, -4 * scene.scene.model.unit * kPriceUnit * 8);
  }
}

}  // namespace
}  // namespace binderjet
