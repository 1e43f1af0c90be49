// SPDX-License-Identifier: GPL-3.0-or-later
// What a calibration finds: the residual of a declared model traced to effects that it lacks
// (slicer/MODEL.md, "How calibrate chooses"), as plain data for calibration.json, the new profile
// and the report.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slicer/model/effects/covariate.h"
#include "slicer/model/effects/effect.h"

namespace binderjet {

struct FoundEffect {
  std::string kind;   // its word in calibration.json
  bool named = true;  // false: the residual follows the covariate, and no effect says why
  std::map<std::string, std::vector<double>> parameters;
  Covariate covariate;
  std::vector<std::string> rivals;  // kinds that this print cannot tell from it
  double p = 1;                     // over all candidates that were tried
  // The share of the residual's power that is gone where the fit did not look; of what moves no dose
  // and was tried in the forward model, the share of the wrong voxels of the layers that were seen.
  double heldout_gain = 0;
};

// How far one set of layers is from another: |a xor b| / |b|, and edges in mm.
struct PrintError {
  double wrong = 0;
  double mean_mm = 0;
  double p95_mm = 0;
  double max_mm = 0;
};

// The same data predicted by both models; the fit saw none of it.
struct BeforeAfter {
  std::string name;  // "held-out layers", or the second print
  PrintError before;
  PrintError after;
  std::optional<PrintError> floor;  // one replicate against another, if there are two
};

// The residual along one coordinate, in mm that the surface lies further out than predicted.
struct ResidualProfile {
  std::string name;               // "x", "y", "layer", "edge distance", ...
  std::string unit;               // "mm", "", "deg"
  std::vector<double> centers;    // of bins, ascending
  std::vector<double> before_mm;  // means; as many as centers
  std::vector<double> after_mm;
  std::vector<std::int64_t> points;  // how many surface points are in each bin
};

// The residual that is left: what it depends on most, and how much of its power that is.
struct Remaining {
  Covariate covariate;
  double share = 0;
};

enum class Verdict {
  kNone,         // nothing is missing that the print shows
  kEffect,       // an effect that has a name is
  kUnexplained,  // only what has no name was found, or nothing, though the print is far off
};
// The word of calibration.json.
inline const char* word(Verdict verdict) {
  return verdict == Verdict::kNone     ? "none"
         : verdict == Verdict::kEffect ? "effect"
                                       : "unexplained";
}

struct Calibration {
  Verdict verdict = Verdict::kNone;
  std::vector<FoundEffect> effects;
  std::optional<Remaining> remaining;
  std::vector<BeforeAfter> scores;  // the first is what `before` and `after` of the JSON say
  std::vector<ResidualProfile> profiles;
  std::vector<EffectSpec> before_model;  // as declared
  std::vector<EffectSpec> after_model;   // refitted, with the effects found
};

}  // namespace binderjet
