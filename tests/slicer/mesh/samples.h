// SPDX-License-Identifier: GPL-3.0-or-later
// Small meshes and files that the mesh tests share.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "slicer/mesh/mesh.h"

namespace binderjet::testing {

// A box from `low` to `low` + `size`; 8 points, 12 triangles, outward.
inline Mesh box(double size = 1, Point low = {0, 0, 0}) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.points.push_back(
        {low[0] + (i & 1) * size, low[1] + (i >> 1 & 1) * size, low[2] + (i >> 2) * size});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline Mesh joined(Mesh a, const Mesh& b) {
  const int first = static_cast<int>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return a;
}

inline Mesh inside_out(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

// The bytes of a binary STL.
inline std::string binary_stl(const Mesh& mesh, const std::string& header = "") {
  std::string bytes = header;
  bytes.resize(80, '\0');
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (const Triangle& t : mesh.triangles) {
    bytes.append(12, '\0');
    for (const int corner : t) {
      for (const double value : mesh.points[static_cast<std::size_t>(corner)]) {
        const auto narrow = static_cast<float>(value);
        bytes.append(reinterpret_cast<const char*>(&narrow), 4);
      }
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

// A file that is gone when this is.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, std::string_view content)
      : folder_(std::filesystem::temp_directory_path() /
                ("binderjet-test-" + std::to_string(getpid()) + "-" + std::to_string(next()++))) {
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / name).string();
    std::ofstream(path_, std::ios::binary)
        .write(content.data(), static_cast<std::streamsize>(content.size()));
  }
  ~TemporaryFile() { std::filesystem::remove_all(folder_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  static int& next() {
    static int number = 0;
    return number;
  }

  std::filesystem::path folder_;
  std::string path_;
};

// What `work` throws, as one line; empty if it throws nothing.
template <typename Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace binderjet::testing
