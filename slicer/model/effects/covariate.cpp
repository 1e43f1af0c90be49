// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/covariate.h"

#include <array>

namespace binderjet {

const std::vector<CovariateNumber>& covariate_numbers() {
  static const std::vector<CovariateNumber> all = {
      {"direction_deg", "the direction on the bed, degrees from x towards y"},
      {"period_mm", "of a periodic form, mm"},
      {"period_layers", "of a periodic form, layers"},
      {"at_mm", "where a step is, mm"},
      {"from_mm", "where a window begins, mm"},
      {"to_mm", "where a window ends, mm"},
      {"centre_mm", "the middle of a local form: x, y in mm"},
      {"radius_mm", "how far a local form reaches, mm"}};
  return all;
}

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
