// SPDX-License-Identifier: GPL-3.0-or-later
// A scan that comes as a mesh becomes a stack where the mesh lies.
#include "driver/job/mesh_scan_to_stack.h"

#include <gtest/gtest.h>

#include <cmath>

#include "slicer/base/error.h"
#include "slicer/calibrate/scan/measured.h"
#include "tests/support/models.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

TEST(ScanMesh, IsCutWhereItLies) {
  const Workplace place;
  models::write_obj(models::box({1, -2, 0.3}, {6, 1, 1.3}), place / "scan.obj");
  write_scan_stack(place / "scan.obj", 0.1, place / "stack");
  const StackReader stack(place / "stack");
  EXPECT_EQ(stack.info().kind, StackKind::kMeasured);
  EXPECT_NEAR(stack.info().origin_mm[0], 1, 1e-9);
  EXPECT_NEAR(stack.info().origin_mm[1], -2, 1e-9);
  EXPECT_NEAR(stack.info().origin_mm[2], 0.3, 1e-9);
  EXPECT_EQ(stack.info().size[2], 20);
  EXPECT_EQ(stack.read(3).count(), 100 * 60);
}

// Shifted in all three axes, it still comes to lie on the prediction.
TEST(ScanMesh, RegistersLikeAnyScan) {
  const Workplace place;
  models::write_obj(models::box({1, -2, 0.3}, {6, 1, 1.3}), place / "scan.obj");
  write_scan_stack(place / "scan.obj", 0.1, place / "stack");
  StackInfo frame;
  frame.kind = StackKind::kPrinted;
  frame.size = {150, 100, 12};
  frame.pitch_mm = {0.04, 0.04, 0.1};
  RunLayer layer(150);
  for (int y = 0; y < 100; ++y) {
    layer.append_row(y >= 10 && y < 85 ? std::vector{10, 135} : std::vector<int>{});
  }
  std::vector<RunLayer> predicted(12, RunLayer::powder(150, 100));
  std::fill(predicted.begin() + 1, predicted.begin() + 11, layer);
  const Measured measured = read_measured(place / "stack", frame, predicted);
  ASSERT_TRUE(measured.registration);
  EXPECT_NEAR(measured.registration->pose.shift_mm[0], 0.6, 0.01);
  EXPECT_NEAR(measured.registration->pose.shift_mm[1], -2.4, 0.01);
  EXPECT_NEAR(measured.registration->pose.shift_mm[2], 0.2, 0.01);
  EXPECT_TRUE(measured.layers[0].empty());
  EXPECT_NEAR(static_cast<double>(measured.layers[5].count()), 125 * 75, 2 * 200);
  EXPECT_TRUE(measured.layers[11].empty());
}

TEST(ScanMesh, InMicrometersIsToldSoInsteadOfFillingTheMemory) {
  const Workplace place;
  for (const Mesh& mesh :
       {models::box({0, 0, 0}, {5000, 3000, 1000}), models::box({1e30, 0, 0}, {2e30, 3, 1}),
        models::box({1e7, 0, 0}, {1e7 + 5, 3, 1})}) {
    models::write_obj(mesh, place / "scan.obj");
    EXPECT_THROW(write_scan_stack(place / "scan.obj", 0.1, place / "stack"), Error);
    EXPECT_FALSE(std::filesystem::exists(place / "stack"));
  }
}

TEST(ScanMesh, MustHaveSomethingInIt) {
  const Workplace place;
  std::ofstream(place / "empty.obj") << "v 0 0 0\n";
  EXPECT_THROW(write_scan_stack(place / "empty.obj", 0.1, place / "stack"), Error);
}

}  // namespace
}  // namespace binderjet
