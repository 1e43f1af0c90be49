// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/voxels/voxelize.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <numbers>

#include "tests/support/models.h"

namespace binderjet {
namespace {

using models::at_origin;
using models::box;
using models::inside_out;
using models::joined;

std::vector<RunLayer> all_slices(const Mesh& mesh, const Grid& grid, JobBox job, int block = 3) {
  std::vector<RunLayer> slices;
  const auto stream = voxelize(std::make_shared<const Mesh>(mesh), grid, job, {0, job.size_px[2]});
  while (stream->rest().size() > 0) {
    for (const auto& layer : stream->next(block)) {
      slices.insert(slices.end(), layer->slices.begin(), layer->slices.end());
    }
  }
  return slices;
}
std::vector<RunLayer> all_slices(const Mesh& mesh, const Grid& grid) {
  return all_slices(mesh, grid, job_box(bounding_box(mesh).max, grid, {0, 0}, {0, 0}));
}
std::int64_t solid(const std::vector<RunLayer>& slices) {
  std::int64_t ones = 0;
  for (const RunLayer& slice : slices) ones += slice.count();
  return ones;
}

constexpr Grid kMillimeter{{1, 1, 1}, {1, 1, 1}};

TEST(Voxelize, FillsABoxWhoseFacesLieOnTheGrid) {
  const std::vector<RunLayer> slices = all_slices(box({0, 0, 0}, {5, 4, 3}), kMillimeter);
  ASSERT_EQ(slices.size(), 3U);
  for (const RunLayer& slice : slices) {
    EXPECT_EQ(slice.width(), 5);
    EXPECT_EQ(slice.height(), 4);
    EXPECT_EQ(slice.count(), 20);
  }
}

TEST(Voxelize, CountsACenterOnTheLowerFaceAsInsideAndOnTheUpperAsOutside) {
  // Centers are at 0.5, 1.5 ...: a box from 0.5 to 2.5 holds 0.5 and 1.5 but not 2.5.
  const Mesh mesh =
      joined(box({0, 0, 0}, {0.25, 0.25, 0.25}), box({0.5, 0.5, 0.5}, {2.5, 2.5, 2.5}));
  const std::vector<RunLayer> slices = all_slices(mesh, kMillimeter);
  ASSERT_EQ(slices.size(), 3U);
  for (int z = 0; z < 3; ++z) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 3; ++x) {
        EXPECT_EQ(slices[static_cast<std::size_t>(z)].at(x, y), x < 2 && y < 2 && z < 2)
            << x << ' ' << y << ' ' << z;
      }
    }
  }
}

TEST(Voxelize, KeepsACavityAndUnitesShellsThatOverlap) {
  const Mesh hollow = joined(box({0, 0, 0}, {9, 9, 9}), inside_out(box({3, 3, 3}, {6, 6, 6})));
  EXPECT_EQ(solid(all_slices(hollow, kMillimeter)), 9 * 9 * 9 - 27);
  const Mesh united = joined(box({0, 0, 0}, {6, 3, 3}), box({3, 0, 0}, {9, 3, 3}));
  EXPECT_EQ(solid(all_slices(united, kMillimeter)), 9 * 3 * 3);
}

TEST(Voxelize, TakesAnInsideOutShellAsSolid) {
  EXPECT_EQ(solid(all_slices(inside_out(box({0, 0, 0}, {4, 4, 4})), kMillimeter)), 64);
}

TEST(Voxelize, GivesTheVolumeOfASphere) {
  const double radius = 6;
  const Grid grid{{25.4 / 300, 25.4 / 450, 0.102}, {2, 2, 2}};
  const double voxel = grid.voxel_mm(0) * grid.voxel_mm(1) * grid.voxel_mm(2);
  const double volume =
      static_cast<double>(solid(all_slices(at_origin(models::sphere(radius, 6)), grid))) * voxel;
  // The sphere of 32,768 triangles itself lacks 0.02 % of the ball.
  EXPECT_NEAR(volume / (4 * std::numbers::pi / 3 * radius * radius * radius), 1, 1e-3);
}

TEST(Voxelize, GivesTheSameBitsForAnyBlockSizeAndAnyNumberOfThreads) {
  const Grid grid{{0.2, 0.15, 0.1}, {2, 2, 2}};
  const Mesh mesh = at_origin(models::golf_ball(4, 4));
  const JobBox job = job_box(bounding_box(mesh).max, grid, {7, 9}, {3, 2});
  const std::vector<RunLayer> one = all_slices(mesh, grid, job, 1);
  EXPECT_EQ(one, all_slices(mesh, grid, job, 7));
  const oneapi::tbb::global_control single(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(one, all_slices(mesh, grid, job, 7));
}

TEST(Voxelize, PutsTheMarginAroundThePart) {
  const Grid grid{{1, 1, 1}, {2, 2, 1}};
  const Mesh mesh = box({0, 0, 0}, {2, 2, 1});
  const JobBox job = job_box(bounding_box(mesh).max, grid, {10, 20}, {3, 2});
  EXPECT_EQ(job.size_px, (std::array<int, 3>{6, 4, 1}));
  EXPECT_EQ(job.bed_px, (std::array<int, 3>{8, 19, 0}));
  const std::vector<RunLayer> slices = all_slices(mesh, grid, job);
  EXPECT_EQ(slices.front(), window(all_slices(mesh, grid).front(), -4, -2, 12, 8));
}

TEST(Voxelize, StartsInTheMiddleWithTheSameLayers) {
  const Grid grid{{0.2, 0.2, 0.1}, {1, 1, 2}};
  const auto mesh = std::make_shared<const Mesh>(at_origin(models::sphere(2, 4)));
  const JobBox job = job_box(bounding_box(*mesh).max, grid, {0, 0}, {0, 0});
  const auto whole = voxelize(mesh, grid, job, {0, job.size_px[2]})->next(job.size_px[2]);
  const auto share = voxelize(mesh, grid, job, {11, 15})->next(100);
  ASSERT_EQ(share.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(share[k]->slices, whole[11 + k]->slices);
}

}  // namespace
}  // namespace binderjet
