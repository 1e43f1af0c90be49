// SPDX-License-Identifier: GPL-3.0-or-later
// The paper, 4.1: "the applied 2D kernel will have a size of 16x10 voxels".
#include <gtest/gtest.h>

#include "driver/profile/profile.h"
#include "slicer/model/printer_model.h"

namespace binderjet {
namespace {

TEST(PaperKernel, Of700By300MicrometersIsSixteenByTenVoxelsAndAFraction) {
  const Profile profile = load_profile("z450");
  const Grid grid = profile.grid(std::nullopt);
  // Half the printer's grid: 25.4 / 300 / 2 and 25.4 / 450 / 2 mm.
  const double x_vx = 0.7 / grid.voxel_mm(0);
  const double y_vx = 0.3 / grid.voxel_mm(1);
  EXPECT_NEAR(x_vx, 16.535, 0.001);
  EXPECT_NEAR(y_vx, 10.630, 0.001);
  EXPECT_EQ(static_cast<int>(x_vx), 16);
  EXPECT_EQ(static_cast<int>(y_vx), 10);

  // The model that the profile declares has that width, not the rounded one.
  const DoseTerm term = PrinterModel(profile.effects, grid).form().terms.front();
  // An end weight is rounded to 2^-16 voxels.
  EXPECT_NEAR(static_cast<double>(term.x.total()) / static_cast<double>(term.x.at(0)), x_vx, 1e-4);
  EXPECT_NEAR(static_cast<double>(term.y.total()) / static_cast<double>(term.y.at(0)), y_vx, 1e-4);
}

}  // namespace
}  // namespace binderjet
