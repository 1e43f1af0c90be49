// SPDX-License-Identifier: GPL-3.0-or-later
// Faults over many layers, mended with simpler masks.
#include "slicer/enhance/inverse/repair/mend.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "slicer/enhance/inverse/inverse_solver.h"
#include "slicer/model/process_window.h"
#include "tests/support/mask_regions.h"
#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

Shared<PrintedLayer> layer_at(const Stretch::Layers& layers, int k) {
  return k < 0 || k >= static_cast<int>(layers.size()) ? nullptr
                                                       : layers[static_cast<std::size_t>(k)];
}

// The layers of a whole job with these masks.
Stretch::Layers printed(const InverseSolver& solver, const Volume& target, const Volume& masks,
                        int rz) {
  std::vector<Shared<InverseLayer>> layers;
  const auto voxels = whole::voxel_stream(target, rz, {0, masks.nz})->next(masks.nz);
  for (int k = 0; k < masks.nz; ++k) {
    InverseLayer layer = solver.plain(k, voxels[static_cast<std::size_t>(k)]);
    layer.mask = std::make_shared<const RunLayer>(whole::slice(masks, k));
    layers.push_back(std::make_shared<const InverseLayer>(std::move(layer)));
  }
  Stretch::Layers prints;
  for (int k = 0; k < masks.nz; ++k) {
    std::vector<Shared<InverseLayer>> window;
    for (int near = k - solver.print_reach(); near <= k + solver.print_reach(); ++near) {
      window.push_back(near < 0 || near >= masks.nz ? nullptr
                                                    : layers[static_cast<std::size_t>(near)]);
    }
    prints.push_back(std::make_shared<const PrintedLayer>(with_print(solver.by(), window)));
  }
  Stretch::Layers out;
  for (int k = 0; k < masks.nz; ++k) {
    const Stretch::Layers three{layer_at(prints, k - 1), layer_at(prints, k),
                                layer_at(prints, k + 1)};
    out.push_back(std::make_shared<const PrintedLayer>(with_missing(solver.by(), three)));
  }
  return out;
}

Stretch::Faults faults(const InverseSolver& solver, const Stretch::Layers& layers) {
  return Stretch(solver.by(), layers, static_cast<int>(layers.size())).faults();
}

constexpr int kLayers = 12;
const Grid kTowerGrid{{0.1, 0.1, 0.1}, {2, 2, 2}};

// A base with a tower.
Volume tower() {
  Volume v(80, 80, 2 * kLayers);
  v.fill([](int x, int y, int z) {
    if (z < 4) return x >= 10 && y >= 10 && x < 70 && y < 70;
    return x >= 30 && x < 38 && y >= 30 && y < 38;
  });
  return v;
}

// Two layers of the tower are not printed.
Volume masks_with_a_gap() {
  const Volume all = whole::masks(tower(), kTowerGrid);
  Volume masks = all;
  masks.fill([&](int x, int y, int k) { return k != 5 && k != 6 && all.at(x, y, k) == 1; });
  return masks;
}

InverseSolver solver() {
  return {process_window({{"spread", {{"shape", "box"}}, {{"width_mm", {0.3, 0.3}}}},
                          {"threshold", {}, {{"level", {0.5}}}}},
                         kTowerGrid),
          kTowerGrid, MaskRules{4, 4}};
}

TEST(Mend, AMissingStretchOfATowerComesBack) {
  const InverseSolver by = solver();
  const Stretch::Layers before = printed(by, tower(), masks_with_a_gap(), 2);
  // The layers above the gap; what is missing itself is worn by the layers beside it.
  ASSERT_EQ(faults(by, before).found.size(), 1U);
  EXPECT_TRUE(faults(by, mended(by.by(), before, {0, kLayers}, kLayers)).found.empty());
}

TEST(Mend, OnlyItsOwnLayersChange) {
  const InverseSolver by = solver();
  const Stretch::Layers before = printed(by, tower(), masks_with_a_gap(), 2);
  const Stretch::Layers after = mended(by.by(), before, {3, 6}, kLayers);
  ASSERT_EQ(after.size(), 3U);
  EXPECT_EQ(*after[0]->layer->mask, *before[3]->layer->mask);
  // One of the two missing layers is out of reach, so nothing would be gained.
  EXPECT_EQ(*after[2]->layer->mask, *before[5]->layer->mask);
}

TEST(Mend, WhatPrintsWhereNoPartIsGoes) {
  const InverseSolver by = solver();
  Volume masks = whole::masks(tower(), kTowerGrid);
  for (int y = 25; y < 30; ++y)
    for (int x = 25; x < 30; ++x) masks.set(x, y, 8, true);
  const Stretch::Layers before = printed(by, tower(), masks, 2);
  ASSERT_EQ(faults(by, before).found.size(), 1U);
  EXPECT_TRUE(faults(by, mended(by.by(), before, {0, kLayers}, kLayers)).found.empty());
}

TEST(Mend, ASoundStretchStaysAsItIs) {
  const InverseSolver by = solver();
  const Stretch::Layers before = printed(by, tower(), whole::masks(tower(), kTowerGrid), 2);
  EXPECT_EQ(mended(by.by(), before, {0, kLayers}, kLayers), before);
}

// Whatever the masks are: less is wrong, no layer prints worse than it may, and the prints that it
// gives are those of its masks.
TEST(Mend, NeverMakesAnythingWorse) {
  Random random;
  int better = 0;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const Grid grid = random.grid();
    const int layers = random.number(1, 6);
    const Volume target =
        random.volume(random.number(4, 14) * grid.detail_vx[0],
                      random.number(4, 14) * grid.detail_vx[1], layers * grid.detail_vx[2], 4);
    const InverseSolver by({random.model(grid, Random::Kernels::kAny)}, grid, MaskRules{1, 1});
    const Volume masks =
        random.volume(target.nx / grid.detail_vx[0], target.ny / grid.detail_vx[1], layers, 4);
    const Stretch::Layers before = printed(by, target, masks, grid.detail_vx[2]);
    const Stretch::Layers after = mended(by.by(), before, {0, layers}, layers);
    Volume mended_masks = masks;
    mended_masks.fill([&](int x, int y, int k) {
      return after[static_cast<std::size_t>(k)]->layer->mask->at(x, y);
    });
    const Stretch::Layers again = printed(by, target, mended_masks, grid.detail_vx[2]);
    const Stretch::Layers plain =
        printed(by, target, whole::masks(target, grid), grid.detail_vx[2]);
    for (std::size_t k = 0; k < after.size(); ++k) {
      ASSERT_EQ(*after[k]->printed, *again[k]->printed) << "layer " << k;
      const auto wrong = [&](const Stretch::Layers& all) {
        return wrong_voxels(*all[k]->layer, *all[k]->printed);
      };
      ASSERT_LE(wrong(after), std::max(wrong(before), wrong(plain))) << "layer " << k;
    }
    ASSERT_LE(faults(by, again).weight, faults(by, before).weight);
    if (faults(by, again).weight < faults(by, before).weight) ++better;
  }
  EXPECT_GT(better, 0) << "nothing to mend in any of them";
}

}  // namespace
}  // namespace binderjet
