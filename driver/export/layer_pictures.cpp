// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/export/layer_pictures.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "driver/job/print_colors.h"
#include "slicer/base/work.h"
#include "slicer/layers/rows.h"
#include "slicer/model/printer_model.h"
#include "slicer/stack/indexed_png.h"

namespace binderjet {
namespace {

enum Color : std::uint8_t { kPowder, kCorrect, kMissing, kExtra };
constexpr std::array<Rgb, 4> kPalette{kPowderColor, kCorrectColor, kMissingColor, kExtraColor};

RunLayer predicted(const PrinterModel& model, const MeasuredJob& job, int index) {
  const RunWindow window = runs_around(job.masks, index, model.window_reach());
  return model.print(window, job.first_layer + index);
}

std::int64_t unequal(const RunLayer& a, const RunLayer& b) {
  std::int64_t count = 0;
  std::vector<int> row;
  for (int y = 0; y < a.height(); ++y) {
    rows::difference(a.row(y), b.row(y), row);
    for (std::size_t i = 0; i < row.size(); i += 2) count += row[i + 1] - row[i];
  }
  return count;
}

struct Frame {
  int x0, y0, x1, y1;
};

// Around the print, with a little powder.
Frame frame_of(const RunLayer& print) {
  constexpr int kAir = 20;
  Frame frame{print.width(), print.height(), 0, 0};
  for (int y = 0; y < print.height(); ++y) {
    const rows::Row row = print.row(y);
    if (row.empty()) continue;
    frame = {std::min(frame.x0, row.front()), std::min(frame.y0, y), std::max(frame.x1, row.back()),
             y + 1};
  }
  if (frame.x0 >= frame.x1) return {0, 0, print.width(), print.height()};
  return {std::max(0, frame.x0 - kAir), std::max(0, frame.y0 - kAir),
          std::min(print.width(), frame.x1 + kAir), std::min(print.height(), frame.y1 + kAir)};
}

std::vector<std::byte> compared(const RunLayer& print, const RunLayer& prediction,
                                const Frame& frame, const Grid& grid) {
  const int width = frame.x1 - frame.x0;
  const int height = frame.y1 - frame.y0;
  std::vector<std::uint8_t> pixels(
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kPowder);
  std::vector<int> row;
  for (int y = 0; y < height; ++y) {
    std::uint8_t* const out = pixels.data() + static_cast<std::ptrdiff_t>(y) * width;
    const auto paint = [&](Color color) {
      for (std::size_t i = 0; i < row.size(); i += 2) {
        for (int x = std::max(row[i], frame.x0); x < std::min(row[i + 1], frame.x1); ++x) {
          out[x - frame.x0] = color;
        }
      }
    };
    const rows::Row printed = print.row(frame.y0 + y);
    const rows::Row wanted = prediction.row(frame.y0 + y);
    rows::intersect(printed, wanted, row);
    paint(kCorrect);
    rows::subtract(wanted, printed, row);
    paint(kMissing);
    rows::subtract(printed, wanted, row);
    paint(kExtra);
  }
  return encode_indexed_png(pixels, width, height, kPalette, {grid.voxel_mm(0), grid.voxel_mm(1)});
}

}  // namespace

LayerPictures picture_layer(const MeasuredJob& job, const std::vector<EffectSpec>& before,
                            const std::vector<EffectSpec>& after) {
  const PrinterModel models[] = {{before, job.grid, job.place}, {after, job.grid, job.place}};
  const auto count = static_cast<std::size_t>(job.layers());
  std::vector<std::array<std::int64_t, 2>> wrong(count);
  Stage stage(job.work, "drawing the report", job.layers(), "layers");
  oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
    for (std::size_t m = 0; m < 2; ++m) {
      wrong[k][m] = unequal(*job.prints.front()[k], predicted(models[m], job, static_cast<int>(k)));
    }
    stage.advance();
  });
  const auto gain = [](const std::array<std::int64_t, 2>& w) { return w[0] - w[1]; };
  auto shown = std::max_element(wrong.begin(), wrong.end(),
                                [&](const auto& a, const auto& b) { return gain(a) < gain(b); });
  if (gain(*shown) <= 0) shown = std::max_element(wrong.begin(), wrong.end());
  const auto index = static_cast<std::size_t>(shown - wrong.begin());
  const RunLayer& print = *job.prints.front()[index];
  const Frame frame = frame_of(print);
  const auto picture = [&](const PrinterModel& model) {
    return compared(print, predicted(model, job, static_cast<int>(index)), frame, job.grid);
  };
  const auto solid = static_cast<double>(std::max<std::int64_t>(1, print.count()));
  return {job.first_layer + static_cast<int>(index),
          picture(models[0]),
          picture(models[1]),
          (frame.x1 - frame.x0) * job.grid.voxel_mm(0),
          (frame.y1 - frame.y0) * job.grid.voxel_mm(1),
          static_cast<double>((*shown)[0]) / solid,
          static_cast<double>((*shown)[1]) / solid};
}

}  // namespace binderjet
