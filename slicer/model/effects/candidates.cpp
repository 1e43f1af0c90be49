// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/candidates.h"

#include "slicer/model/effects/catalogue.h"

namespace binderjet {
namespace {

bool is_sought(const EffectKind& kind, const EffectList& model) {
  return !kind.once || find_effect(model, kind.name) == nullptr;
}

}  // namespace

void CandidateList::ask(const EffectKind& kind) {
  kind_ = &kind;
  kind.add_candidates(*this);
}

EffectSpec CandidateList::effect(std::map<std::string, std::string> words,
                                 std::map<std::string, std::vector<double>> numbers) const {
  return {kind_->name, std::move(words), std::move(numbers)};
}

std::size_t CandidateList::own_place() const {
  const EffectSpec* own = find_effect(model_, kind_->name);
  return own == nullptr ? model_.size() : static_cast<std::size_t>(own - model_.data());
}

Candidate& CandidateList::add(Covariate covariate, std::vector<Column> columns, unsigned along,
                              std::function<EffectList(Coefficients)> apply) {
  return out_.emplace_back(Candidate{.kind = kind_->name,
                                     .named = !kind_->nameless,
                                     .covariate = std::move(covariate),
                                     .columns = std::move(columns),
                                     .along = along,
                                     .apply = std::move(apply),
                                     .effect = model_.size()});
}

Candidate& CandidateList::add_effect(Covariate covariate, std::vector<Column> columns,
                                     unsigned along,
                                     const std::function<EffectSpec(Coefficients)>& effect) {
  return add(std::move(covariate), std::move(columns), along,
             [model = model_, effect](Coefficients c) { return with_effect(model, effect(c)); });
}

Candidate& CandidateList::add_from_zero(Covariate covariate, double step,
                                        const std::function<EffectSpec(double)>& effect,
                                        double least, double most) {
  const Column column{
      .basis = Column::Basis::kModel, .nudged = with_effect(model_, effect(step)), .step = step};
  return add(std::move(covariate), {column}, kNowhere,
             [model = model_, effect, least, most](Coefficients c) {
               return c[0] < least || c[0] > most ? EffectList{} : with_effect(model, effect(c[0]));
             });
}

std::vector<Candidate> all_candidates(const JobExtent& job, const EffectList& model) {
  CandidateList list(job, model);
  for (const EffectKind& kind : effect_kinds()) {
    if (kind.add_candidates != nullptr && is_sought(kind, model)) list.ask(kind);
  }
  return list.take();
}

TrialList all_trials(const JobExtent& job, const EffectList& model) {
  TrialList list{job, {}, {}};
  for (const EffectKind& kind : effect_kinds()) {
    if (kind.add_trials != nullptr && is_sought(kind, model)) kind.add_trials(list);
  }
  return list;
}

std::vector<GaugeChange> all_gauge_changes(const EffectList& declared) {
  std::vector<GaugeChange> out;
  for (const EffectKind& kind : effect_kinds()) {
    if (kind.add_gauge_changes != nullptr) kind.add_gauge_changes(declared, out);
  }
  return out;
}

std::vector<double> evenly(double from, double to, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(from + (to - from) * i / (count - 1));
  return out;
}

const EffectSpec* find_effect(const EffectList& model, const std::string& kind) {
  for (const EffectSpec& effect : model) {
    if (effect.kind == kind) return &effect;
  }
  return nullptr;
}

EffectList with_effect(EffectList model, EffectSpec effect) {
  model.push_back(std::move(effect));
  return model;
}

std::vector<double> frequencies(double extent, double shortest) {
  std::vector<double> out;
  const double step = 1 / (3 * extent);
  for (double f = 1 / extent; f <= 1 / shortest; f += step) out.push_back(f);
  return out;
}

}  // namespace binderjet
