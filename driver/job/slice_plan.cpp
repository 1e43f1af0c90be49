// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/slice_plan.h"

#include <fmt/core.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "driver/base/files.h"
#include "driver/job/parts.h"
#include "slicer/base/error.h"
#include "slicer/color/color.h"
#include "slicer/model/printer_model.h"

namespace binderjet {
namespace {

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

// Where a size is asked for a part is read twice, since the scale also says how thick a wall is.
Part load_part_of_size(const std::string& file, std::optional<double> unit_mm, Placement placement,
                       std::optional<double> size_mm, const Work& work) {
  if (size_mm) {
    placement.scale = 1;
    const std::array<double, 3> size =
        load_part(file, unit_mm, placement, false, work).request.size_mm;
    placement.scale = *size_mm / *std::max_element(size.begin(), size.end());
    if (!(placement.scale >= kLeastScale && placement.scale <= kMostScale)) {
      throw Error(ErrorKind::kUsage, "--size",
                  fmt::format("would scale {} by {:g}; its unit is likely another one", file,
                              placement.scale));
    }
  }
  return load_part(file, unit_mm, placement, true, work);
}

// A header names a model's own file; what that leads to, textures among them, it does not.
void add_paint(const Paint& paint, Fingerprint& print) {
  print.add_list(paint.samples);
  print.add_list(paint.sample_colors);
  print.add_list(paint.points);
  print.add_list(paint.triangles);
  print.add_list(paint.corners);
  print.add_list(paint.images);
  print.add_list(paint.uvs);
  for (const TextureSource& texture : paint.textures) {
    print.add(std::as_bytes(std::span(texture.tiling)));
    print.add_list(texture.bytes);
    std::error_code error;
    if (!std::filesystem::is_regular_file(texture.path, error)) continue;
    const std::string hash = file_hash(texture.path);
    print.add(std::as_bytes(std::span(hash)));
  }
}

// Reads the parts and decides where each stands: where --at says, else as they fit.
std::vector<Part> load_parts(const SliceOptions& options, const JobHeader& header,
                             const Work& work) {
  if (options.at.size() > options.parts.size()) {
    throw Error(ErrorKind::kUsage, "--at", "is given more often than there are parts");
  }
  const std::optional<double> unit_mm = unit_of(options);
  std::vector<Part> parts;
  std::vector<BedRequest> requests;
  for (std::size_t i = 0; i < options.parts.size(); ++i) {
    Placement placement = options.placement;
    if (i < options.at.size()) {
      placement.at_mm = bed_place(options.at[i]);
    }
    parts.push_back(load_part_of_size(options.parts[i], unit_mm, placement, options.size_mm, work));
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

}  // namespace

SlicePlan plan_slices(const SliceOptions& options, const Console& console) {
  SlicePlan plan;
  JobHeader& header = plan.header;
  header.profile = load_profile(options.profile);
  header.grid = header.profile.grid(options.layer_mm);
  header.enhance = options.enhance;
  header.passes = options.enhance == Enhancement::kPaper ? options.passes : 0;
  header.robust = options.robust;
  const Work work = console.work();
  std::vector<Part> parts = load_parts(options, header, work);
#ifdef __GLIBC__
  malloc_trim(0);  // what reading and repair freed, or it counts beside all that follows
#endif
  for (const Part& part : parts) {
    header.sources.push_back(part.source);
    plan.warnings.insert(plan.warnings.end(), part.warnings.begin(), part.warnings.end());
    plan.doubtful_size |= part.doubtful_size;
  }
  Fingerprint print;
  for (const Part& part : parts) add_paint(part.paint, print);
  plan.color = take_color(parts, header.grid, header.profile.color, plan.warnings, work);
  for (const std::string& warning : plan.warnings) console.warning(warning);
  for (const Part& part : parts) {
    const std::array<double, 3>& size = part.request.size_mm;
    console.note(fmt::format("{}: {:.1f} x {:.1f} x {:.1f} mm", part.request.where, size[0],
                             size[1], size[2]));
  }
  plan.mesh = std::make_shared<const Mesh>(merge_parts(std::move(parts), header.grid));
  print.add_list(plan.mesh->points);
  print.add_list(plan.mesh->triangles);
  plan.fingerprint = print.text();
  header.box = job_box(bounding_box(*plan.mesh).max, header.grid, lower_corner(header.sources),
                       PrinterModel(header.profile.effects, header.grid).reach().xy_vx);
  if (options.color_enhance) {
    if (!plan.color) plan.color = plain_field(kWhite);
    plan.color = crease_field(std::move(plan.color), *plan.mesh, header.profile.color, work);
  }
  header.color = plan.color != nullptr;
  header.color_enhanced = options.color_enhance;
  return plan;
}

}  // namespace binderjet
