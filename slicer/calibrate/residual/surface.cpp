// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/residual/surface.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace binderjet {
namespace {

// One layer's voxels, a byte each, padded by nothing: columns are read as easily as rows.
std::vector<std::uint8_t> bytes_of(const RunLayer& layer) {
  std::vector<std::uint8_t> out(
      static_cast<std::size_t>(layer.width()) * static_cast<std::size_t>(layer.height()), 0);
  for (int y = 0; y < layer.height(); ++y) {
    const std::span<const int> row = layer.row(y);
    std::uint8_t* to = out.data() + static_cast<std::ptrdiff_t>(y) * layer.width();
    for (std::size_t i = 0; i < row.size(); i += 2) std::fill(to + row[i], to + row[i + 1], 1);
  }
  return out;
}

// A well-mixed number from a place, so that points are picked evenly but without a pattern.
std::uint32_t mixed(std::uint32_t layer, std::uint32_t x, std::uint32_t y, std::uint32_t axis) {
  std::uint32_t h = layer * 0x9e3779b1U ^ x * 0x85ebca6bU ^ y * 0xc2b2ae35U ^ axis * 0x27d4eb2fU;
  h ^= h >> 15;
  h *= 0x2c1b3c6dU;
  h ^= h >> 12;
  h *= 0x297a2d39U;
  return h ^ (h >> 15);
}

// The nearest offset at which `solid` changes from `sign` > 0 ? 1 to 0 : 0 to 1 between `at` and
// the next voxel; none within `reach`: reach + 1.
template <class Solid>
int nearest_edge(Solid solid, int at, int count, int sign, int reach) {
  const auto is_edge = [&](int i) {
    if (i < 0 || i + 1 >= count) return false;
    const int change = static_cast<int>(solid(i)) - static_cast<int>(solid(i + 1));
    return change == sign;
  };
  for (int d = 0; d <= reach; ++d) {
    if (is_edge(at + d)) return d;
    if (is_edge(at - d)) return -d;
  }
  return reach + 1;
}

struct LayerPoints {
  std::vector<SurfacePoint> points;
  std::vector<double> offsets;  // per point and replicate
};

LayerPoints pair_layer(const MeasuredJob& job, int index, const RunLayer& printed,
                       std::array<int, 2> reach_vx, std::uint32_t keep_below) {
  const std::vector<std::uint8_t> model = bytes_of(printed);
  std::vector<std::vector<std::uint8_t>> measured;
  for (const auto& print : job.prints) {
    measured.push_back(bytes_of(*print[static_cast<std::size_t>(index)]));
  }
  const int width = printed.width();
  const int height = printed.height();
  LayerPoints out;
  std::vector<double> offsets;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::ptrdiff_t here = static_cast<std::ptrdiff_t>(y) * width + x;
      for (int axis = 0; axis < 2; ++axis) {
        if (axis == 0 ? x + 1 >= width : y + 1 >= height) continue;
        const std::ptrdiff_t step = axis == 0 ? 1 : width;
        const int sign =
            model[static_cast<std::size_t>(here)] - model[static_cast<std::size_t>(here + step)];
        if (sign == 0) continue;
        if (mixed(static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(x),
                  static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(axis)) > keep_below) {
          continue;
        }
        offsets.clear();
        const int at = axis == 0 ? x : y;
        for (const auto& print : measured) {
          const int offset = nearest_edge(
              [&](int i) { return print[static_cast<std::size_t>(here + (i - at) * step)]; }, at,
              axis == 0 ? width : height, sign, reach_vx[static_cast<std::size_t>(axis)]);
          if (offset <= reach_vx[static_cast<std::size_t>(axis)]) offsets.push_back(offset);
        }
        if (offsets.size() != measured.size()) continue;
        out.points.push_back({index, x, y, axis, sign, 0, 0});
        out.offsets.insert(out.offsets.end(), offsets.begin(), offsets.end());
      }
    }
  }
  return out;
}

DoseProbe probe_of(const MeasuredJob& job, const std::vector<EffectSpec>& model) {
  return {PrinterModel(model, job.grid, job.place).form(), job.grid, job.place};
}

}  // namespace

RunWindow mask_window(const MeasuredJob& job, int index, int reach) {
  return runs_around(job.masks, index, reach);
}

std::vector<Shared<RunLayer>> bound_layers(const MeasuredJob& job, const PrinterModel& printer,
                                           const LayerChoice& layers) {
  const int around = printer.wear_reach();
  std::vector<Shared<RunLayer>> bound(job.masks.size());
  oneapi::tbb::parallel_for(0, job.layers(), [&](int index) {
    const auto first = layers.begin() + std::max(0, index - around);
    const auto last = layers.begin() + std::min(job.layers(), index + around + 1);
    if (std::find(first, last, true) == last) return;
    job.work.check();
    const RunWindow window = mask_window(job, index, printer.bind_reach());
    bound[static_cast<std::size_t>(index)] =
        std::make_shared<const RunLayer>(printer.bind(window, job.first_layer + index));
  });
  return bound;
}

std::vector<Shared<RunLayer>> worn_layers(const MeasuredJob& job, const PrinterModel& printer,
                                          const std::vector<Shared<RunLayer>>& bound,
                                          const LayerChoice& layers) {
  std::vector<Shared<RunLayer>> out(job.masks.size());
  oneapi::tbb::parallel_for(0, job.layers(), [&](int index) {
    if (!layers[static_cast<std::size_t>(index)]) return;
    job.work.check();
    out[static_cast<std::size_t>(index)] = std::make_shared<const RunLayer>(
        printer.worn(runs_around(bound, index, printer.wear_reach())));
  });
  return out;
}

std::vector<Shared<RunLayer>> print_layers(const MeasuredJob& job,
                                           const std::vector<EffectSpec>& model,
                                           const LayerChoice& layers) {
  const PrinterModel printer(model, job.grid, job.place);
  auto bound = bound_layers(job, printer, layers);
  return printer.form().wear.empty() ? bound : worn_layers(job, printer, bound, layers);
}

std::vector<SurfacePoint> surface_points(const MeasuredJob& job,
                                         const std::vector<EffectSpec>& model,
                                         const LayerChoice& layers, int max_points,
                                         double reach_mm) {
  const auto printed = print_layers(job, model, layers);
  std::int64_t edges = 0;
  for (const auto& layer : printed) {
    // About as many edges lie along y as the flips along x say.
    if (layer != nullptr) edges += 2 * static_cast<std::int64_t>(layer->flip_count());
  }
  const double keep = std::min(1.0, max_points / std::max(1.0, static_cast<double>(edges)));
  const auto keep_below = static_cast<std::uint32_t>(keep * 4294967295.0);
  const std::array<int, 2> reach_vx{pixels_for(reach_mm, job.grid.voxel_mm(0)),
                                    pixels_for(reach_mm, job.grid.voxel_mm(1))};
  const PrinterModel printer(model, job.grid, job.place);
  const std::vector<Wear>& wear = printer.form().wear;
  const bool worn =
      std::any_of(wear.begin(), wear.end(), [](const Wear& step) { return !step.keeps_edges; });
  const DoseProbe probe(printer.form(), job.grid, job.place);
  std::vector<LayerPoints> of_layer(printed.size());
  oneapi::tbb::parallel_for(0, job.layers(), [&](int index) {
    const auto& layer = printed[static_cast<std::size_t>(index)];
    if (layer == nullptr) return;
    LayerPoints& mine = of_layer[static_cast<std::size_t>(index)];
    mine = pair_layer(job, index, *layer, reach_vx, keep_below);
    job.work.check();
    const std::size_t replicates = job.prints.size();
    std::vector<DosePlace> places;
    for (std::size_t i = 0; i < mine.offsets.size(); ++i) {
      places.push_back(mine.points[i / replicates].place(mine.offsets[i]));
    }
    // Where the part wears off, its surface is not where the dose is the level.
    if (worn) {
      for (const SurfacePoint& point : mine.points) places.push_back(point.place());
    }
    std::vector<double> margins(places.size());
    const RunWindow window = mask_window(job, index, probe.window_reach());
    probe.margins(window, job.first_layer + index, places, margins);
    for (std::size_t i = 0; i < mine.offsets.size(); ++i) {
      SurfacePoint& point = mine.points[i / replicates];
      if (worn) margins[i] -= margins[mine.offsets.size() + i / replicates];
      point.missing -= margins[i] / static_cast<double>(replicates);
      point.offset_vx += mine.offsets[i] / static_cast<double>(replicates);
    }
  });
  std::vector<SurfacePoint> points;
  for (LayerPoints& mine : of_layer) {
    points.insert(points.end(), mine.points.begin(), mine.points.end());
  }
  return points;
}

std::vector<double> margins_at(const MeasuredJob& job, const std::vector<EffectSpec>& model,
                               const std::vector<SurfacePoint>& points,
                               std::array<double, 2> offset_vx) {
  const DoseProbe probe = probe_of(job, model);
  std::vector<double> out(points.size());
  std::vector<std::size_t> begin(static_cast<std::size_t>(job.layers()) + 1, points.size());
  for (std::size_t i = points.size(); i-- > 0;)
    begin[static_cast<std::size_t>(points[i].layer)] = i;
  for (std::size_t k = begin.size() - 1; k-- > 0;) begin[k] = std::min(begin[k], begin[k + 1]);
  oneapi::tbb::parallel_for(0, job.layers(), [&](int index) {
    const std::size_t first = begin[static_cast<std::size_t>(index)];
    const std::size_t last = begin[static_cast<std::size_t>(index) + 1];
    if (first == last) return;
    job.work.check();
    std::vector<DosePlace> places;
    for (std::size_t i = first; i < last; ++i) {
      DosePlace place = points[i].place();
      place.x_vx += offset_vx[0];
      place.y_vx += offset_vx[1];
      places.push_back(place);
    }
    const RunWindow window = mask_window(job, index, probe.window_reach());
    probe.margins(window, job.first_layer + index, places,
                  std::span(out).subspan(first, last - first));
  });
  return out;
}

}  // namespace binderjet
