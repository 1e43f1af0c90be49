// SPDX-License-Identifier: GPL-3.0-or-later
// The effect catalogue as candidates (shared data: effect_catalogue.csv).
#include <algorithm>
#include <utility>

#include "slicer/calibrate/candidates/candidate_list.h"

namespace binderjet {

void CandidateList::add(const std::string& kind, Covariate covariate, std::vector<Column> columns,
                        unsigned along, std::function<EffectList(std::span<const double>)> apply) {
  out_.push_back(
      {kind, std::move(covariate), std::move(columns), along, std::move(apply), model_.size()});
}

void CandidateList::add_from_zero(const std::string& kind, Covariate covariate, double step,
                                  const std::function<EffectSpec(double)>& effect, double least,
                                  double most) {
  Column column;
  column.basis = Column::Basis::kModel;
  column.nudged = with_effect(model_, effect(step));
  column.step = step;
  add(kind, std::move(covariate), {column}, kNowhere,
      [model = model_, effect, least, most](std::span<const double> c) {
        return c[0] < least || c[0] > most ? EffectList{} : with_effect(model, effect(c[0]));
      });
}

std::vector<Candidate> named_candidates(const MeasuredJob& job, const EffectList& model) {
  CandidateList list(job, model);
  add_dose_candidates(list);
  add_shift_candidates(list);
  add_bed_candidates(list);
  return list.take();
}

EffectList with_effect(EffectList model, EffectSpec effect) {
  model.push_back(std::move(effect));
  return model;
}

EffectList with_level_gain(EffectList model, double gain) {
  for (EffectSpec& effect : model) {
    if (!effect.numbers.contains("level")) continue;
    double& level = effect.numbers["level"].front();
    level = std::clamp(level / std::max(0.2, 1 + gain), 0.02, 1.0);
  }
  return model;
}

const EffectSpec* find_effect(const EffectList& model, const std::string& kind) {
  for (const EffectSpec& effect : model) {
    if (effect.kind == kind) return &effect;
  }
  return nullptr;
}

std::vector<double> frequencies(double extent, double shortest) {
  std::vector<double> out;
  const double step = 1 / (3 * extent);
  for (double f = 1 / extent; f <= 1 / shortest; f += step) out.push_back(f);
  return out;
}

}  // namespace binderjet
