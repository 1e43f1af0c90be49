// SPDX-License-Identifier: GPL-3.0-or-later
// Images as PNG, TIFF, JPEG, WebP, BMP, TGA or PNM, decoded by a program of its own,
// binderjet-read.
//
// A stranger's image that crashes its decoder, or never ends, costs that process, and this one says
// which image it was. The price is a start, 0.3 s of CPU, for the first image; the process then
// waits for more. binderjet without OpenImageIO's 250 libraries starts in a tenth of that.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace binderjet {

struct ImageSource {
  std::string path;                  // the file, or empty:
  std::span<const std::byte> bytes;  // the file's bytes
  std::string name;                  // for messages
};

struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<std::uint8_t> samples;  // rows from the top, channels of a pixel side by side
};

// Width, height and nothing more. Threads may read at once, here and below.
// Error{kBadInput} where the image cannot be read, Error{kUsage} where binderjet-read is missing.
Image read_image_size(const ImageSource& source);
// The first channel, where transparent over black.
Image read_gray_image(const ImageSource& source);
// Red, green, blue, in which gray has equal shares; a transparent pixel keeps its color. Squares of
// `factor` x `factor` pixels are averaged into one, and what is left of a row or column is left
// out.
Image read_color_image(const ImageSource& source, int factor = 1);

}  // namespace binderjet
