// SPDX-License-Identifier: GPL-3.0-or-later
// The list of candidates as the files that know one sort of effect fill it.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "slicer/calibrate/candidates/candidate.h"

namespace binderjet {

class CandidateList {
 public:
  // Both must outlive the list.
  CandidateList(const MeasuredJob& job, const EffectList& model) : job_(job), model_(model) {}

  const MeasuredJob& job() const { return job_; }
  const EffectList& model() const { return model_; }
  double bottom_mm() const { return job_.first_layer * job_.grid.pitch_mm[2]; }
  bool has(const std::string& kind) const { return find_effect(model_, kind) != nullptr; }
  Candidate& last() { return out_.back(); }
  std::vector<Candidate> take() { return std::move(out_); }

  void add(const std::string& kind, Covariate covariate, std::vector<Column> columns,
           unsigned along, std::function<EffectList(std::span<const double>)> apply);
  // An effect whose parameter goes from 0: its column is the forward model's own difference. It
  // makes no sense below `least` and above `most`.
  void add_from_zero(const std::string& kind, Covariate covariate, double step,
                     const std::function<EffectSpec(double)>& effect, double least, double most);

 private:
  const MeasuredJob& job_;
  const EffectList& model_;
  std::vector<Candidate> out_;
};

void add_dose_candidates(CandidateList& list);   // dose_candidates.cpp
void add_shift_candidates(CandidateList& list);  // shift_candidates.cpp
void add_bed_candidates(CandidateList& list);    // bed_candidates.cpp

}  // namespace binderjet
