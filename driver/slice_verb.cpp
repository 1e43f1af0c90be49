// SPDX-License-Identifier: GPL-3.0-or-later
// slice PART... -p PROFILE -o JOB: models in, a printable job out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/console.h"
#include "driver/estimate.h"
#include "driver/job.h"
#include "driver/result.h"
#include "driver/slice.h"
#include "driver/verbs.h"
#include "slicer/effects/model.h"
#include "slicer/masks.h"
#include "transport/job_file.h"

namespace binderjet {
namespace {

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
    parts.push_back(load_part(options.parts[i], unit_mm, placement));
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

void slice(const SliceOptions& options, const Console& console) {
  const auto start = std::chrono::steady_clock::now();
  const SlicePlan plan = plan_slices(options, console);
  const LayerRange range = layer_range(options.layers, plan.header.layers());
  JobWriter writer = value_or_throw(JobWriter::create(options.out, to_text(plan.header)));
  Progress progress(console, "slicing", range.size());
  const auto stream = encoded_layers(plan.header, plan.mesh, range);
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
  report(plan.header, totals, options.out, plan.warnings, console);
}

}  // namespace

SlicePlan plan_slices(const SliceOptions& options, const Console& console) {
  SlicePlan plan;
  JobHeader& header = plan.header;
  header.profile = load_profile(options.profile);
  header.grid = header.profile.grid(options.layer_mm);
  header.enhance = options.enhance;
  header.passes = options.enhance == "paper" ? options.passes : 0;
  std::vector<Part> parts = load_parts(options, header);
  for (const Part& part : parts) {
    header.sources.push_back(part.source);
    plan.warnings.insert(plan.warnings.end(), part.warnings.begin(), part.warnings.end());
  }
  for (const std::string& warning : plan.warnings) console.warning(warning);
  plan.mesh = std::make_shared<const Mesh>(merge_parts(std::move(parts), header.grid));
  header.box = job_box(bounding_box(*plan.mesh), header.grid, lower_corner(header.sources),
                       PrinterModel(header.profile.effects, header.grid).reach().xy_vx);
  return plan;
}

std::unique_ptr<Stream<EncodedLayer>> encoded_layers(const JobHeader& header,
                                                     std::shared_ptr<const Mesh> mesh,
                                                     LayerRange layers) {
  using Encode = Step<MaskLayer, EncodedLayer>;
  return std::make_unique<Encode>(
      mask_stream(header, std::move(mesh), layers), layers, 0, header.layers(),
      [](int layer, Encode::Window window) { return encode(layer, *window[0]); });
}

void add_slice_options(CLI::App& verb, SliceOptions& options) {
  verb.add_option("--enhance", options.enhance, "how masks answer the printer's blur")
      ->check(CLI::IsMember({"none", "paper"}))
      ->capture_default_str();
  verb.add_option("--passes", options.passes, "passes of the paper's rule")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  verb.add_option("--layer", options.layer_mm, "layer height in mm, one the printer has");
  verb.add_option("--scale", options.placement.scale, "scale factor")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_option("--units", options.units,
                  "the model's unit: mm, cm, m, um, in, ft (default: what the file says, else mm)");
  verb.add_option("--rotate", options.placement.rotate_deg,
                  "turn about x, then y, then z, in degrees")
      ->delimiter(',');
  verb.add_option("--at", options.at,
                  "X,Y in mm: the part's lower corner on the bed; once per part")
      ->allow_extra_args(false);
}

void add_slice_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("slice", "turn models into a printable job");
  auto options = std::make_shared<SliceOptions>();
  verb->add_option("PART", options->parts, "models: STL, PLY, OBJ, OFF, 3MF, glTF and others")
      ->required();
  verb->add_option("-p,--profile", options->profile, "a printer profile's name or path")
      ->required();
  verb->add_option("-o,--output", options->out, "the job to write (.bjob)")->required();
  add_slice_options(*verb, *options);
  verb->add_option("--layers", options->layers, "A:B, slice only layers A <= k < B (see join)");
  verb->callback([options, console = add_console_options(*verb)] { slice(*options, *console); });
}

}  // namespace binderjet
