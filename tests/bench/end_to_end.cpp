// SPDX-License-Identifier: GPL-3.0-or-later
// The whole program on golf balls, from the mesh to the job: one line for each way to make masks.
#include <fmt/core.h>

#include <exception>
#include <string>
#include <vector>

#include "slicer/coupon/coupon.h"
#include "tests/bench/run.h"

namespace binderjet::bench {
namespace {

using Words = std::vector<std::string>;

constexpr double kBallMm = 42.7;
constexpr double kBedMm = 190;  // as large as the Z450's bed takes

struct Mode {
  const char* name;
  Words words;
  const char* layers;  // of the large ball, where all would take long
};

const std::vector<Mode>& modes() {
  static const std::vector<Mode> all = {
      {"none", {"--enhance", "none"}, ""},
      {"paper", {"--enhance", "paper"}, ""},
      {"paper, colored", {"--enhance", "paper", "--color-enhance"}, "900:960"},
      {"inverse", {"--enhance", "inverse"}, "900:960"}};
  return all;
}

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void report(double height_mm, const Mode& mode, const SliceRun& run, const std::string& excess) {
  const auto& size = run.result["size_px"];
  constexpr double kVoxelsPerPixel = 8;
  const double layers = run.result["layers"];
  const double voxels = size[0].get<double>() * size[1].get<double>() * layers * kVoxelsPerPixel;
  fmt::print(
      "golf ball {:5.1f} mm  {:<15}{:5} layers {:7.2f} s {:7.1f} layers/s {:8.1f} Mvoxels/s  "
      "first layer {:.2f} s  peak {:3.0f} MiB  excess {}\n",
      height_mm, mode.name, layers, run.ran.seconds, layers / run.ran.seconds,
      voxels / run.ran.seconds / 1e6, run.first_layer_s, run.ran.peak_rss_mb, excess);
  std::fflush(stdout);
}

void run() {
  const Workplace place;
  const std::string ball = place / "ball.stl";
  write_stl(coupon(CouponKind::kGolfBall), ball);
  const Words profile = {ball, "-p", std::string(BINDERJET_SOURCE_DIR) + "/profiles/z450.toml"};
  for (const Mode& mode : modes()) {
    const Words words = joined(profile, mode.words);
    report(kBallMm, mode, slice(words), fmt::format("{:.4f}", excess(words)));
  }
  for (const Mode& mode : modes()) {
    Words words =
        joined(joined(profile, mode.words), {"--scale", fmt::format("{}", kBedMm / kBallMm)});
    if (*mode.layers != '\0') words = joined(words, {"--layers", mode.layers});
    report(kBedMm, mode, slice(words), "-");
  }
}

}  // namespace
}  // namespace binderjet::bench

int main() {
  try {
    binderjet::bench::run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
