// SPDX-License-Identifier: GPL-3.0-or-later
// The solver's view of the printer model is the printer model.
#include "slicer/enhance/local_dose.h"

#include <gtest/gtest.h>

#include "slicer/enhance/tile_surroundings.h"
#include "slicer/score.h"
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

  explicit Scene(Random& random)
      : grid(random.grid()),
        model(random.model(grid, Random::Kernels::kAny)),
        offsets(offsets_of(model.form())) {
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
          InverseLayer{voxels[static_cast<std::size_t>(k)], layer, layer, {}}));
    }
    const std::vector<PrinterModel> models{model};
    const std::vector<int> weights{1};
    stamped_models = stamped(models, weights, grid);
    box = {0, 0, nx, ny};
    mask.reset(box.grown(40, 40), 0);
    add_layer(*layer_at(layers, 0)->mask, std::uint8_t{1}, mask);
  }

  std::int64_t wrong(const RunLayer& own) const {
    std::int64_t sum = 0;
    for (const int offset : offsets.printed) {
      const VoxelCounts counts =
          count_voxels(*layer_at(layers, offset)->target, print_with(layers, offset, model, own));
      sum += counts.missing + counts.extra;
    }
    return sum;
  }
};

TEST(LocalDose, BindsWhatThePrinterModelPrints) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const Scene scene(random);
    if (!scene.offsets.printed.contains(0) || !scene.model.form().survive_vx.empty()) continue;
    TileSurroundings around(scene.layers, scene.offsets, scene.mask);
    LocalDose dose(scene.stamped_models, scene.grid, scene.box, around);
    around.look_at(dose);
    dose.reset();
    const RunLayer printed =
        print_with(scene.layers, 0, scene.model, *layer_at(scene.layers, 0)->mask);
    // Stamps are rounded to 2^-29 of a dose each, or a little coarser.
    constexpr double kRounding = 1e-5;
    for (int y = 0; y < printed.height(); ++y) {
      for (int x = 0; x < printed.width(); ++x) {
        ASSERT_EQ(printed.at(x, y), dose.dose(x, y) >= scene.model.form().level - kRounding)
            << x << ", " << y << ": " << dose.dose(x, y);
      }
    }
  }
}

TEST(LocalDose, KnowsWhatAFlipChangesBeforeItIsDone) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    Scene scene(random);
    if (!scene.model.form().survive_vx.empty()) continue;
    TileSurroundings around(scene.layers, scene.offsets, scene.mask);
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
