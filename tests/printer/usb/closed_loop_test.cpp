// SPDX-License-Identifier: GPL-3.0-or-later
// The loop closed: slice, print over USB on a printer whose physics no profile knows, measure,
// calibrate, slice for the calibrated profile, print again. The error against the part falls.
#include <fstream>
#include <vector>

#include "slicer/layers/rows.h"
#include "slicer/stack/slice_stack.h"
#include "tests/printer/emulator/printer_fixture.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

// The emulated printer (printed_volume.cpp) as its maker would declare it: drops wet 5 x 3 pixels,
// 7 of the 15 bind. That binder also sinks is not in here.
constexpr const char* kDeclared = R"(name = "emulated"
source = "driver/emulator/printed_volume.cpp, without what sinks"
[grid]
dpi = [300, 450]
layer_mm = [0.102]
detail_vx = [1, 1, 1]
[bed]
size_mm = [203, 254, 204]
[[effects]]
kind = "spread"
shape = "box"
width_mm = [0.42333333333333334, 0.16933333333333334]
[[effects]]
kind = "threshold"
level = 0.46
[speed]
layers_per_minute = [2, 4]
dry_minutes = 90
[device]
protocol = "binderjet-1"
usb = []
)";

// |a xor b| / |b| over both stacks, which have one grid.
double wrong(const std::string& a, const std::string& b) {
  const StackReader first(a);
  const StackReader second(b);
  EXPECT_EQ(first.info().size, second.info().size);
  std::int64_t unequal = 0;
  std::int64_t solid = 0;
  std::vector<int> row;
  for (int k = 0; k < first.info().size[2]; ++k) {
    const RunLayer x = first.read(k);
    const RunLayer y = second.read(k);
    for (int j = 0; j < y.height(); ++j) {
      rows::difference(x.row(j), y.row(j), row);
      for (std::size_t i = 0; i < row.size(); i += 2) unequal += row[i + 1] - row[i];
    }
    solid += y.count();
  }
  return static_cast<double>(unequal) / static_cast<double>(solid);
}

class ClosedLoop : public PrinterTest {
 protected:
  ClosedLoop() { setenv("BINDERJET_STATE", (folder_ / "state").c_str(), 1); }

  void run(const std::vector<std::string>& words) {
    const Ran ran = place_.run(words);
    ASSERT_EQ(ran.status, 0) << words.front() << ": " << ran.err;
  }
  // Slices the part for a profile, prints it over USB, and measures the print; the names of the
  // stacks are `name` and what they hold.
  void print(const std::string& profile, const std::string& name) {
    const std::string job = place_ / (name + ".bjob");
    run({"slice", place_ / "part.stl", "-p", profile, "--enhance", "paper", "--scale", "0.6", "-o",
         job});
    setenv("LD_PRELOAD", "libumockdev-preload.so.0", 1);
    setenv("ASAN_OPTIONS", "verify_asan_link_order=0:detect_leaks=0", 1);
    run({"print", job, "--to", "usb:"});
    unsetenv("LD_PRELOAD");
    ASSERT_TRUE(printer_.jobs().back().done);
    write_measured(print_volume(printer_.jobs().back()), place_ / (name + ".measured"));
    run({"export", job, "--what", "target", "-o", place_ / (name + ".target")});
    run({"simulate", job, "-p", profile, "-o", place_ / (name + ".printed")});
  }
  double off_part(const std::string& name) const {
    return wrong(place_ / (name + ".measured"), place_ / (name + ".target"));
  }
  double off_prediction(const std::string& name) const {
    return wrong(place_ / (name + ".printed"), place_ / (name + ".measured"));
  }

  Workplace place_;
};

TEST_F(ClosedLoop, PrintsNearerToThePartOnceCalibrated) {
  std::ofstream(place_ / "declared.toml") << kDeclared;
  run({"coupon", "--kind", "full", "-o", place_ / "part.stl"});
  print(place_ / "declared.toml", "first");
  run({"calibrate", "-p", place_ / "declared.toml", "--job", place_ / "first.bjob", "--measured",
       place_ / "first.measured", "-o", place_ / "calibration"});
  if (HasFatalFailure()) return;
  const auto found = nlohmann::json::parse(place_.text("calibration/calibration.json"));
  std::printf("verdict %s: %s\n", found["verdict"].get<std::string>().c_str(),
              found["effects"].dump().c_str());
  std::fflush(stdout);  // or every child that is forked says it again
  ASSERT_TRUE(found["profile"].is_string());
  print(place_ / ("calibration/" + found["profile"].get<std::string>()), "second");
  std::printf(
      "declared model against its print %.4f, calibrated model against its print %.4f\n"
      "print against the part: %.4f before, %.4f after\n",
      off_prediction("first"), off_prediction("second"), off_part("first"), off_part("second"));
  EXPECT_LT(off_prediction("second"), 0.5 * off_prediction("first"));
  EXPECT_LT(off_part("second"), off_part("first"));
}

}  // namespace
}  // namespace binderjet
