// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/report/score_sheet.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "driver/job/job_masks.h"
#include "driver/job/print_stream.h"
#include "driver/report/located_faults.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {
namespace {

// The excess under another model.
double excess(const MaskSource& masks, const JobHeader& header,
              const std::shared_ptr<const Mesh>& target, const PrinterModel& model,
              const Work& work, Stage& stage) {
  const auto wanted = voxelize(target, header.grid, header.box, masks.layers());
  const auto printed = printed_stream(masks, model, work);
  VoxelCounts counts;
  while (wanted->rest().size() > 0) {
    const auto slices = wanted->next(kBlockLayers);
    const auto layers = printed->next(kBlockLayers);
    for (std::size_t i = 0; i < slices.size(); ++i) counts += count_voxels(*slices[i], *layers[i]);
    stage.advance(static_cast<std::int64_t>(slices.size()));
  }
  return counts.excess();
}

MaskRegions regions_of(const MaskSource& masks, const Work& work) {
  Stage stage(work, "measuring masks", masks.size_px[2], "layers");
  return oneapi::tbb::parallel_reduce(
      oneapi::tbb::blocked_range<int>(0, masks.size_px[2]), MaskRegions{},
      [&](const oneapi::tbb::blocked_range<int>& layers, MaskRegions sum) {
        for (int k = layers.begin(); k < layers.end(); ++k) {
          sum += mask_regions(masks.read(k));
          stage.advance();
        }
        return sum;
      },
      [](MaskRegions a, const MaskRegions& b) { return a += b; });
}

// Null if there is none.
nlohmann::ordered_json to_json(std::int64_t min_px) {
  if (min_px == std::numeric_limits<std::int64_t>::max()) return nullptr;
  return min_px;
}

}  // namespace

ScoreSheet score_masks(const MaskSource& masks, const JobHeader& header,
                       const std::shared_ptr<const Mesh>& target,
                       const std::vector<PrinterModel>& models, const Work& work,
                       const ScoreListener& listener) {
  ScoreSheet sheet;
  sheet.masks = regions_of(masks, work);
  Scorer scorer(header.grid, masks.first);
  const auto layers =
      score_layers(voxelize(target, header.grid, header.box,
                            target_around(masks.layers(), header.grid, header.layers())),
                   printed_stream(masks, models.front(), work), header.grid, masks.layers());
  {
    Stage stage(work, "scoring", masks.size_px[2], "layers");
    while (layers->rest().size() > 0) {
      const auto block = layers->next(kBlockLayers);
      std::vector<Fault> ended;
      for (const Shared<LayerScore>& layer : block) {
        const std::vector<Fault> here = scorer.add(*layer);
        ended.insert(ended.end(), here.begin(), here.end());
      }
      if (listener) listener(block, ended);
      stage.advance(static_cast<std::int64_t>(block.size()));
    }
  }
  sheet.score = scorer.finish();
  if (listener) listener({}, sheet.score.last_faults);
  if (const std::optional<WrongPlace>& worst = sheet.score.depths.worst()) {
    sheet.deepest = located(*worst, header.origin_mm(), header.grid);
  }

  sheet.window_worst = sheet.score.voxels.excess();
  double sum = sheet.window_worst;
  Stage corners(work, "scoring the process window",
                static_cast<std::int64_t>(models.size() - 1) * masks.size_px[2], "layers");
  for (std::size_t m = 1; m < models.size(); ++m) {
    const double corner = excess(masks, header, target, models[m], work, corners);
    sum += corner;
    sheet.window_worst = std::max(sheet.window_worst, corner);
  }
  sheet.window_mean = sum / static_cast<double>(models.size());
  return sheet;
}

MaskSource enhanced_masks(const MaskSource& job, JobHeader header,
                          const std::shared_ptr<const Mesh>& target, const Work& work) {
  constexpr int kPaperPasses = 2;
  if (header.enhance == Enhancement::kPaper && header.passes == 0) header.passes = kPaperPasses;
  const auto stream = job_masks(header, target, work).layers(job.layers());
  Stage stage(work, "making masks", job.size_px[2], "layers");
  const auto layers = std::make_shared<std::vector<RunLayer>>();
  while (stream->rest().size() > 0) {
    for (const Shared<MaskLayer>& layer : stream->next(kBlockLayers)) {
      layers->push_back(layer->mask);
    }
    stage.reach(static_cast<std::int64_t>(layers->size()));
  }
  MaskSource masks = job;
  masks.color = nullptr;
  masks.packed = [layers](int index) { return pack((*layers)[static_cast<std::size_t>(index)]); };
  return masks;
}

nlohmann::ordered_json to_json(const ScoreSheet& sheet) {
  const VoxelCounts& counts = sheet.score.voxels;
  const EdgeErrors& edges = sheet.score.edges;
  const Depths& depths = sheet.score.depths;
  nlohmann::ordered_json json = {
      {"solid_voxels", counts.solid},
      {"wrong", counts.wrong()},
      {"floor", counts.floor()},
      {"excess", counts.excess()},
      {"window_excess", {{"mean", sheet.window_mean}, {"worst", sheet.window_worst}}},
      {"depth_mm",
       {{"p999", depths.p999_mm()},
        {"worst", depths.worst() ? depths.worst()->depth_mm : 0},
        {"searched", Depths::kMaxMm}}},
      {"deepest", sheet.deepest},
      {"epe_mm", {{"mean", edges.mean_mm()}, {"p95", edges.p95_mm()}, {"max", edges.max_mm()}}}};
  for (const FaultKind kind : kFaultKinds) json[std::string(word(kind))] = sheet.score.faults[kind];
  json["mask"] = {{"least_island_px", to_json(sheet.masks.smallest_island_px)},
                  {"least_hole_px", to_json(sheet.masks.smallest_hole_px)}};
  return json;
}

}  // namespace binderjet
