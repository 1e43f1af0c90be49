// SPDX-License-Identifier: GPL-3.0-or-later
// The exact model's word on a mask.
#include "slicer/enhance/inverse/judge.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "slicer/enhance/inverse/search/layer_sets.h"
#include "tests/support/inverse_scene.h"

namespace binderjet {
namespace {

using whole::Volume;

// Voxels of 0.04 mm: the first two of a row are no deeper than 0.1 mm.
const Grid kJudgeGrid{{0.08, 0.08, 0.1}, {2, 2, 2}};

PrinterModel judge_model(double width_mm, double level) {
  return {{{"spread", {{"shape", "box"}}, {{"width_mm", {width_mm, width_mm}}}},
           {"threshold", {}, {{"level", {level}}}}},
          kJudgeGrid};
}

// A block of 20 x 20 pixels in 30 x 30.
Volume block() {
  Volume target(60, 60, 2);
  target.fill([](int x, int y, int) { return x >= 10 && y >= 10 && x < 50 && y < 50; });
  return target;
}

// The block's plain mask with another state in pixels [x0, x1) x [y0, y1).
RunLayer with_pixels(const LayerWindow& layers, const Rect& pixels, bool state) {
  const RunLayer& plain = *layers.middle().plain;
  RunLayer out(plain.width());
  for (int y = 0; y < plain.height(); ++y) {
    out.append_row_where([&](int x) { return pixels.holds(x, y) ? state : plain.at(x, y); });
  }
  return out;
}

TEST(Judge, FindsABiteAndTakesItBack) {
  const PrinterModel model = judge_model(0.3, 0.5);
  const whole::InverseScene scene({&model, 1}, kJudgeGrid, {}, block());
  const LayerWindow layers = scene.around(0);
  const Judge judge(scene.model, layers);
  // In the middle, 4 x 4 pixels; and as much binder where the part is not.
  const RunLayer bitten = with_pixels(layers, {13, 13, 17, 17}, false);
  const FoundFaults bite = judge.too_deep(bitten);
  ASSERT_EQ(bite.faults.size(), 1U);
  // All that is not printed now, for no voxel of it is near the surface.
  EXPECT_TRUE(bite.faults[0].missing.at(30, 30));
  EXPECT_EQ(bite.faults[0].missing,
            without(print_plain(layers, 0, model), print_with(layers, 0, model, bitten)));
  EXPECT_TRUE(bite.faults[0].surplus.empty());
  EXPECT_EQ(bite.weight, bite.faults[0].missing.count());
  EXPECT_EQ(judge.held(bitten), *layers.middle().plain);
  const FoundFaults blot = judge.too_deep(with_pixels(layers, {0, 8, 3, 12}, true));
  EXPECT_GT(blot.weight, 0);
  EXPECT_EQ(blot.faults[0].surplus.count(), blot.weight);
  EXPECT_TRUE(blot.faults[0].surplus.at(2, 20));
}

TEST(Judge, HoldsWhatIsGoodElsewhere) {
  const PrinterModel model = judge_model(0.3, 0.5);
  const whole::InverseScene scene({&model, 1}, kJudgeGrid, {}, block());
  const LayerWindow layers = scene.around(0);
  // A bite in the middle, and a pixel at the corner that the spread would round.
  RunLayer own = with_pixels(layers, {13, 13, 17, 17}, false);
  const RunLayer corner = with_pixels(layers, {4, 5, 5, 6}, true);
  ASSERT_EQ(Judge(scene.model, layers).too_deep(corner).weight, 0);
  ASSERT_TRUE(Judge(scene.model, layers).no_worse_than_plain(corner));
  RunLayer both(own.width());
  for (int y = 0; y < own.height(); ++y) {
    both.append_row_where([&](int x) { return y < 10 ? corner.at(x, y) : own.at(x, y); });
  }
  EXPECT_EQ(Judge(scene.model, layers).held(both), corner);
}

// Near the surface voxels may be wrong: two in a row, 0.08 mm, are no fault; more are.
TEST(Judge, AllowsWhatIsShallow) {
  const PrinterModel model = judge_model(0.08, 0.5);
  const whole::InverseScene scene({&model, 1}, kJudgeGrid, {}, block());
  const LayerWindow layers = scene.around(0);
  const Judge judge(scene.model, layers);
  const RunLayer shallow = with_pixels(layers, {24, 10, 25, 15}, false);
  ASSERT_GT(wrong_voxels(layers.middle(), print_with(layers, 0, model, shallow)), 0);
  EXPECT_EQ(judge.too_deep(shallow).weight, 0);
  EXPECT_GT(judge.too_deep(with_pixels(layers, {23, 10, 25, 15}, false)).weight, 0);
}

// What plain masks print wrong no search is blamed for, however deep it lies.
TEST(Judge, DoesNotBlameWhatIsWrongWithPlainMasksToo) {
  // A slot of 0.32 mm that plain masks close at a low level, and a wall that they lose at a high
  // one.
  Volume slot = block();
  slot.fill([&, all = slot](int x, int y, int z) {
    return all.at(x, y, z) == 1 && !(x >= 26 && x < 34 && y < 40);
  });
  Volume wall(60, 60, 2);
  wall.fill([](int x, int y, int) { return x >= 26 && x < 34 && y >= 10 && y < 50; });
  for (const auto& [target, level] : {std::pair{slot, 0.25}, std::pair{wall, 0.5}}) {
    const PrinterModel model = judge_model(0.9, level);
    const whole::InverseScene scene({&model, 1}, kJudgeGrid, {}, target);
    const LayerWindow layers = scene.around(0);
    ASSERT_NE(print_plain(layers, 0, model).at(29, 25), target.at(29, 25, 0) == 1)
        << "0.16 mm deep";
    const Judge judge(scene.model, layers);
    EXPECT_EQ(judge.too_deep(*layers.middle().plain).weight, 0);
    EXPECT_TRUE(judge.no_worse_than_plain(*layers.middle().plain));
  }
}

TEST(Judge, MissesAPinThatIsLost) {
  const PrinterModel model = judge_model(0.16, 0.5);
  Volume target(60, 60, 6);
  target.fill([](int x, int y, int) { return x >= 26 && y >= 26 && x < 34 && y < 34; });
  const whole::InverseScene scene({&model, 1}, kJudgeGrid, {}, target);
  const LayerWindow layers = scene.around(1);
  const Judge judge(scene.model, layers);
  EXPECT_EQ(judge.broken(*layers.middle().plain).weight, 0);
  const RunLayer empty = RunLayer::powder(30, 30);
  const FoundFaults found = judge.broken(empty);
  EXPECT_GT(found.weight, 0);
  for (const SearchFaults& of : found.faults) EXPECT_TRUE(of.surplus.empty());
  EXPECT_FALSE(judge.no_worse_than_plain(empty));
}

// A tip is lost that stands on the rim of a block. The rim is only worn, but without it the tip has
// nothing to stand on: the block's layer is asked for it.
TEST(Judge, AsksTheLayerBelowForWhatCarriesATip) {
  const PrinterModel model = judge_model(0.08, 0.5);
  Volume target(60, 60, 6);
  target.fill([](int x, int y, int z) {
    return z < 4 ? x >= 10 && y >= 10 && x < 32 && y < 50 : x >= 28 && y >= 26 && x < 32 && y < 32;
  });
  Volume masks = whole::masks(target, kJudgeGrid);
  masks.fill([all = masks](int x, int y, int k) { return x < 14 && all.at(x, y, k) == 1; });
  const whole::InverseScene scene({&model, 1}, kJudgeGrid, {}, target, masks);
  ASSERT_GT(find_broken(scene.around(2), kJudgeGrid).weight, 0) << "the tip is lost";
  ASSERT_EQ(find_broken(scene.around(1), kJudgeGrid).weight, 0) << "the rim is worn";
  const LayerWindow below = scene.around(1);
  const FoundFaults found = Judge(scene.model, below).broken();
  EXPECT_GE(found.weight, find_broken(scene.around(2), kJudgeGrid).weight);
  ASSERT_EQ(found.faults.size(), 2U) << "what is too deep, and what is missing beside";
  EXPECT_TRUE(found.faults[1].missing.at(30, 28));
  EXPECT_FALSE(found.faults[1].missing.at(30, 12)) << "worn, and nothing stands on it";
}

TEST(Judge, WeighsWhatComesOffAndWhatIsSpurious) {
  const PrinterModel model = judge_model(0.08, 0.5);
  // Two blocks with a neck between them, which the mask leaves out; and a blot far from both.
  Volume target(80, 40, 2);
  target.fill([](int x, int y, int) {
    return (y >= 10 && y < 30 && ((x >= 6 && x < 26) || (x >= 30 && x < 50))) ||
           (x >= 26 && x < 30 && y >= 18 && y < 22);
  });
  const Volume plain = whole::masks(target, kJudgeGrid);
  const auto broken = [&](const auto& mask) {
    Volume masks = plain;
    masks.fill([&](int x, int y, int) { return mask(x, y); });
    const whole::InverseScene scene({&model, 1}, kJudgeGrid, {}, target, masks);
    return find_broken(scene.around(0), kJudgeGrid);
  };
  EXPECT_EQ(broken([&](int x, int y) { return plain.at(x, y, 0) == 1; }).weight, 0);
  const FoundFaults loose =
      broken([&](int x, int y) { return plain.at(x, y, 0) == 1 && (x < 13 || x >= 15); });
  EXPECT_GE(loose.weight, 200);
  EXPECT_TRUE(loose.faults.front().missing.at(28, 20)) << "the neck";
  const FoundFaults blot = broken([&](int x, int y) {
    return plain.at(x, y, 0) == 1 || (x >= 33 && x < 37 && y >= 8 && y < 12);
  });
  EXPECT_GE(blot.weight, 100);
  EXPECT_TRUE(blot.faults.front().surplus.at(70, 20));
}

// What has been found holds as long as the prints are the same ones.
TEST(Judge, KnowsWhatItHasFoundUntilAPrintChanges) {
  const PrinterModel model = judge_model(0.16, 0.5);
  Volume target(20, 20, 6);
  target.fill([](int x, int y, int) { return x >= 6 && y >= 6 && x < 14 && y < 14; });
  const whole::InverseScene scene({&model, 1}, kJudgeGrid, {}, target);
  std::vector<Shared<InverseLayer>> layers;
  for (int k = 0; k < 3; ++k) {
    InverseLayer layer = scene.around(k).middle();
    layer.judged = prints_around(scene.around(k), 0, 1);
    layers.push_back(std::make_shared<const InverseLayer>(std::move(layer)));
  }
  const auto window = [&] { return LayerWindow(layers, LayerReach::both_sides(1)); };
  EXPECT_TRUE(is_known(window(), 0));
  InverseLayer other = *layers[2];
  other.printed = std::make_shared<const RunLayer>(*other.printed);
  layers[2] = std::make_shared<const InverseLayer>(other);
  EXPECT_FALSE(is_known(window(), 0));
}

}  // namespace
}  // namespace binderjet
