// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C ends a calibration at once and leaves nothing half-written.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <mutex>
#include <thread>

#include "slicer/base/error.h"
#include "slicer/calibrate/calibrate.h"
#include "slicer/stack/slice_stack.h"
#include "tests/hidden_printers/hidden_printer.h"
#include "tests/support/listener.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

MeasuredJob printed_job() {
  hidden::Printer printer;
  printer.bleed_down = 0.2;
  MeasuredJob job = hidden::part("a", {9, 9, 1.7}, 0);
  hidden::print(printer, job, 1);
  return job;
}

void write_layers(const std::string& folder, const MeasuredJob& job, StackKind kind,
                  const std::vector<Shared<RunLayer>>& layers) {
  StackInfo info;
  info.kind = kind;
  info.size = {layers.front()->width(), layers.front()->height(), job.layers()};
  info.pitch_mm = job.grid.pitch_mm;
  if (kind == StackKind::kMeasured) {
    for (int axis = 0; axis < 2; ++axis) {
      info.pitch_mm[static_cast<std::size_t>(axis)] = job.grid.voxel_mm(axis);
    }
  }
  info.files = "layer_%06d.png";
  StackWriter stack(folder, info);
  for (int k = 0; k < job.layers(); ++k) stack.write(k, *layers[static_cast<std::size_t>(k)]);
  stack.finish();
}

// Computing time rather than time: other programs do not count.
TEST(Interrupt, IsAskedForWithinASecondOfComputingThroughoutACalibration) {
  MeasuredJob job = printed_job();
  std::mutex mutex;
  std::clock_t last = std::clock();
  std::clock_t longest = 0;
  Listener listener;
  job.work = Work(listener);
  listener.on_check = [&] {
    const std::lock_guard<std::mutex> lock(mutex);
    const std::clock_t now = std::clock();
    longest = std::max(longest, now - last);
    last = now;
  };
  calibrate(job, {}, hidden::declared(), {});
  EXPECT_LT(static_cast<double>(longest) / CLOCKS_PER_SEC, 1);
}

TEST(Interrupt, EndsACalibrationFromWhereverItIsAsked) {
  MeasuredJob job = printed_job();
  for (const int calls : {1, 50, 700, 5000}) {
    std::atomic<int> left = calls;
    Listener listener;
    job.work = Work(listener);
    listener.on_check = [&] {
      if (--left <= 0) throw Error(ErrorKind::kInterrupted, "", "enough");
    };
    EXPECT_THROW(calibrate(job, {}, hidden::declared(), {}), Error) << calls;
  }
}

TEST(Interrupt, LeavesNothingHalfWritten) {
  const Workplace place;
  const MeasuredJob job = printed_job();
  write_layers(place / "masks", job, StackKind::kMask, job.masks);
  write_layers(place / "print", job, StackKind::kMeasured, job.prints.front());
  const Ran ran = place.run({"calibrate", "-p", "z450", "--job", place / "masks", "--measured",
                             place / "print", "-o", place / "out"},
                            600, 0, [](pid_t program) {
                              std::this_thread::sleep_for(std::chrono::milliseconds(700));
                              kill(program, SIGINT);
                            });
  EXPECT_EQ(ran.status, 130) << ran.err;
  const std::filesystem::path out = place / "out";
  EXPECT_TRUE(!std::filesystem::exists(out) || std::filesystem::is_empty(out));
}

}  // namespace
}  // namespace binderjet
