// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/parts.h"

#include <filesystem>
#include <utility>

#include "driver/base/files.h"
#include "slicer/base/error.h"
#include "slicer/mesh/read/read_mesh.h"
#include "slicer/mesh/repair.h"

namespace binderjet {

Part load_part(const std::string& file, std::optional<double> unit_mm, const Placement& placement,
               bool with_paint, const Work& work) {
  Part part;
  part.source.file = file;
  part.source.hash = file_hash(file);
  MeshFile read = [&] {
    const Stage stage(work, "reading model");
    return read_mesh(file);
  }();
  work.check();
  if (file_hash(file) != part.source.hash) {
    throw Error(ErrorKind::kBadInput, file, "changed while it was read; try again");
  }
  part.mesh = std::move(read.mesh);
  if (with_paint) {
    part.paint = std::move(read.paint);
  } else {
    read.paint = {};
  }
  part.warnings = std::move(read.warnings);
  part.source.placement = placement;
  part.source.placement.unit_mm = unit_mm.value_or(read.unit_mm);
  const double wall =
      placement.wall_mm / (part.source.placement.unit_mm * part.source.placement.scale);
  const Stage stage(work, "repairing model");
  const Repair repair = repair_mesh(part.mesh, file, wall, work);
  for (const std::string& note : repair.notes) part.warnings.push_back(file + ": " + note);
  for (const std::string& remark : repair.remarks) part.warnings.push_back(file + ": " + remark);
  part.request.where = file;
  part.request.size_mm = transform_part(part.mesh, part.source.placement, file,
                                        {&part.paint.points, &part.paint.samples});
  part.request.at_mm = placement.at_mm;
  part.request.scale = placement.scale;
  part.request.unit_declared = read.unit_declared || unit_mm.has_value();
  const std::string doubt = doubtful_size(part.request);
  part.doubtful_size = !doubt.empty();
  if (part.doubtful_size) part.warnings.push_back(file + ": " + doubt);
  return part;
}

std::shared_ptr<const ColorField> take_color(std::vector<Part>& parts, const Grid& grid,
                                             const ColorSettings& settings,
                                             std::vector<std::string>& warnings, const Work& work) {
  Stage stage(work, "reading color", static_cast<std::int64_t>(parts.size()), "models");
  std::vector<Source> sources;
  for (const Part& part : parts) sources.push_back(part.source);
  const std::array<int, 2> corner = lower_corner(sources);
  std::vector<PartField> fields;
  bool colored = false;
  for (Part& part : parts) {
    PartField field{bounding_box(part.mesh), nullptr};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double shift_mm = (part.source.corner_px[axis] - corner[axis]) * grid.pitch_mm[axis];
      field.box.min[axis] += shift_mm;
      field.box.max[axis] += shift_mm;
      if (shift_mm == 0) continue;
      for (Point& point : part.paint.points) point[axis] += shift_mm;
      for (Point& point : part.paint.samples) point[axis] += shift_mm;
    }
    std::vector<std::string> notes;
    field.field = paint_field(std::move(part.paint), settings, notes);
    for (const std::string& note : notes) warnings.push_back(part.source.file + ": " + note);
    colored |= field.field != nullptr;
    if (!field.field) field.field = plain_field(kWhite);
    fields.push_back(std::move(field));
    stage.advance();
  }
  return colored ? bed_field(std::move(fields)) : nullptr;
}

Mesh merge_parts(std::vector<Part> parts, const Grid& grid) {
  std::vector<Source> sources;
  for (const Part& part : parts) sources.push_back(part.source);
  const std::array<int, 2> corner = lower_corner(sources);
  Mesh merged;
  for (Part& part : parts) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const int shift_px = part.source.corner_px[axis] - corner[axis];
      if (shift_px == 0) continue;
      for (Point& point : part.mesh.points) point[axis] += shift_px * grid.pitch_mm[axis];
    }
    if (merged.points.empty()) {
      merged = std::move(part.mesh);
      continue;
    }
    const int base = static_cast<int>(merged.points.size());
    merged.points.insert(merged.points.end(), part.mesh.points.begin(), part.mesh.points.end());
    for (const Triangle& t : part.mesh.triangles) {
      merged.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    }
  }
  return merged;
}

std::vector<std::string> part_files(const JobHeader& header, const std::string& folder) {
  std::vector<std::string> files;
  for (const Source& source : header.sources) {
    std::error_code error;
    const auto beside =
        std::filesystem::path(folder) / std::filesystem::path(source.file).filename();
    const bool moved =
        !std::filesystem::exists(source.file, error) && std::filesystem::exists(beside, error);
    files.push_back(moved ? beside.string() : source.file);
  }
  return files;
}

std::shared_ptr<const Mesh> reload_parts(const JobHeader& header, const std::string& folder,
                                         const Work& work) {
  const std::vector<std::string> files = part_files(header, folder);
  std::vector<Part> parts;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const Source& source = header.sources[i];
    const std::string& file = files[i];
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
      throw Error(ErrorKind::kBadInput, file,
                  "the model this job was made from is gone; put it back or beside the job");
    }
    if (file_hash(file) != source.hash) {
      throw Error(ErrorKind::kBadInput, file,
                  "has changed since this job was made from it; slice it again");
    }
    Part part = load_part(file, source.placement.unit_mm, source.placement, false, work);
    part.source = source;
    parts.push_back(std::move(part));
  }
  return std::make_shared<const Mesh>(merge_parts(std::move(parts), header.grid));
}

}  // namespace binderjet
