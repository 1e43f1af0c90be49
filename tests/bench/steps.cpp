// SPDX-License-Identifier: GPL-3.0-or-later
// Each step of the slicer by itself, on layers across a golf ball that fills the bed.
//
// Every figure is for one layer on one core; `layers/s` is its inverse.
#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <memory>
#include <vector>

#include "slicer/coupon.h"
#include "slicer/effects/model.h"
#include "slicer/enhance/paper_rule.h"
#include "slicer/masks.h"
#include "slicer/mesh/place.h"
#include "slicer/score.h"
#include "slicer/slicing_operator.h"
#include "slicer/stack/png.h"
#include "transport/job_file.h"

namespace binderjet {
namespace {

constexpr double kHeightMm = 190;
constexpr int kLayers = 24;

Grid z450() { return {{25.4 / 300, 25.4 / 450, 0.102}, {2, 2, 2}}; }

std::shared_ptr<const PrinterModel> declared_model() {
  EffectSpec spread{"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.3}}}};
  EffectSpec threshold{"threshold", {}, {{"level", {0.5}}}};
  return std::make_shared<const PrinterModel>(std::vector{spread, threshold}, z450());
}

// Layers of the ball a quarter up, where its outline is neither steep nor flat, and what the first
// pass sees of them.
struct Layers {
  Layers() {
    Mesh mesh = coupon("golfball");
    Placement placement;
    placement.scale = kHeightMm / bounding_box(mesh).size(2);
    transform_part(mesh, placement, "golfball");
    part = std::make_shared<const Mesh>(std::move(mesh));
    box = job_box(bounding_box(*part), grid, {0, 0}, model->reach().xy_vx);
    first = box.size_px[2] / 4;
    target = voxelize(part, grid, box, range())->next(kLayers);
    for (const auto& layer : target) {
      masks.push_back(slicing_operator(*layer, grid));
      passes.push_back({layer, layer, model->print(masks.back())});
    }
  }
  LayerRange range() const { return {first, first + kLayers}; }

  Grid grid = z450();
  std::shared_ptr<const PrinterModel> model = declared_model();
  std::shared_ptr<const Mesh> part;
  JobBox box;
  int first = 0;
  std::vector<Shared<VoxelLayer>> target;
  std::vector<RunLayer> masks;
  std::vector<PassLayer> passes;
};

const Layers& ball() {
  static const Layers layers;
  return layers;
}

// Runs work(i) for one layer after the other.
template <class Work>
void per_layer(benchmark::State& state, Work work) {
  ball();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(work(1 + i));
    i = (i + 1) % (kLayers - 2);
  }
  state.counters["layers/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void voxelize_layers(benchmark::State& state) {
  const Layers& layers = ball();
  std::int64_t count = 0;
  for (auto _ : state) {
    state.PauseTiming();  // sorting the triangles is done once a job
    const auto stream = voxelize(layers.part, layers.grid, layers.box, layers.range());
    state.ResumeTiming();
    benchmark::DoNotOptimize(stream->next(kLayers));
    count += kLayers;
  }
  state.counters["layers/s"] =
      benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsRate);
}

void slice_layer(benchmark::State& state) {
  per_layer(state, [](std::size_t i) { return slicing_operator(*ball().target[i], ball().grid); });
}

void print_layer(benchmark::State& state) {
  per_layer(state, [](std::size_t i) { return ball().model->print(ball().masks[i]); });
}

void apply_rule(benchmark::State& state) {
  per_layer(state, [](std::size_t i) {
    const auto& passes = ball().passes;
    return paper_rule(&passes[i - 1], passes[i], &passes[i + 1]);
  });
}

void score_layer(benchmark::State& state) {
  per_layer(state, [](std::size_t i) {
    return count_voxels(*ball().target[i], ball().passes[i].printed);
  });
}

void encode_png(benchmark::State& state) {
  per_layer(state, [](std::size_t i) {
    const RunLayer& mask = ball().masks[i];
    return encode_png_mask(pack(mask), mask.width(), mask.height(),
                           {ball().grid.pitch_mm[0], ball().grid.pitch_mm[1]});
  });
}

void encode_job_record(benchmark::State& state) {
  per_layer(state, [](std::size_t i) {
    return encode_record(RecordKind::kMask, static_cast<int>(i), pack(ball().masks[i]));
  });
}

BENCHMARK(voxelize_layers)->Unit(benchmark::kMicrosecond);
BENCHMARK(slice_layer)->Unit(benchmark::kMicrosecond);
BENCHMARK(print_layer)->Unit(benchmark::kMicrosecond);
BENCHMARK(apply_rule)->Unit(benchmark::kMicrosecond);
BENCHMARK(score_layer)->Unit(benchmark::kMicrosecond);
BENCHMARK(encode_png)->Unit(benchmark::kMicrosecond);
BENCHMARK(encode_job_record)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace binderjet

int main(int argc, char** argv) {
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
