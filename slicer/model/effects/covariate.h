// SPDX-License-Identifier: GPL-3.0-or-later
// What an effect depends on, as calibration.json and the report say it.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace binderjet {

struct Covariate {
  enum class Axis {
    kNone,  // the same everywhere
    kX,
    kY,
    kZ,
    kLayer,
    kDirection,  // the place along a direction on the bed
    kDensity,    // the solid share around
    kFacing,     // which way the surface faces
    kEdgeDistance,
    kPosition,  // on the bed
  };
  enum class Form { kConstant, kTrend, kPeriodic, kStep, kWindow, kLocal };

  Axis axis = Axis::kNone;
  Form form = Form::kConstant;
  // By the keys of calibration.json (covariate_numbers()).
  std::map<std::string, std::vector<double>> numbers{};

  bool operator==(const Covariate&) const = default;
};

// The numbers that a dependence may have, each with what it means and its unit.
struct CovariateNumber {
  const char* name;
  const char* meaning;
};
const std::vector<CovariateNumber>& covariate_numbers();

// The words of calibration.json; "" for none and for constant.
const std::string& word(Covariate::Axis axis);
const std::string& word(Covariate::Form form);

}  // namespace binderjet
