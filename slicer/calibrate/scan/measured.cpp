// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/scan/measured.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>

#include "slicer/base/error.h"

namespace binderjet {
namespace {

constexpr double kMaxNoise = 0.1;  // of the contrast; half way is then five deviations off

// How a scan whose samples are whole voxels lies on the frame.
struct OnGrid {
  std::array<int, 2> repeat{};  // voxels per sample
  std::array<int, 3> offset{};  // of the scan's lower corner, in voxels and layers
};

std::optional<int> whole(double value) {
  const double nearest = std::round(value);
  if (std::abs(value - nearest) > 1e-4 || std::abs(nearest) > 1e6) return std::nullopt;
  return static_cast<int>(nearest);
}

std::optional<OnGrid> on_grid(const StackInfo& scan, const StackInfo& frame) {
  OnGrid grid;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto repeat = whole(scan.pitch_mm[a] / frame.pitch_mm[a]);
    const auto offset = whole((scan.origin_mm[a] - frame.origin_mm[a]) / frame.pitch_mm[a]);
    // The whole stack must stay on the grid, not its first sample only.
    const double drift = scan.pitch_mm[a] / frame.pitch_mm[a] - repeat.value_or(0);
    if (!repeat || *repeat < 1 || !offset || std::abs(drift) * scan.size[a] > 1e-2) {
      return std::nullopt;
    }
    if (a < 2) grid.repeat[a] = *repeat;
    if (a == 2 && *repeat != 1) return std::nullopt;
    grid.offset[a] = *offset;
  }
  return grid;
}

RunLayer repeated(const RunLayer& layer, std::array<int, 2> repeat) {
  RunLayer out(layer.width() * repeat[0]);
  std::vector<int> row;
  for (int y = 0; y < layer.height(); ++y) {
    row.assign(layer.row(y).begin(), layer.row(y).end());
    for (int& flip : row) flip *= repeat[0];
    for (int i = 0; i < repeat[1]; ++i) out.append_row(row);
  }
  return out;
}

RunLayer layer_on_grid(const StackReader& scan, const OnGrid& grid, const StackInfo& frame, int k) {
  const int image = k - grid.offset[2];
  if (image < 0 || image >= scan.info().size[2]) {
    return RunLayer::powder(frame.size[0], frame.size[1]);
  }
  RunLayer layer = scan.read(image);
  if (grid.repeat != std::array{1, 1}) layer = repeated(layer, grid.repeat);
  if (grid.offset[0] == 0 && grid.offset[1] == 0 && layer.width() == frame.size[0] &&
      layer.height() == frame.size[1]) {
    return layer;
  }
  return window(layer, -grid.offset[0], -grid.offset[1], frame.size[0], frame.size[1]);
}

using Counts = std::array<std::int64_t, 256>;

// Between the two classes that differ most (Otsu, IEEE Trans. SMC 9:62, 1979).
int between_classes(const Counts& counts) {
  double total = 0;
  double sum = 0;
  for (std::size_t g = 0; g < counts.size(); ++g) {
    total += static_cast<double>(counts[g]);
    sum += static_cast<double>(g) * static_cast<double>(counts[g]);
  }
  double below = 0;
  double below_sum = 0;
  double best = -1;
  int split = 128;
  for (std::size_t g = 0; g + 1 < counts.size(); ++g) {
    below += static_cast<double>(counts[g]);
    below_sum += static_cast<double>(g) * static_cast<double>(counts[g]);
    if (below <= 0 || below >= total) continue;
    const double apart = below_sum / below - (sum - below_sum) / (total - below);
    const double variance = below * (total - below) * apart * apart;
    if (variance > best) {
      best = variance;
      split = static_cast<int>(g) + 1;
    }
  }
  return split;
}

// The median gray among [from, to).
double median(const Counts& counts, int from, int to) {
  std::int64_t all = 0;
  for (int g = from; g < to; ++g) all += counts[static_cast<std::size_t>(g)];
  std::int64_t seen = 0;
  for (int g = from; g < to; ++g) {
    const std::int64_t here = counts[static_cast<std::size_t>(g)];
    if (here > 0 && 2 * (seen + here) >= all) {
      // Within the bin as if its samples were spread evenly over it.
      return g - 0.5 +
             (0.5 * static_cast<double>(all) - static_cast<double>(seen)) /
                 static_cast<double>(here);
    }
    seen += here;
  }
  return from;
}

Grays find_grays(const StackReader& scan) {
  constexpr int kSlices = 9;
  Counts grays{};
  Counts steps{};  // between neighbors along x: noise almost everywhere, edges hardly anywhere
  const auto [width, height, count] = scan.info().size;
  for (int i = 0; i < std::min(kSlices, count); ++i) {
    const std::vector<std::uint8_t> values = scan.read_gray(
        count <= kSlices ? i : static_cast<int>(std::int64_t{i} * (count - 1) / (kSlices - 1)));
    for (std::size_t at = 0; at < values.size(); ++at) {
      ++grays[values[at]];
      if (at % static_cast<std::size_t>(width) != 0) {
        ++steps[static_cast<std::size_t>(std::abs(values[at] - values[at - 1]))];
      }
    }
  }
  Grays found;
  const int split = between_classes(grays);
  found.powder = std::max(0.0, median(grays, 0, split));
  found.solid = std::min(255.0, median(grays, split, 256));
  if (found.solid - found.powder < 1) found = {};  // one gray all over: empty or full
  found.half =
      scan.info().threshold_stated ? scan.info().threshold - 0.5 : (found.powder + found.solid) / 2;
  // A scan of two grays only has no noise that could be seen.
  const auto others = [&](int from, int to) {
    return std::count_if(grays.begin() + from, grays.begin() + to,
                         [](std::int64_t samples) { return samples > 0; }) > 1;
  };
  if (!others(0, split) && !others(split, 256)) return found;
  // The median absolute difference of two normal deviates is 0.6745 sqrt 2 deviations.
  constexpr double kDeviation = 1 / (0.6745 * std::numbers::sqrt2);
  found.noise = std::max(0.0, median(steps, 0, 256)) * kDeviation / (found.solid - found.powder);
  return found;
}

GrayPlane read_plane(const StackReader& scan, const Grays& grays, int image) {
  const StackInfo& info = scan.info();
  GrayPlane plane;
  plane.width = info.size[0];
  plane.height = info.size[1];
  plane.pitch_mm = {info.pitch_mm[0], info.pitch_mm[1]};
  plane.origin_mm = {info.origin_mm[0], info.origin_mm[1]};
  const std::vector<std::uint8_t> values = scan.read_gray(image);
  plane.values.reserve(values.size());
  for (const std::uint8_t value : values) {
    plane.values.push_back(
        static_cast<float>(0.5 + (value - grays.half) / (grays.solid - grays.powder)));
  }
  return plane;
}

RunLayer resampled(const GrayPlane& plane, const Pose& pose, const StackInfo& frame) {
  RunLayer layer(frame.size[0]);
  for (int y = 0; y < frame.size[1]; ++y) {
    const double y_mm = frame.origin_mm[1] + (y + 0.5) * frame.pitch_mm[1];
    const auto first = pose.in_scan(frame.origin_mm[0] + 0.5 * frame.pitch_mm[0], y_mm);
    const auto second = pose.in_scan(frame.origin_mm[0] + 1.5 * frame.pitch_mm[0], y_mm);
    layer.append_row_where([&](int x) {
      return plane.sample(first[0] + x * (second[0] - first[0]),
                          first[1] + x * (second[1] - first[1])) >= 0.5;
    });
  }
  return layer;
}

}  // namespace

Measured read_measured(const std::string& folder, const StackInfo& frame,
                       std::span<const RunLayer> predicted, const Work& work) {
  const StackReader reader(folder);
  if (reader.info().kind == StackKind::kColor) {
    throw Error(ErrorKind::kBadInput, folder, "is a stack of colors; a measured one is needed");
  }
  Measured measured;
  measured.layers.resize(static_cast<std::size_t>(frame.size[2]));
  const auto for_layers = [&](auto make) {
    Stage stage(work, "reading scan", frame.size[2], "layers");
    oneapi::tbb::parallel_for(0, frame.size[2], [&](int k) {
      measured.layers[static_cast<std::size_t>(k)] = make(k);
      stage.advance();
    });
  };
  measured.grays = find_grays(reader);
  if (const auto grid = on_grid(reader.info(), frame)) {
    for_layers([&](int k) { return layer_on_grid(reader, *grid, frame, k); });
    return measured;
  }
  const Scan scan{reader.info(), [&](int image) {
                    work.check();
                    return read_plane(reader, measured.grays, image);
                  }};
  measured.registration = register_scan(scan, predicted, frame, folder, work);
  const Pose& pose = measured.registration->pose;
  // White noise falls by 2 sqrt(pi) deviations of the blur, in samples.
  const double blur_mm = measured.grays.noise / kMaxNoise / (2 * std::sqrt(std::numbers::pi)) *
                         reader.info().pitch_mm[0];
  for_layers([&](int k) {
    const double low = frame.origin_mm[2] + k * frame.pitch_mm[2] + pose.shift_mm[2];
    const GrayPlane plane = scan.mean(low, low + frame.pitch_mm[2]);
    const bool noisy = measured.grays.noise > kMaxNoise;
    return resampled(noisy ? blurred(plane, blur_mm) : plane, pose, frame);
  });
  return measured;
}

}  // namespace binderjet
