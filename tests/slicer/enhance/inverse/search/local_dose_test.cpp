// SPDX-License-Identifier: GPL-3.0-or-later
// The solver's view of the printer model is the printer model.
#include "slicer/enhance/inverse/search/local_dose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "slicer/enhance/inverse/search/tile_surroundings.h"
#include "slicer/score/voxel_counts.h"
#include "tests/support/examples.h"
#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;

// Random layers around a middle one, as the solver holds them.
struct Scene {
  Grid grid;
  PrinterModel model;
  std::vector<Shared<InverseLayer>> layers;
  ModelOffsets offsets;
  std::vector<StampedModel> stamped_models;
  Rect box;
  Plane<std::uint8_t> mask;

  Scene(Random& random, const Grid& its_grid, const PrinterModel& its_model)
      : grid(its_grid), model(its_model), offsets(offsets_of(model.form())) {
    const int nx = random.number(1, 12);
    const int ny = random.number(1, 12);
    const int count = 4 * model.window_reach() + 1;
    const whole::Volume target =
        random.volume(nx * grid.detail_vx[0], ny * grid.detail_vx[1], count * grid.detail_vx[2]);
    const whole::Volume masks = random.volume(nx, ny, count);
    const auto voxels = whole::voxel_stream(target, grid.detail_vx[2], {0, count})->next(count);
    for (int k = 0; k < count; ++k) {
      auto layer = std::make_shared<const RunLayer>(whole::slice(masks, k));
      layers.push_back(std::make_shared<const InverseLayer>(
          InverseLayer{voxels[static_cast<std::size_t>(k)], layer, layer, {}, k}));
    }
    const std::vector<PrinterModel> models{model};
    const std::vector<int> weights{1};
    stamped_models = stamped(models, weights, grid);
    box = {0, 0, nx, ny};
    mask.reset(box.grown(80, 80), 0);
    add_layer(*layer_at(layers, 0)->mask, std::uint8_t{1}, mask);
  }
  explicit Scene(Random& random) : Scene(random, random.grid()) {}

  // The density is that of the masks as they are.
  WindowPlaces places() const { return {model, grid, layers, offsets}; }

  std::int64_t wrong(const RunLayer& own) const {
    std::int64_t sum = 0;
    for (const int offset : offsets.printed) {
      const VoxelCounts counts =
          count_voxels(*layer_at(layers, offset)->target, print_with(layers, offset, model, own));
      sum += counts.missing + counts.extra;
    }
    return sum;
  }

 private:
  Scene(Random& random, const Grid& its_grid)
      : Scene(random, its_grid, random.model(its_grid, Random::Kernels::kAny)) {}
};

// A voxel is bound in the solver's dose where it is in the print, but for ties: stamps are rounded
// to 2^-29 of a dose each, or a little coarser.
void expect_same_print(const Scene& scene, double rounding) {
  const WindowPlaces places = scene.places();
  TileSurroundings around(scene.layers, scene.offsets, places, scene.mask);
  LocalDose dose(scene.stamped_models, scene.grid, scene.box, around);
  around.look_at(dose);
  dose.reset();
  const RunLayer printed =
      print_with(scene.layers, 0, scene.model, *layer_at(scene.layers, 0)->mask);
  const double level = scene.model.form().level;
  for (int y = 0; y < printed.height(); ++y) {
    for (int x = 0; x < printed.width(); ++x) {
      if (rounding > 0 && std::abs(dose.dose(x, y) - level) < rounding) continue;
      // Without effects of the place doses are exact in binary, so a tie is one in both.
      ASSERT_EQ(printed.at(x, y), dose.dose(x, y) >= level - 1e-7)
          << x << ", " << y << ": " << dose.dose(x, y);
    }
  }
}

TEST(LocalDose, BindsWhatThePrinterModelPrints) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const Scene scene(random);
    if (!scene.offsets.printed.contains(0) || !scene.model.form().wear.empty()) continue;
    expect_same_print(scene, 0);
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

PrinterModel model_with(const EffectSpec& effect) {
  const EffectSpec spread{"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.5}}}};
  const EffectSpec threshold{"threshold", {}, {{"level", {0.5}}}};
  return {{spread, threshold, effect}, kPlacedGrid, {{3, 5}, {3, 1.92}}};
}

TEST(LocalDose, BindsWhatIsPrintedWithAnyEffect) {
  Random random;
  for (const EffectSpec& effect : whole::examples_beside_a_level()) {
    SCOPED_TRACE(effect.kind);
    const PrinterModel model = model_with(effect);
    if (only_the_judge_sees(model)) continue;
    for (int round = 0; round < 10; ++round) {
      expect_same_print(Scene(random, kPlacedGrid, model), 1e-5);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

TEST(LocalDose, FlipsAddUpToTheMaskTheyLeadToWithAnyEffect) {
  Random random;
  for (const EffectSpec& effect : whole::examples_beside_a_level()) {
    SCOPED_TRACE(effect.kind);
    const PrinterModel model = model_with(effect);
    // The density follows the mask; the solver looks at it once, and again in the next turn.
    const bool follows = model.form().placed.density_radius_mm.has_value();
    if (follows || only_the_judge_sees(model)) continue;
    for (int round = 0; round < 5; ++round) {
      Scene scene(random, kPlacedGrid, model);
      const WindowPlaces places = scene.places();
      TileSurroundings around(scene.layers, scene.offsets, places, scene.mask);
      LocalDose dose(scene.stamped_models, scene.grid, scene.box, around);
      around.look_at(dose);
      dose.reset();
      for (int flip = 0; flip < 20; ++flip) {
        const int x = random.number(0, scene.box.x1 - 1);
        const int y = random.number(0, scene.box.y1 - 1);
        std::uint8_t& pixel = *scene.mask.at(x, y);
        dose.flip(x, y, pixel != 0 ? -1 : 1);
        pixel ^= 1;
      }
      LocalDose again(scene.stamped_models, scene.grid, scene.box, around);
      again.reset();
      for (int y = 0; y < scene.box.y1 * 2; ++y) {
        for (int x = 0; x < scene.box.x1 * 2; ++x) {
          ASSERT_NEAR(dose.dose(x, y), again.dose(x, y), 1e-5);
        }
      }
    }
  }
}

TEST(LocalDose, KnowsWhatAFlipChangesBeforeItIsDone) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    Scene scene(random);
    if (!scene.model.form().wear.empty()) continue;
    const WindowPlaces places = scene.places();
    TileSurroundings around(scene.layers, scene.offsets, places, scene.mask);
    LocalDose dose(scene.stamped_models, scene.grid, scene.box, around);
    around.look_at(dose);
    dose.reset();
    // What a print adds beyond the box is no part of the score.
    const auto reach = scene.model.reach().xy_vx;
    std::int64_t wrong = scene.wrong(*layer_at(scene.layers, 0)->mask);
    for (int flip = 0; flip < 5; ++flip) {
      const int x = random.number(0, scene.box.x1 - 1);
      const int y = random.number(0, scene.box.y1 - 1);
      const Rect near = dose.voxels_of(x, y).grown(reach[0], reach[1]);
      const Rect voxels{0, 0, scene.box.x1 * scene.grid.detail_vx[0],
                        scene.box.y1 * scene.grid.detail_vx[1]};
      const Rect inside = near.cut(voxels);
      const int sign = *scene.mask.at(x, y) != 0 ? -1 : 1;
      const int cost = dose.flip_cost(x, y, sign);
      dose.flip(x, y, sign);
      *scene.mask.at(x, y) ^= 1;
      const std::int64_t after = scene.wrong(to_layer(scene.mask, scene.box.x1, scene.box.y1));
      if (inside.width() == near.width() && inside.height() == near.height()) {
        ASSERT_EQ(after - wrong, cost);
      } else {
        // Beyond the box every printed voxel is wrong: setting costs no less than what is scored.
        ASSERT_LE((after - wrong) * sign, cost * sign);
      }
      wrong = after;
    }
  }
}

}  // namespace
}  // namespace binderjet
