// SPDX-License-Identifier: GPL-3.0-or-later
// Images through OpenImageIO, within binderjet-read. The sizes and words are checked by who asked.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include "slicer/images/message.h"

namespace binderjet {

struct DecodedImage {
  int width = 0;
  int height = 0;
  std::vector<std::byte> samples;
};

// std::runtime_error in words for a person if OpenImageIO cannot decode it.
DecodedImage decode_image(const ImageRequest& request, std::span<const std::byte> content);

}  // namespace binderjet
