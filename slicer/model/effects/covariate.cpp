// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/covariate.h"

#include <array>

namespace binderjet {

const std::string& word(Covariate::Axis axis) {
  static const std::array<std::string, 10> words{
      "", "x", "y", "z", "layer", "direction", "density", "facing", "edge_distance", "position"};
  return words.at(static_cast<std::size_t>(axis));
}

const std::string& word(Covariate::Form form) {
  static const std::array<std::string, 6> words{"", "trend", "periodic", "step", "window", "local"};
  return words.at(static_cast<std::size_t>(form));
}

}  // namespace binderjet
