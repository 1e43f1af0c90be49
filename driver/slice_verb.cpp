// SPDX-License-Identifier: GPL-3.0-or-later
// slice PART... -p PROFILE -o JOB: models in, a printable job out.
#include <fmt/format.h>
#include <malloc.h>
#include <oneapi/tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <semaphore>
#include <string>
#include <vector>

#include "driver/console.h"
#include "driver/estimate.h"
#include "driver/job.h"
#include "driver/result.h"
#include "driver/verbs.h"
#include "slicer/color/color.h"
#include "slicer/color/shell.h"
#include "slicer/color/skin.h"
#include "slicer/effects/model.h"
#include "slicer/masks.h"
#include "transport/job_file.h"

namespace binderjet {
namespace {

struct SliceOptions {
  std::vector<std::string> parts;
  std::string profile;
  std::string out;
  std::string enhance = "none";
  int passes = 2;
  std::optional<double> layer_mm;
  std::string units;
  Placement placement;
  std::vector<std::string> at;
  std::string layers;
  std::optional<int> threads;
  std::string texture;
  bool color_enhance = false;
};

// "A:B" as numbers; either may be empty.
template <class Number>
std::vector<std::optional<Number>> split(const std::string& option, const std::string& text,
                                         char separator, std::size_t count) {
  std::vector<std::optional<Number>> values;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    const std::string piece = text.substr(begin, end - begin);
    Number value{};
    if (piece.empty()) {
      values.emplace_back();
    } else if (CLI::detail::lexical_cast(piece, value)) {
      values.emplace_back(value);
    } else {
      throw Error(ErrorKind::kUsage, option, "\"" + piece + "\" is not a number");
    }
    if (end == text.size()) break;
    begin = end + 1;
  }
  if (values.size() != count) {
    throw Error(ErrorKind::kUsage, option,
                fmt::format("needs {} values between \"{}\", got \"{}\"", count, separator, text));
  }
  return values;
}

LayerRange layer_range(const std::string& text, int layers) {
  if (text.empty()) return {0, layers};
  const auto ends = split<int>("--layers", text, ':', 2);
  const LayerRange range{ends[0].value_or(0), ends[1].value_or(layers)};
  if (range.first < 0 || range.last > layers || range.first >= range.last) {
    throw Error(ErrorKind::kUsage, "--layers",
                fmt::format("{} is empty or beyond the part's {} layers", text, layers));
  }
  return range;
}

std::optional<double> unit_of(const std::string& word) {
  if (word.empty()) return std::nullopt;
  const std::optional<double> unit_mm = unit_from_word(word);
  if (!unit_mm) {
    throw Error(ErrorKind::kUsage, "--units",
                "\"" + word + "\" is not one of um, mm, cm, m, in, ft");
  }
  return unit_mm;
}

// The image for a model that has a place in it for each triangle but names none, or another.
void use_texture(const std::string& file, Paint& paint) {
  if (paint.uvs.empty()) {
    throw Error(ErrorKind::kUsage, "--texture", "is for models with texture coordinates");
  }
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw Error(ErrorKind::kUsage, "--texture", file + " is not there");
  }
  paint.textures = {{file, file, {}, {}}};
  std::fill(paint.images.begin(), paint.images.end(), 0);
  paint.corners = {};
}

// Reads the parts and decides where each stands: where --at says, else as they fit.
std::vector<Part> load_parts(const SliceOptions& options, const JobHeader& header) {
  if (options.at.size() > options.parts.size()) {
    throw Error(ErrorKind::kUsage, "--at", "is given more often than there are parts");
  }
  const std::optional<double> unit_mm = unit_of(options.units);
  std::vector<Part> parts;
  std::vector<BedRequest> requests;
  for (std::size_t i = 0; i < options.parts.size(); ++i) {
    Placement placement = options.placement;
    if (i < options.at.size()) {
      const auto at = split<double>("--at", options.at[i], ',', 2);
      if (!at[0] || !at[1]) throw Error(ErrorKind::kUsage, "--at", "needs X,Y in mm");
      placement.at_mm = {*at[0], *at[1]};
    }
    parts.push_back(load_part(options.parts[i], unit_mm, placement, true));
    if (!options.texture.empty()) use_texture(options.texture, parts.back().paint);
    requests.push_back(parts.back().request);
  }
  constexpr double kSpacingMm = 2;
  const std::vector<BedSpot> spots =
      place_parts(requests, header.profile.bed(header.grid), kSpacingMm);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].source.corner_px = {spots[i].x_px, spots[i].y_px};
  }
  return parts;
}

EncodedLayer encode(int layer, const MaskLayer& masks) {
  EncodedLayer out{encode_record(RecordKind::kMask, layer, pack(masks.mask)), masks.mask.count(),
                   0};
  for (const RunLayer& slice : masks.target->slices) out.target_vx += slice.count();
  return out;
}

// Masks with the color bitmaps beside them.
std::unique_ptr<Stream<EncodedLayer>> colored_layers(const JobHeader& header,
                                                     std::shared_ptr<const Mesh> mesh,
                                                     std::shared_ptr<const ColorField> field,
                                                     LayerRange range) {
  const auto shell =
      std::make_shared<const Shell>(header.grid, header.box, header.profile.color.depth_mm, field);
  const LayerRange skins = grown(range, shell->reach(), header.layers());
  auto layers = skin(mask_stream(header, std::move(mesh), grown(skins, 1, header.layers())),
                     header.grid, header.box, skins, std::move(field));
  // A bitmap and its compressed form are in memory for each layer being painted. On a large part
  // fewer are painted at once than there may be cores.
  constexpr std::int64_t kBitmapBytes = std::int64_t{64} << 20;
  const std::int64_t bytes = std::int64_t{6} * header.box.size_px[0] * header.box.size_px[1];
  const auto places = std::make_shared<std::counting_semaphore<>>(
      std::clamp<std::int64_t>(kBitmapBytes / bytes, 1, 64));
  using Paint = Step<SkinLayer, EncodedLayer>;
  return std::make_unique<Paint>(
      std::move(layers), range, shell->reach(), header.layers(),
      [shell, places](int layer, Paint::Window window) {
        EncodedLayer out = encode(layer, *window[static_cast<std::size_t>(shell->reach())]->masks);
        places->acquire();
        const std::vector<std::byte> color =
            encode_record(RecordKind::kColor, layer, shell->paint(layer, window));
        places->release();
        out.record.insert(out.record.end(), color.begin(), color.end());
        return out;
      });
}

std::unique_ptr<Stream<EncodedLayer>> plain_layers(const JobHeader& header,
                                                   std::shared_ptr<const Mesh> mesh,
                                                   LayerRange range) {
  using Encode = Step<MaskLayer, EncodedLayer>;
  return std::make_unique<Encode>(
      mask_stream(header, std::move(mesh), range), range, 0, header.layers(),
      [](int layer, Encode::Window window) { return encode(layer, *window[0]); });
}

void slice(const SliceOptions& options, const Console& console) {
  const auto start = std::chrono::steady_clock::now();
  std::optional<oneapi::tbb::global_control> cores;
  if (options.threads) {
    cores.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                  static_cast<std::size_t>(*options.threads));
  }
  JobHeader header;
  header.profile = load_profile(options.profile);
  header.grid = header.profile.grid(options.layer_mm);
  header.enhance = options.enhance;
  header.passes = options.enhance == "paper" ? options.passes : 0;
  std::vector<Part> parts = load_parts(options, header);
#ifdef __GLIBC__
  malloc_trim(0);  // what reading and repair freed, or it counts beside all that follows
#endif
  std::vector<std::string> warnings;
  for (const Part& part : parts) {
    header.sources.push_back(part.source);
    warnings.insert(warnings.end(), part.warnings.begin(), part.warnings.end());
  }
  std::shared_ptr<const ColorField> field =
      take_color(parts, header.grid, header.profile.color, warnings);
  for (const std::string& warning : warnings) console.warning(warning);

  const auto mesh = std::make_shared<const Mesh>(merge_parts(std::move(parts), header.grid));
  header.box = job_box(bounding_box(*mesh), header.grid, lower_corner(header.sources),
                       PrinterModel(header.profile.effects, header.grid).reach().xy_vx);
  const LayerRange range = layer_range(options.layers, header.layers());
  if (options.color_enhance) {
    if (!field) field = plain_field(kWhite);
    field = crease_field(std::move(field), *mesh, header.profile.color);
  }
  header.color = field != nullptr;
  header.color_enhanced = options.color_enhance;

  JobWriter writer = value_or_throw(JobWriter::create(options.out, to_text(header)));
  Progress progress(console, "slicing", range.size());
  const auto stream =
      field ? colored_layers(header, mesh, field, range) : plain_layers(header, mesh, range);
  Totals totals;
  while (stream->rest().size() > 0) {
    for (const Shared<EncodedLayer>& layer : stream->next(kBlockLayers)) {
      value_or_throw(writer.append(layer->record));
      totals.add(*layer);
    }
    progress.advance(totals.layers);
  }
  value_or_throw(writer.finish());
  totals.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report(header, totals, options.out, warnings, console);
}

}  // namespace

void add_slice_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("slice", "turn models into a printable job");
  auto options = std::make_shared<SliceOptions>();
  verb->add_option("PART", options->parts, "models: STL, PLY, OBJ, OFF, 3MF, VRML, glTF and others")
      ->required();
  verb->add_option("-p,--profile", options->profile, "a printer profile's name or path")
      ->required();
  verb->add_option("-o,--output", options->out, "the job to write (.bjob)")->required();
  verb->add_option("--enhance", options->enhance, "how masks answer the printer's blur")
      ->check(CLI::IsMember({"none", "paper"}))
      ->capture_default_str();
  verb->add_option("--passes", options->passes, "passes of the paper's rule")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  verb->add_option("--layer", options->layer_mm, "layer height in mm, one the printer has");
  verb->add_option("--scale", options->placement.scale, "scale factor")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option(
      "--units", options->units,
      "the model's unit: mm, cm, m, um, in, ft (default: what the file says, else mm)");
  verb->add_option("--rotate", options->placement.rotate_deg,
                   "turn about x, then y, then z, in degrees")
      ->delimiter(',');
  verb->add_option("--at", options->at,
                   "X,Y in mm: the part's lower corner on the bed; once per part")
      ->allow_extra_args(false);
  verb->add_option("--threads", options->threads, "how many cores to use; the result is the same")
      ->check(CLI::Range(1, 1024));
  verb->add_option("--layers", options->layers, "A:B, slice only layers A <= k < B (see join)");
  verb->add_option("--texture", options->texture,
                   "the image for a model whose file has a place in it but names none");
  verb->add_flag("--color-enhance", options->color_enhance,
                 "darken creases, so that detail shows in diffuse light");
  verb->callback([options, console = add_console_options(*verb)] { slice(*options, *console); });
}

}  // namespace binderjet
