// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/gauges/gauge_strip.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace binderjet {
namespace {

constexpr int kPlaces = 16;

// Pixels along one axis that are solid where the gauge is not (slots) or is (walls), cut as the
// slicing operator does: a pixel is 1 iff at least half of its voxels are. One pixel with all its
// like neighbors has the same state, so one axis is enough.
std::vector<bool> pixels(const Grid& grid, GaugeKind kind, int axis, double low_mm, double high_mm,
                         int count) {
  const int detail = grid.detail_vx[static_cast<std::size_t>(axis)];
  std::vector<bool> out;
  for (int i = 0; i < count; ++i) {
    int solid = 0;
    for (int v = i * detail; v < (i + 1) * detail; ++v) {
      const double center = grid.center_mm(axis, v);
      const bool in_gauge = center >= low_mm && center < high_mm;
      if (in_gauge == (kind == GaugeKind::kWall)) ++solid;
    }
    out.push_back(2 * solid >= detail);
  }
  return out;
}

RunLayer block(int width, int height, bool solid) {
  RunLayer layer(width);
  for (int y = 0; y < height; ++y) {
    layer.append_row(solid ? std::vector<int>{0, width} : std::vector<int>{});
  }
  return layer;
}

// Pixels that a model needs on each side of what is looked at: its reach, and a little air.
std::array<int, 2> margin_px(const PrinterModel& model, const Grid& grid) {
  return {model.reach().xy_vx[0] / grid.detail_vx[0] + 2,
          model.reach().xy_vx[1] / grid.detail_vx[1] + 2};
}

// The printed voxels along x or y through the middle of a gauge that all layers share.
std::vector<bool> print_line(const PrinterModel& model, const Grid& grid, int axis,
                             const std::vector<bool>& line) {
  const auto margin = margin_px(model, grid);
  const int across = 2 * margin[static_cast<std::size_t>(1 - axis)] + 1;
  const int length = static_cast<int>(line.size());
  RunLayer mask(axis == 0 ? length : across);
  for (int y = 0; y < (axis == 0 ? across : length); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      if (!line[static_cast<std::size_t>(axis == 0 ? x : y)]) continue;
      mask.flip(x);
      mask.flip(x + 1);
    }
    mask.end_row();
  }
  // A gauge along x or y stands over many layers, so those around this one are like it.
  const RunLayer printed =
      model.print(RunWindow::around(model.window_reach(), [&](int) { return &mask; }));
  std::vector<bool> out;
  const int voxels = axis == 0 ? printed.width() : printed.height();
  for (int v = 0; v < voxels; ++v) {
    out.push_back(axis == 0 ? printed.at(v, printed.height() / 2)
                            : printed.at(printed.width() / 2, v));
  }
  return out;
}

// The printed layers through the middle of a gauge of whole layers.
std::vector<bool> print_column(const PrinterModel& model, const Grid& grid,
                               const std::vector<bool>& column) {
  const auto margin = margin_px(model, grid);
  const RunLayer solid = block(2 * margin[0] + 1, 2 * margin[1] + 1, true);
  const RunLayer powder = block(2 * margin[0] + 1, 2 * margin[1] + 1, false);
  const int reach = model.window_reach();
  const int layers = static_cast<int>(column.size());
  std::map<std::vector<bool>, bool> seen;  // few of the windows differ
  std::vector<bool> out;
  for (int k = 0; k < layers; ++k) {
    std::vector<bool> states;
    for (int i = k - reach; i <= k + reach; ++i) {
      states.push_back(column[static_cast<std::size_t>(std::clamp(i, 0, layers - 1))]);
    }
    const auto [place, is_new] = seen.try_emplace(states, false);
    if (is_new) {
      const RunLayer printed = model.print(RunWindow::around(reach, [&](int offset) {
        return states[static_cast<std::size_t>(reach + offset)] ? &solid : &powder;
      }));
      place->second = printed.at(printed.width() / 2, printed.height() / 2);
    }
    out.push_back(place->second);
  }
  return out;
}

}  // namespace

GaugePrint print_gauge(const PrinterModel& model, const Grid& grid, GaugeKind kind, int axis,
                       double width_mm) {
  const auto a = static_cast<std::size_t>(axis);
  const double pitch = grid.pitch_mm[a];
  const int margin = 2 * (axis == 2 ? model.window_reach() + 2 : margin_px(model, grid)[a]);
  const int count = 2 * margin + static_cast<int>(std::ceil(width_mm / pitch)) + 1;
  // A layer's printed slices are equal, so along z a sample is a layer.
  const double sample_mm = axis == 2 ? pitch : grid.voxel_mm(axis);
  GaugePrint print;
  for (int place = 0; place < kPlaces; ++place) {
    const double low = (margin + (place + 0.5) / kPlaces) * pitch;
    const std::vector<bool> line = pixels(grid, kind, axis, low, low + width_mm, count);
    const std::vector<bool> printed =
        axis == 2 ? print_column(model, grid, line) : print_line(model, grid, axis, line);
    // Near the ends of the line binder from beyond is missing, so only what lies deeper counts.
    const std::ptrdiff_t detail = axis == 2 ? 1 : grid.detail_vx[a];
    const std::ptrdiff_t edge = detail * (margin / 2);
    const auto shown =
        std::count(printed.begin() + edge, printed.end() - edge, kind == GaugeKind::kWall);
    print.mean_mm += static_cast<double>(shown) * sample_mm / kPlaces;
    print.visible_share += shown > 0 ? 1.0 / kPlaces : 0;
  }
  return print;
}

double visible_from_mm(const PrinterModel& model, const Grid& grid, GaugeKind kind, int axis,
                       double max_mm) {
  const auto shows = [&](double width) {
    return print_gauge(model, grid, kind, axis, width).visible_share >= 0.5;
  };
  if (!shows(max_mm)) return max_mm;
  double hidden = 0;
  double visible = max_mm;
  const double close_enough = grid.pitch_mm[static_cast<std::size_t>(axis)] / 64;
  while (visible - hidden > close_enough) {
    const double middle = (hidden + visible) / 2;
    (shows(middle) ? visible : hidden) = middle;
  }
  return (hidden + visible) / 2;
}

}  // namespace binderjet
