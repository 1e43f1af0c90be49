// SPDX-License-Identifier: GPL-3.0-or-later
// Each step of the slicer by itself, on layers across a golf ball that fills the bed.
//
// Every figure is for one layer on one core; `layers/s` is its inverse. `bytes/layer` are those
// that a step cannot but read and write, were each moved once; `of_memory` is the rate at which it
// moves them, as a share of what this core reaches when it does nothing but copy.
#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <memory>
#include <vector>

#include "slicer/coupon/coupon.h"
#include "slicer/enhance/masks.h"
#include "slicer/enhance/paper/paper_rule.h"
#include "slicer/mesh/place.h"
#include "slicer/model/printer_model.h"
#include "slicer/score/voxel_counts.h"
#include "slicer/stack/png.h"
#include "slicer/voxels/slicing_operator.h"
#include "transport/job/job_file.h"

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
    Mesh mesh = coupon(CouponKind::kGolfBall);
    Placement placement;
    placement.scale = kHeightMm / bounding_box(mesh).size(2);
    transform_part(mesh, placement, "golfball");
    part = std::make_shared<const Mesh>(std::move(mesh));
    box = job_box(bounding_box(*part).max, grid, {0, 0}, model->reach().xy_vx);
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

// Bytes a second, read and written, of a copy too large for any cache; the best of a few.
double copy_rate() {
  std::vector<char> from(std::size_t{256} << 20, 1);
  std::vector<char> to(from.size());
  double best = 0;
  for (int round = 0; round < 8; ++round) {
    const auto start = std::chrono::steady_clock::now();
    std::memcpy(to.data(), from.data(), from.size());
    benchmark::DoNotOptimize(to.data());
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    best = std::max(best, 2 * static_cast<double>(from.size()) / taken.count());
  }
  return best;
}

double bytes_of(const RunLayer& layer) {
  return static_cast<double>(layer.flip_count() * sizeof(int)) +
         static_cast<double>(layer.height()) * sizeof(std::size_t);
}
double bytes_of(const VoxelLayer& layer) {
  double bytes = 0;
  for (const RunLayer& slice : layer.slices) bytes += bytes_of(slice);
  return bytes;
}
double bytes_of(const VoxelCounts&) { return 0; }
double bytes_of(const std::vector<std::byte>& bytes) { return static_cast<double>(bytes.size()); }

void report(benchmark::State& state, double layers, double bytes) {
  static const double memory = copy_rate();
  using Counter = benchmark::Counter;
  state.counters["layers/s"] = Counter(layers, Counter::kIsRate);
  state.counters["bytes/layer"] = bytes / layers;
  state.counters["of_memory"] = Counter(bytes / memory, Counter::kIsRate);
}

// Runs work(i) for one layer after the other; read(i) are the bytes that it reads.
template <class Read, class Work>
void per_layer(benchmark::State& state, Read read, Work work) {
  ball();
  std::array<double, kLayers> bytes{};
  for (std::size_t i = 1; i + 1 < kLayers; ++i) bytes[i] = read(i) + bytes_of(work(i));
  std::size_t i = 0;
  double moved = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(work(1 + i));
    moved += bytes[1 + i];
    i = (i + 1) % (kLayers - 2);
  }
  report(state, static_cast<double>(state.iterations()), moved);
}

void voxelize_layers(benchmark::State& state) {
  const Layers& layers = ball();
  double count = 0;
  double moved = 0;
  double triangles = 0;  // bytes of those cut, each once: its corners' numbers and a point
  for (const Triangle& t : layers.part->triangles) {
    const double low = layers.grid.pitch_mm[2] * layers.first;
    const double high = layers.grid.pitch_mm[2] * (layers.first + kLayers);
    const auto z = [&](std::size_t c) {
      return layers.part->points[static_cast<std::size_t>(t[c])][2];
    };
    if (std::max({z(0), z(1), z(2)}) >= low && std::min({z(0), z(1), z(2)}) < high) {
      triangles += sizeof(Triangle) + sizeof(Point);
    }
  }
  for (auto _ : state) {
    state.PauseTiming();  // sorting the triangles is done once a job
    const auto stream = voxelize(layers.part, layers.grid, layers.box, layers.range());
    state.ResumeTiming();
    benchmark::DoNotOptimize(stream->next(kLayers));
    count += kLayers;
    moved += triangles;
    for (const auto& layer : layers.target) moved += bytes_of(*layer);
  }
  report(state, count, moved);
}

void slice_layer(benchmark::State& state) {
  per_layer(
      state, [](std::size_t i) { return bytes_of(*ball().target[i]); },
      [](std::size_t i) { return slicing_operator(*ball().target[i], ball().grid); });
}

void print_layer(benchmark::State& state) {
  per_layer(
      state, [](std::size_t i) { return bytes_of(ball().masks[i]); },
      [](std::size_t i) { return ball().model->print(ball().masks[i]); });
}

// The layers above and below stay in the cache for the next one.
void apply_rule(benchmark::State& state) {
  per_layer(
      state,
      [](std::size_t i) {
        return bytes_of(*ball().target[i]) + bytes_of(ball().passes[i].printed);
      },
      [](std::size_t i) {
        const auto& passes = ball().passes;
        return paper_rule(&passes[i - 1], passes[i], &passes[i + 1]);
      });
}

void score_layer(benchmark::State& state) {
  per_layer(
      state,
      [](std::size_t i) {
        return bytes_of(*ball().target[i]) + bytes_of(ball().passes[i].printed);
      },
      [](std::size_t i) { return count_voxels(*ball().target[i], ball().passes[i].printed); });
}

double packed_bytes() {
  return static_cast<double>(packed_row_bytes(ball().masks[0].width())) * ball().masks[0].height();
}

void pack_layer(benchmark::State& state) {
  per_layer(
      state, [](std::size_t i) { return bytes_of(ball().masks[i]); },
      [](std::size_t i) { return pack(ball().masks[i]); });
}

void encode_png(benchmark::State& state) {
  const RunLayer& mask = ball().masks[1];
  const std::vector<std::byte> bits = pack(mask);
  per_layer(
      state, [](std::size_t) { return packed_bytes(); },
      [&](std::size_t) {
        return encode_png_mask(bits, mask.width(), mask.height(),
                               {ball().grid.pitch_mm[0], ball().grid.pitch_mm[1]});
      });
}

void encode_job_record(benchmark::State& state) {
  const std::vector<std::byte> bits = pack(ball().masks[1]);
  per_layer(
      state, [](std::size_t) { return packed_bytes(); },
      [&](std::size_t i) { return encode_record(RecordKind::kMask, static_cast<int>(i), bits); });
}

BENCHMARK(voxelize_layers)->Unit(benchmark::kMicrosecond);
BENCHMARK(slice_layer)->Unit(benchmark::kMicrosecond);
BENCHMARK(print_layer)->Unit(benchmark::kMicrosecond);
BENCHMARK(apply_rule)->Unit(benchmark::kMicrosecond);
BENCHMARK(score_layer)->Unit(benchmark::kMicrosecond);
BENCHMARK(pack_layer)->Unit(benchmark::kMicrosecond);
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
