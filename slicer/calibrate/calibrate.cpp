// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/calibrate.h"

#include <algorithm>

#include "slicer/base/work.h"
#include "slicer/calibrate/calibrator.h"
#include "slicer/calibrate/residual/residual_by_axis.h"
#include "slicer/calibrate/score_prints.h"

namespace binderjet {

bool far_above_floor(const BeforeAfter& score, bool scanned) {
  const double most = scanned ? 3 : 1.5;
  return score.floor && score.after.wrong > most * score.floor->wrong;
}

Verdict verdict_of(const std::vector<FoundEffect>& effects, bool far_above) {
  if (effects.empty()) return far_above ? Verdict::kUnexplained : Verdict::kNone;
  const bool named = std::any_of(effects.begin(), effects.end(),
                                 [](const FoundEffect& effect) { return effect.named; });
  return named ? Verdict::kEffect : Verdict::kUnexplained;
}

Calibration calibrate(const MeasuredJob& job, const std::vector<MeasuredJob>& checks,
                      const std::vector<EffectSpec>& declared, const CalibrationLimits& limits) {
  Calibrator calibrator(job, declared, limits);
  calibrator.run();

  Calibration out;
  out.before_model = declared;
  out.after_model = calibrator.model();
  out.effects = calibrator.effects();
  out.remaining = calibrator.remaining();
  job.work.note("before and after");
  for (const MeasuredJob& check : checks) {
    const LayerChoice all(check.masks.size(), true);
    out.scores.push_back(score_models(check, check.name, declared, out.after_model, all));
  }
  out.scores.push_back(
      score_models(job, "held-out layers", declared, out.after_model, calibrator.held_out()));
  out.verdict = verdict_of(out.effects, far_above_floor(out.scores.back(), job.scanned));
  const Stage stage(job.work, "following the residual");
  out.profiles = residual_profiles(job, declared, out.after_model);
  return out;
}

}  // namespace binderjet
