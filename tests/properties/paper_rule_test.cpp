// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's rule (its eq. 1): only the boundary moves, and only where the print is wrong.
#include "slicer/enhance/paper/paper_rule.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

// One pass over a whole volume through the layer-wise rule.
Volume one_pass(const Volume& v, const Volume& printed, const Volume& target, int rz) {
  const int layers = printed.nz;
  const auto voxels = [&](const Volume& of) {
    return whole::voxel_stream(of, rz, {0, layers})->next(layers);
  };
  const auto volume = voxels(v);
  const auto wanted = voxels(target);
  std::vector<PassLayer> pass;
  for (int k = 0; k < layers; ++k) {
    const auto at = static_cast<std::size_t>(k);
    pass.push_back({wanted[at], volume[at], whole::slice(printed, k)});
  }
  std::vector<Shared<RunLayer>> slices;
  for (std::size_t k = 0; k < pass.size(); ++k) {
    const VoxelLayer next = paper_rule(k == 0 ? nullptr : &pass[k - 1], pass[k],
                                       k + 1 == pass.size() ? nullptr : &pass[k + 1]);
    for (const RunLayer& slice : next.slices) {
      slices.push_back(std::make_shared<const RunLayer>(slice));
    }
  }
  return whole::stacked(slices);
}

TEST(PaperRule, TouchesBoundaryVoxelsOnly) {
  Random random;
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(round);
    const int rz = random.number(1, 3);
    const int layers = random.number(1, 4);
    const int nx = random.number(1, 150);  // more than one tile
    const int ny = random.number(1, 20);
    const Volume v = random.volume(nx, ny, layers * rz);
    const Volume target = random.volume(nx, ny, layers * rz);
    const Volume printed = random.volume(nx, ny, layers);
    const Volume next = one_pass(v, printed, target, rz);
    for (int z = 0; z < v.nz; ++z)
      for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x)
          if (next.at(x, y, z) != v.at(x, y, z)) {
            ASSERT_TRUE(whole::at_boundary(v, x, y, z)) << x << ", " << y << ", " << z;
          }
    ASSERT_EQ(next, whole::paper_pass(v, printed, target, rz));
  }
}

TEST(PaperRule, ChangesNothingWhereThePrintIsRight) {
  Random random;
  const Volume printed = random.volume(70, 9, 3);
  Volume target(70, 9, 6);
  target.fill([&](int x, int y, int z) { return printed.at(x, y, z / 2) == 1; });
  EXPECT_EQ(one_pass(target, printed, target, 2), target);
}

TEST(PaperRule, FillsWhereTooLittleIsPrintedAndGivesWayWhereTooMuchIs) {
  // A bar of 4 slices' height; nothing of it is printed, and beside it a bar nobody wants.
  Volume target(12, 5, 4);
  target.fill([](int x, int y, int) { return y == 2 && x < 6; });
  Volume printed(12, 5, 4);
  printed.fill([](int x, int y, int) { return y == 2 && x >= 8; });
  const Volume next = one_pass(target, printed, target, 1);
  EXPECT_EQ(next.at(3, 1, 2), 1);
  EXPECT_EQ(next.at(3, 0, 2), 0) << "one voxel at a time";
  EXPECT_EQ(next.at(6, 2, 2), 1);
  // Where the unwanted bar prints, V is powder already and stays it.
  EXPECT_EQ(next.at(10, 2, 2), 0);
}

}  // namespace
}  // namespace binderjet
