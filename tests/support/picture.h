// SPDX-License-Identifier: GPL-3.0-or-later
// Small pictures that tests leave beside themselves for people to look at.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "slicer/base/whole_file.h"
#include "slicer/stack/indexed_png.h"

namespace binderjet::pictures {

// Where pictures go: a folder in the directory that the test runs in, which is the build's.
inline std::string folder(const std::string& name) {
  const std::filesystem::path path = std::filesystem::current_path() / "pictures" / name;
  std::filesystem::create_directories(path);
  return path.string();
}

// value(x, y) is a place in the palette; y grows upwards. Each value becomes `scale` pixels.
template <class Value>
void write(const std::string& path, int width, int height, std::array<int, 2> scale,
           const std::vector<Rgb>& palette, Value value) {
  std::vector<std::uint8_t> pixels;
  for (int row = 0; row < height * scale[1]; ++row) {
    for (int column = 0; column < width * scale[0]; ++column) {
      pixels.push_back(
          static_cast<std::uint8_t>(value(column / scale[0], height - 1 - row / scale[1])));
    }
  }
  write_file(path,
             encode_indexed_png(pixels, width * scale[0], height * scale[1], palette, {0.1, 0.1}));
}

}  // namespace binderjet::pictures
