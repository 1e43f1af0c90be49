// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/residual/printed_error.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "slicer/layers/rows.h"

namespace binderjet {

int slab_of(int at, int count) { return std::clamp(kSlabs * at / count, 0, kSlabs - 1); }

int cell_of(int slab_x, int slab_y, int slab_z) {
  return (slab_z * kSlabs + slab_y) * kSlabs + slab_x;
}

int slab_of_cell(int cell, int axis) {
  return axis == 0 ? cell % kSlabs : axis == 1 ? cell / kSlabs % kSlabs : cell / kSlabs / kSlabs;
}

ColumnCounts wrong_in_layer(const MeasuredJob& job, int layer, const RunLayer& printed) {
  ColumnCounts out{};
  const int width = printed.width();
  std::vector<int> row;
  for (const auto& print : job.prints) {
    const RunLayer& measured = *print[static_cast<std::size_t>(layer)];
    for (int y = 0; y < printed.height(); ++y) {
      rows::difference(printed.row(y), measured.row(y), row);
      std::int64_t* columns = out.data() + std::ptrdiff_t{kSlabs} * slab_of(y, printed.height());
      for (std::size_t i = 0; i < row.size(); i += 2) {
        // Runs are short beside a slab: the middle says where one is.
        columns[slab_of((row[i] + row[i + 1]) / 2, width)] += row[i + 1] - row[i];
      }
    }
  }
  return out;
}

WrongCounts wrong_counts(const MeasuredJob& job, const std::vector<Shared<RunLayer>>& printed) {
  WrongCounts out(printed.size());
  oneapi::tbb::parallel_for(0, job.layers(), [&](int layer) {
    const auto k = static_cast<std::size_t>(layer);
    if (printed[k] != nullptr) out[k] = wrong_in_layer(job, layer, *printed[k]);
  });
  return out;
}

std::int64_t sum_of(const WrongCounts& counts) {
  std::int64_t sum = 0;
  for (const ColumnCounts& layer : counts) {
    for (const std::int64_t count : layer) sum += count;
  }
  return sum;
}

std::vector<double> gains(const WrongCounts& before, const WrongCounts& after) {
  std::vector<double> out(kCells, 0);
  const int layers = static_cast<int>(before.size());
  for (int k = 0; k < layers; ++k) {
    for (int column = 0; column < kSlabs * kSlabs; ++column) {
      const auto c = static_cast<std::size_t>(column);
      const auto l = static_cast<std::size_t>(k);
      out[static_cast<std::size_t>(
          cell_of(column % kSlabs, column / kSlabs, slab_of(k, layers)))] +=
          static_cast<double>(before[l][c] - after[l][c]);
    }
  }
  return out;
}

double wrong_share(const MeasuredJob& job, const EffectList& model, const LayerChoice& layers) {
  const auto printed = print_layers(job, model, layers);
  std::int64_t solid = 0;
  for (std::size_t k = 0; k < printed.size(); ++k) {
    if (printed[k] == nullptr) continue;
    for (const auto& print : job.prints) solid += print[k]->count();
  }
  return static_cast<double>(sum_of(wrong_counts(job, printed))) /
         std::max<double>(1, static_cast<double>(solid));
}

}  // namespace binderjet
