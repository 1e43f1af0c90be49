// SPDX-License-Identifier: GPL-3.0-or-later
// Counts of wrong voxels, by hand and against a plain loop over all of them.
#include "slicer/score/voxel_counts.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

TEST(VoxelCounts, TellMissingFromExtraAndWhatNoMaskAvoids) {
  // Three slices of four columns: 0, 1, 2 and 3 solid voxels. Printed are the first three columns.
  Volume target(4, 1, 3);
  target.fill([](int x, int, int z) { return z < x; });
  Volume printed(4, 1, 1);
  printed.fill([](int x, int, int) { return x < 3; });
  const VoxelCounts counts =
      count_voxels(*whole::voxel_stream(target, 3, {0, 1})->next(1).front(), slice(printed, 0));
  EXPECT_EQ(counts.solid, 6);
  EXPECT_EQ(counts.missing, 3) << "the last column";
  EXPECT_EQ(counts.extra, 3 + 2 + 1);
  EXPECT_EQ(counts.unavoidable, 0 + 1 + 1 + 0) << "the lesser of solid and powder";
  EXPECT_DOUBLE_EQ(counts.wrong(), 9.0 / 6);
  EXPECT_DOUBLE_EQ(counts.floor(), 2.0 / 6);
  EXPECT_DOUBLE_EQ(counts.excess(), 7.0 / 6);
}

TEST(VoxelCounts, AreThoseOfALoopOverAllVoxels) {
  Random random;
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(round);
    const int rz = random.number(1, 4);
    const Volume target = random.volume(random.number(1, 40), random.number(1, 20), rz);
    const Volume printed = random.volume(target.nx, target.ny, 1);
    VoxelCounts expected;
    for (int y = 0; y < target.ny; ++y) {
      for (int x = 0; x < target.nx; ++x) {
        int ones = 0;
        for (int z = 0; z < rz; ++z) ones += target.at(x, y, z);
        expected.solid += ones;
        expected.missing += printed.at(x, y, 0) == 1 ? 0 : ones;
        expected.extra += printed.at(x, y, 0) == 1 ? rz - ones : 0;
        expected.unavoidable += std::min(ones, rz - ones);
      }
    }
    const VoxelCounts counts =
        count_voxels(*whole::voxel_stream(target, rz, {0, 1})->next(1).front(), slice(printed, 0));
    EXPECT_EQ(counts.solid, expected.solid);
    EXPECT_EQ(counts.missing, expected.missing);
    EXPECT_EQ(counts.extra, expected.extra);
    EXPECT_EQ(counts.unavoidable, expected.unavoidable);
  }
}

}  // namespace
}  // namespace binderjet
