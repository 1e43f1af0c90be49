// SPDX-License-Identifier: GPL-3.0-or-later
// Rows as pictures have them: the first is the back of the bed, so that a viewer shows it as seen
// from above. Masks and stacks begin at the front.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace binderjet {

// `rows` are `height` rows of equal size.
inline std::vector<std::byte> back_first(std::span<const std::byte> rows, int height) {
  const std::size_t stride = rows.size() / static_cast<std::size_t>(height);
  std::vector<std::byte> out(rows.size());
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    std::copy_n(rows.end() - static_cast<std::ptrdiff_t>((y + 1) * stride), stride,
                out.begin() + static_cast<std::ptrdiff_t>(y * stride));
  }
  return out;
}

}  // namespace binderjet
