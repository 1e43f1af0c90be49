// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/viewer/viewer.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "driver/base/html.h"
#include "driver/job/print_stream.h"
#include "driver/report/findings.h"
#include "driver/viewer/run_codec.h"
#include "driver/viewer/viewer_page.h"
#include "slicer/model/printer_model.h"
#include "slicer/score/score.h"
#include "slicer/stack/png.h"
#include "slicer/voxels/slicing_operator.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {
namespace {

std::vector<std::byte> deflated(const std::string& text) {
  uLongf size = compressBound(text.size());
  std::vector<std::byte> out(size);
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(text.data()), text.size(),
                Z_BEST_COMPRESSION) != Z_OK) {
    throw std::bad_alloc();
  }
  out.resize(size);
  return out;
}

void add_data(const std::string& id, std::span<const std::byte> bytes, std::string& page) {
  page +=
      fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, html::base64(bytes));
}

// A bitmap with one pixel in step x step.
std::vector<std::byte> thinned(const std::vector<std::byte>& rgb, int width, int height, int step) {
  std::vector<std::byte> out;
  for (int y = 0; y < height; y += step) {
    for (int x = 0; x < width; x += step) {
      const auto from = rgb.begin() + (std::ptrdiff_t{y} * width + x) * 3;
      out.insert(out.end(), from, from + 3);
    }
  }
  return out;
}

std::vector<std::byte> color_png(const MaskSource& job, int index, int step) {
  const auto size = [step](int pixels) { return (pixels + step - 1) / step; };
  return encode_png_rgb(thinned(job.color(index), job.size_px[0], job.size_px[1], step),
                        size(job.size_px[0]), size(job.size_px[1]),
                        {job.pitch_mm[0] * step, job.pitch_mm[1] * step});
}

// How many color pixels make one, so that a thousand layers like the middle one stay small.
int color_step(const MaskSource& job) {
  if (!job.color) return 0;
  constexpr std::size_t kLayerBytes = 9000;
  constexpr int kMost = 16;
  int step = 1;
  while (step < kMost && color_png(job, job.size_px[2] / 2, step).size() > kLayerBytes) ++step;
  return step;
}

// What the job's plain masks would print; null where the masks sent are the plain ones.
std::unique_ptr<Stream<RunLayer>> plain_print(const MaskSource& job,
                                              const std::shared_ptr<const Mesh>& mesh,
                                              const PrinterModel& model) {
  if (mesh == nullptr || job.header->enhance == Enhancement::kNone) return nullptr;
  JobHeader plain = *job.header;
  plain.enhance = Enhancement::kNone;
  // Not owned: the model outlives the stream.
  return printed_job(plain, mesh, {std::shared_ptr<const void>(), &model},
                     std::make_shared<MaskTally>())
      .layers(job.layers());
}

nlohmann::ordered_json description(const MaskSource& job, bool target, int step) {
  const JobHeader& header = *job.header;
  return {
      {"name", std::filesystem::path(job.path).filename().string()},
      {"about", fmt::format("{} layers of {} mm, {} x {} pixels, {}", job.size_px[2],
                            job.pitch_mm[2], job.size_px[0], job.size_px[1], header.profile.name)},
      {"enhance", word(header.enhance)},
      {"size_px", job.size_px},
      {"first", job.first},
      {"pitch_mm", job.pitch_mm},
      {"origin_mm", job.origin_mm},
      {"detail_vx", header.grid.detail_vx},
      {"chunk_layers", kChunkLayers},
      {"target", target},
      {"color_step", step}};
}

// A JSON script element; what stands in it must not end it.
std::string json_script(const std::string& id, const nlohmann::ordered_json& json) {
  std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
    text.replace(at, 1, "\\u003c");
  }
  return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, text);
}

// Packs the layers of a chunk; see viewer.h.
class ChunkWriter {
 public:
  ChunkWriter(const MaskSource& job)
      : grid_(job.header->grid),
        plain_(RunLayer::powder(job.size_px[0], job.size_px[1])),
        slice_(RunLayer::powder(job.size_px[0] * grid_.detail_vx[0],
                                job.size_px[1] * grid_.detail_vx[1])),
        mask_(plain_),
        printed_(slice_) {}

  void add(const VoxelLayer* target, RunLayer mask, const RunLayer& printed,
           const RunLayer* plain_print) {
    if (target != nullptr) {
      for (const RunLayer& slice : target->slices) {
        encode_runs(slice, slice_, text_);
        slice_ = slice;
      }
      RunLayer plain = slicing_operator(*target, grid_);
      encode_runs(plain, plain_, text_);
      plain_ = std::move(plain);
      encode_runs(mask, plain_, text_);
      encode_runs(printed, slice_, text_);
      if (plain_print != nullptr) encode_runs(*plain_print, slice_, text_);
    } else {
      encode_runs(mask, mask_, text_);
      encode_runs(printed, printed_, text_);
      mask_ = std::move(mask);
      printed_ = printed;
    }
  }
  const std::string& text() const { return text_; }

 private:
  Grid grid_;
  RunLayer plain_, slice_, mask_, printed_;
  std::string text_;
};

// The layers that these are the score of, of which the findings hear.
std::vector<ComparedLayer> compared(const std::vector<Shared<LayerScore>>& scores,
                                    Findings& findings) {
  std::vector<ComparedLayer> layers;
  for (const Shared<LayerScore>& score : scores) {
    findings.add(*score);
    layers.push_back(score->layer);
  }
  return layers;
}

// Without a target.
std::vector<ComparedLayer> alone(const std::vector<Shared<RunLayer>>& prints) {
  std::vector<ComparedLayer> layers;
  for (const Shared<RunLayer>& print : prints) layers.push_back({nullptr, print});
  return layers;
}

std::string data(const MaskSource& job, const std::shared_ptr<const Mesh>& mesh, const Work& work) {
  const JobHeader& header = *job.header;
  const PrinterModel model(header.profile.effects, header.grid, job.place());
  auto printed = printed_stream(job, model, work);
  const auto scored =
      mesh ? score_layers(voxelize(mesh, header.grid, header.box,
                                   target_around(job.layers(), header.grid, header.layers())),
                          std::move(printed), header.grid, job.layers())
           : nullptr;
  Findings findings(header.grid, header.origin_mm(), job.first);
  const auto plain = plain_print(job, mesh, model);
  const int step = color_step(job);

  std::string page = json_script("job", description(job, mesh != nullptr, step));
  Stage stage(work, "drawing layers", job.size_px[2], "layers");
  int done = 0;
  for (int number = 0; done < job.size_px[2]; ++number) {
    const std::vector<ComparedLayer> layers = scored
                                                  ? compared(scored->next(kChunkLayers), findings)
                                                  : alone(printed->next(kChunkLayers));
    const auto plains = plain ? plain->next(kChunkLayers) : std::vector<Shared<RunLayer>>();
    ChunkWriter chunk(job);
    for (std::size_t i = 0; i < layers.size(); ++i, ++done) {
      chunk.add(layers[i].target.get(), job.read(done), *layers[i].printed,
                plain ? plains[i].get() : nullptr);
      if (step > 0) add_data(fmt::format("color{}", done), color_png(job, done, step), page);
    }
    add_data(fmt::format("chunk{}", number), deflated(chunk.text()), page);
    stage.reach(done);
  }
  if (scored) {
    findings.finish();
    page += json_script("places", findings.to_look_at());
  }
  return page;
}

void fill(std::string& page, const std::string& mark, const std::string& text) {
  page.replace(page.find(mark), mark.size(), text);
}

}  // namespace

std::string viewer_page(const MaskSource& job, const std::shared_ptr<const Mesh>& mesh,
                        const Work& work) {
  std::string page = kViewerHtml;
  fill(page, "<!--SCRIPT-->", kViewerScript);
  fill(page, "<!--JOB-->", data(job, mesh, work));
  return page;
}

}  // namespace binderjet
