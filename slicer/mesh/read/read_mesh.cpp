// SPDX-License-Identifier: GPL-3.0-or-later
// The choice of a reader, and the checks that every mesh has to pass.
#include "slicer/mesh/read/read_mesh.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <new>

#include "slicer/base/error.h"
#include "slicer/mesh/read/readers.h"

namespace binderjet {
namespace {

std::string lower_extension(const std::string& path) {
  std::string text = std::filesystem::path(path).extension().string();
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

MeshFile read_any(InputFile& file, const std::string& path) {
  if (file.size() == 0) {
    throw Error(ErrorKind::kBadInput, file.name(), "is empty; export the model again");
  }
  const std::string extension = lower_extension(path);
  const std::string_view start = file.peek(4);
  if (start.starts_with("ply") && (start.back() == '\n' || start.back() == '\r')) {
    return read_ply(file, path);
  }
  if (start == "PK\x03\x04") return read_3mf(path, file.name());
  if (start == "glTF") return read_with_assimp(path, file.name());
  if (file.peek(5) == "#VRML" || extension == ".wrl" || extension == ".vrml") {
    return read_wrl(file, path);
  }
  if (extension == ".stl") return read_stl(file);
  if (extension == ".obj") return read_obj(file, path);
  if (extension == ".off") return read_off(file);
  if (extension == ".ply") {
    throw Error(ErrorKind::kBadInput, file.name(),
                "is no PLY file: it does not begin with \"ply\"");
  }
  if (extension == ".3mf") {
    throw Error(ErrorKind::kBadInput, file.name(), "is no 3MF file: it is not a ZIP archive");
  }
  return read_with_assimp(path, file.name());
}

void check(const MeshFile& file, const std::string& name) {
  const Mesh& mesh = file.mesh;
  if (mesh.triangles.empty()) {
    throw Error(ErrorKind::kBadInput, name, "has no faces; export the model as a triangle mesh");
  }
  const auto count = static_cast<int>(mesh.points.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const int corner : mesh.triangles[i]) {
      if (corner < 0 || corner >= count) {
        throw Error(ErrorKind::kBadInput, fmt::format("{}: triangle {}", name, i + 1),
                    fmt::format("names point {} of {}; export the model again",
                                static_cast<std::int64_t>(corner) + 1, count));
      }
    }
  }
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    for (const double value : mesh.points[i]) {
      if (!std::isfinite(value)) {
        throw Error(ErrorKind::kBadInput, fmt::format("{}: point {}", name, i + 1),
                    fmt::format("has the coordinate {}; export the model again", value));
      }
      if (std::abs(value) * file.unit_mm >= kMaxCoordinateMm) {
        throw Error(ErrorKind::kBadInput, fmt::format("{}: point {}", name, i + 1),
                    fmt::format("lies at {:g} mm, beyond any printer; export the model again near "
                                "the origin",
                                value * file.unit_mm));
      }
    }
  }
}

}  // namespace

MeshFile read_mesh(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  try {
    InputFile input(path);
    MeshFile file = read_any(input, path);
    const std::string odd = input.odd_line_ends();
    if (!odd.empty()) file.warnings.push_back(odd);
    check(file, name);
    return file;
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::kBadInput, name, "needs more memory than there is; simplify the model");
  }
}

void add_polygon(Mesh& mesh, std::span<const int> corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

void check_claim(const InputFile& file, const std::string& where, std::int64_t count,
                 std::int64_t bytes, const std::string& things) {
  if (count < 0 || count > file.size() / bytes ||
      count > std::numeric_limits<std::int32_t>::max() / 3) {
    throw Error(
        ErrorKind::kBadInput, where,
        fmt::format("declares {} {}, but the whole file has {} bytes; it is damaged, export "
                    "it again",
                    count, things, file.size()));
  }
}

}  // namespace binderjet
