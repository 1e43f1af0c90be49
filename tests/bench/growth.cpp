// SPDX-License-Identifier: GPL-3.0-or-later
// How time and memory of `slice` grow with triangles, height, bed area and threads.
//
// Slicing should cost its boundary: for each way to make masks the seconds above those of the
// smallest part are fitted as boundary voxels times log2(triangles) to a power, over all parts.
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <exception>
#include <numbers>
#include <string>
#include <vector>

#include "slicer/coupon/coupon.h"
#include "slicer/mesh/mesh.h"
#include "tests/bench/run.h"

namespace binderjet::bench {
namespace {

// A ball with waves, of about `triangles` triangles, pulled to `size_mm`.
Mesh wavy_ball(int triangles, std::array<double, 3> size_mm) {
  const int rows = static_cast<int>(std::lround(std::sqrt(triangles / 4.0)));
  const int columns = 2 * rows;
  Mesh mesh;
  const auto add = [&](double theta, double phi) {
    const double wave = std::max(0.0, std::sin(24 * theta) * std::sin(24 * phi));
    const double r = (1 - 0.02 * wave * std::sin(theta)) / 2;
    mesh.points.push_back({size_mm[0] * r * std::sin(theta) * std::cos(phi),
                           size_mm[1] * r * std::sin(theta) * std::sin(phi),
                           size_mm[2] * r * std::cos(theta)});
  };
  add(0, 0);
  for (int row = 1; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      add(std::numbers::pi * row / rows, 2 * std::numbers::pi * column / columns);
    }
  }
  add(std::numbers::pi, 0);
  const int south = static_cast<int>(mesh.points.size()) - 1;
  const auto point = [&](int row, int column) {
    if (row == 0) return 0;
    return row == rows ? south : 1 + (row - 1) * columns + column % columns;
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int a = point(row, column);
      const int b = point(row + 1, column);
      const int c = point(row + 1, column + 1);
      const int d = point(row, column + 1);
      if (row + 1 < rows) mesh.triangles.push_back({a, b, c});
      if (row > 0) mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

// Inside voxels with a neighbor outside: a plane has one per voxel of its largest projection.
double boundary_voxels(const Mesh& mesh, const std::array<double, 3>& voxel_mm) {
  double count = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t i) {
      return mesh.points[static_cast<std::size_t>(triangle[i])];
    };
    const Point a = corner(0);
    Point u{};
    Point v{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      u[axis] = (corner(1)[axis] - a[axis]) / voxel_mm[axis];
      v[axis] = (corner(2)[axis] - a[axis]) / voxel_mm[axis];
    }
    count += std::max({std::abs(u[1] * v[2] - u[2] * v[1]), std::abs(u[2] * v[0] - u[0] * v[2]),
                       std::abs(u[0] * v[1] - u[1] * v[0])}) /
             2;
  }
  return count;
}

struct Case {
  const char* series;
  int triangles;
  std::array<double, 3> size_mm;
  int threads = 2;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"triangles", 10'000, {190, 190, 190}},    {"triangles", 100'000, {190, 190, 190}},
      {"triangles", 1'000'000, {190, 190, 190}}, {"triangles", 10'000'000, {190, 190, 190}},
      {"height", 100'000, {100, 100, 25}},       {"height", 100'000, {100, 100, 50}},
      {"height", 100'000, {100, 100, 100}},      {"height", 100'000, {100, 100, 200}},
      {"area", 100'000, {25, 25, 100}},          {"area", 100'000, {50, 50, 100}},
      {"area", 100'000, {100, 100, 100}},        {"area", 100'000, {190, 190, 100}},
      {"threads", 100'000, {190, 190, 100}, 1},  {"threads", 100'000, {190, 190, 100}, 2}};
  return all;
}

// The slope of a line through the points (x, y).
double slope(const std::vector<std::array<double, 2>>& points) {
  const double n = static_cast<double>(points.size());
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [px, py] : points) {
    x += px;
    y += py;
    xx += px * px;
    xy += px * py;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

void run_mode(const std::string& enhance) {
  constexpr std::array<double, 3> kVoxelMm = {25.4 / 600, 25.4 / 900, 0.051};
  const std::string profile = std::string(BINDERJET_SOURCE_DIR) + "/profiles/z450.toml";
  const auto sliced = [&](const Mesh& mesh, int threads) {
    const Workplace place;
    write_stl(mesh, place / "part.stl");
    return slice({place / "part.stl", "-p", profile, "--enhance", enhance, "--threads",
                  std::to_string(threads)});
  };
  const double start_s = sliced(wavy_ball(1000, {1, 1, 1}), 1).ran.seconds;
  fmt::print("--enhance {}: {:.2f} s for next to nothing\n", enhance, start_s);
  fmt::print("{:<10} {:>10} {:>15} {:>8} {:>9} {:>8} {:>9} {:>9}\n", "grows", "triangles", "mm",
             "threads", "Mboundary", "s", "CPU s", "peak MiB");
  std::vector<std::array<double, 2>> points;
  for (const Case& one : cases()) {
    const Mesh mesh = wavy_ball(one.triangles, one.size_mm);
    const double boundary = boundary_voxels(mesh, kVoxelMm);
    const SliceRun run = sliced(mesh, one.threads);
    fmt::print("{:<10} {:>10} {:>5}x{:>3}x{:>3} {:>10} {:>9.1f} {:>8.2f} {:>9.2f} {:>9.0f}\n",
               one.series, mesh.triangles.size(), one.size_mm[0], one.size_mm[1], one.size_mm[2],
               one.threads, boundary / 1e6, run.ran.seconds, run.ran.cpu_seconds,
               run.ran.peak_rss_mb);
    std::fflush(stdout);
    if (one.threads != 2) continue;
    const double work = boundary * std::log2(static_cast<double>(mesh.triangles.size()));
    points.push_back({std::log(work), std::log(run.ran.seconds - start_s)});
  }
  fmt::print("seconds grow as (boundary voxels x log triangles) ^ {:.2f}\n\n", slope(points));
}

}  // namespace
}  // namespace binderjet::bench

int main() {
  try {
    for (const char* enhance : {"none", "paper"}) binderjet::bench::run_mode(enhance);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
