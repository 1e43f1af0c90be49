// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/slice_plan.h"

#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <semaphore>
#include <utility>

#include "driver/job/job_masks.h"
#include "slicer/base/error.h"
#include "slicer/color/color.h"
#include "slicer/color/shell.h"
#include "slicer/color/skin.h"
#include "slicer/model/printer_model.h"
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
      const auto [x, y] = std::pair(at[0], at[1]);
      if (!x || !y) throw Error(ErrorKind::kUsage, "--at", "needs X,Y in mm");
      placement.at_mm = {*x, *y};
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
  EncodedLayer out{encode_record(RecordKind::kMask, layer, pack(masks.mask)), masks.mask.count(), 0,
                   masks.changes};
  for (const RunLayer& slice : masks.target->slices) out.target_vx += slice.count();
  return out;
}

Pipeline<EncodedLayer> encoded(const Pipeline<MaskLayer>& masks) {
  return masks.then("encode", {}, [](int layer, const Window<MaskLayer>& window) {
    return encode(layer, window.middle());
  });
}

// Masks with the color bitmaps beside them.
Pipeline<EncodedLayer> colored(const Pipeline<MaskLayer>& masks, const JobHeader& header,
                               std::shared_ptr<const ColorField> field) {
  const auto shell =
      std::make_shared<const Shell>(header.grid, header.box, header.profile.color.depth_mm, field);
  // A bitmap and its compressed form are in memory for each layer being painted. On a large part
  // fewer are painted at once than there may be cores.
  constexpr std::int64_t kBitmapBytes = std::int64_t{64} << 20;
  const std::int64_t bytes = std::int64_t{6} * header.box.size_px[0] * header.box.size_px[1];
  const auto places = std::make_shared<std::counting_semaphore<>>(
      std::clamp<std::int64_t>(kBitmapBytes / bytes, 1, 64));
  return skin(masks, header.grid, header.box, std::move(field))
      .then("paint and encode", LayerReach::both_sides(shell->reach()),
            [shell, places](int layer, const Window<SkinLayer>& window) {
              EncodedLayer out = encode(layer, *window.middle().masks);
              places->acquire();
              const std::vector<std::byte> color =
                  encode_record(RecordKind::kColor, layer, shell->paint(layer, window));
              places->release();
              out.record.insert(out.record.end(), color.begin(), color.end());
              return out;
            });
}

}  // namespace

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

SlicePlan plan_slices(const SliceOptions& options, const Console& console) {
  SlicePlan plan;
  JobHeader& header = plan.header;
  header.profile = load_profile(options.profile);
  header.grid = header.profile.grid(options.layer_mm);
  header.enhance = options.enhance;
  header.passes = options.enhance == "paper" ? options.passes : 0;
  header.robust = options.robust;
  std::vector<Part> parts = load_parts(options, header);
#ifdef __GLIBC__
  malloc_trim(0);  // what reading and repair freed, or it counts beside all that follows
#endif
  for (const Part& part : parts) {
    header.sources.push_back(part.source);
    plan.warnings.insert(plan.warnings.end(), part.warnings.begin(), part.warnings.end());
    plan.doubtful_size |= part.doubtful_size;
  }
  plan.color = take_color(parts, header.grid, header.profile.color, plan.warnings);
  for (const std::string& warning : plan.warnings) console.warning(warning);
  plan.mesh = std::make_shared<const Mesh>(merge_parts(std::move(parts), header.grid));
  header.box = job_box(bounding_box(*plan.mesh).max, header.grid, lower_corner(header.sources),
                       PrinterModel(header.profile.effects, header.grid).reach().xy_vx);
  if (options.color_enhance) {
    if (!plan.color) plan.color = plain_field(kWhite);
    plan.color = crease_field(std::move(plan.color), *plan.mesh, header.profile.color);
  }
  header.color = plan.color != nullptr;
  header.color_enhanced = options.color_enhance;
  return plan;
}

Pipeline<EncodedLayer> encoded_layers(const JobHeader& header, std::shared_ptr<const Mesh> mesh,
                                      std::shared_ptr<const ColorField> color) {
  const Pipeline<MaskLayer> masks = job_masks(header, std::move(mesh));
  return color ? colored(masks, header, std::move(color)) : encoded(masks);
}

void add_slice_options(CLI::App& verb, SliceOptions& options) {
  verb.add_option("--enhance", options.enhance, "how masks answer the printer's blur")
      ->check(CLI::IsMember({"none", "paper", "inverse"}))
      ->capture_default_str();
  verb.add_option("--passes", options.passes, "passes of the paper's rule")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  verb.add_flag("--robust,!--no-robust", options.robust,
                "inverse: masks for a printer that may be a little off (default), not for the "
                "profile's model alone");
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
  verb.add_option("--wall", options.placement.wall_mm,
                  "give a surface that encloses nothing, as of a scan, a wall this thick, in mm")
      ->check(CLI::PositiveNumber);
  verb.add_option("--texture", options.texture,
                  "the image for a model whose file has a place in it but names none");
  verb.add_flag("--color-enhance", options.color_enhance,
                "darken creases, so that detail shows in diffuse light");
}

}  // namespace binderjet
