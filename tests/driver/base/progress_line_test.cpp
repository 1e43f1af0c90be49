// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/base/progress_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "driver/base/console.h"
#include "slicer/base/work.h"

namespace binderjet {
namespace {

using testing::IsEmpty;

const Progress kHalf{"scoring", "layers", 10, 20, 0, 2.0};

TEST(ProgressLine, SaysWhatHowFarHowFastAndHowLongStill) {
  EXPECT_EQ(text_of(kHalf, 80),
            "scoring [###############               ] 10/20 layers, 5.0/s, 0:02 left");
}

TEST(ProgressLine, SaysHowLongItHasBeenAtItWhereNobodyKnowsHowLongStill) {
  EXPECT_EQ(text_of({"repairing", "", 0, 0, 0, 75}, 80), "repairing, 1:15");
  EXPECT_EQ(text_of({"reading", "images", 12, 0, 0, 4}, 80), "reading 12 images, 3.0/s, 0:04");
  EXPECT_EQ(text_of({"slicing", "layers", 0, 9, 0, 3}, 80),
            "slicing [                              ] 0/9 layers, 0:03");
}

// A resumed job begins at layer 30: those before it took no time.
TEST(ProgressLine, TakesTheRateFromWhatWasDoneSinceTheClockRan) {
  EXPECT_EQ(text_of({"printing", "layers", 40, 50, 30, 20}, 80),
            "printing [########################      ] 40/50 layers, 0.50/s, 0:20 left");
}

TEST(ProgressLine, StaysWithinTheTerminal) {
  EXPECT_EQ(text_of(kHalf, 50), "scoring 10/20 layers, 5.0/s, 0:02 left");
  EXPECT_EQ(text_of(kHalf, 20), "scoring 10/20 layer");
  for (int columns = 1; columns < 90; ++columns) {
    EXPECT_LE(static_cast<int>(text_of(kHalf, columns).size()), std::max(1, columns - 1));
  }
}

TEST(ProgressLine, CountsHoursToo) {
  EXPECT_THAT(text_of({"printing", "layers", 1, 1001, 0, 10}, 100),
              testing::EndsWith("0.10/s, 2:46:40 left"));
}

TEST(Stage, CountsWhatAllThreadsHaveDone) {
  Stage stage(Work(), "work", 4000, "pieces");
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&stage] {
      for (int k = 0; k < 1000; ++k) stage.advance();
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(stage.done(), 4000);
}

TEST(Console, PaintsNothingWhereStderrIsNoTerminal) {
  testing::internal::CaptureStderr();
  {
    const Console console;
    Stage stage(console.work(), "work", 3, "pieces");
    for (int i = 0; i < 3; ++i) stage.advance();
  }
  EXPECT_THAT(testing::internal::GetCapturedStderr(), IsEmpty());
}

}  // namespace
}  // namespace binderjet
