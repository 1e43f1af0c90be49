// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/calibrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "slicer/base/work.h"
#include "slicer/calibrate/choice/null_draws.h"
#include "slicer/calibrate/choice/random_layers.h"
#include "slicer/model/effects/catalogue.h"

namespace binderjet {
namespace {

constexpr int kLastRounds = 4;

// A quarter of the layers, none of them at a distance that an effect could follow.
LayerChoice held_out_layers(const MeasuredJob& job) {
  LayerChoice out;
  for (int k = 0; k < job.layers(); ++k) {
    auto h = static_cast<std::uint32_t>(job.first_layer + k) * 0x9e3779b1U;
    h ^= h >> 15;
    h *= 0x2c1b3c6dU;
    h ^= h >> 13;
    out.push_back((h & 3U) == 0);
  }
  if (std::none_of(out.begin(), out.end(), [](bool held) { return held; })) out.back() = true;
  return out;
}

LayerChoice others(LayerChoice layers) {
  layers.flip();
  return layers;
}

}  // namespace

Calibrator::Calibrator(const MeasuredJob& job, const EffectList& declared,
                       const CalibrationLimits& limits)
    : job_(job),
      limits_(limits),
      held_(held_out_layers(job)),
      seen_(others(held_)),
      model_(declared),
      declared_effects_(declared.size()),
      first_errors_([&] {
        const Stage stage(job.work, "scoring the declared model");
        return errors_of(declared);
      }()),
      errors_(first_errors_) {}

void Calibrator::run() {
  while (static_cast<int>(accepted_.size()) < limits_.max_effects && add_one()) {
  }
  drop_superseded();
  if (!accepted_.empty()) refit_all();
  look_for_random_layers();
}

std::vector<FoundEffect> Calibrator::effects() const {
  std::vector<FoundEffect> out;
  for (const AcceptedEffect& accepted : accepted_) {
    out.push_back(accepted.found);
    FoundEffect& found = out.back();
    const EffectSpec& spec = model_[accepted.effect];
    found.parameters = spec.numbers;
    const EffectKind& kind = *find_effect_kind(spec.kind);
    if (kind.update_covariate != nullptr) kind.update_covariate(spec, found.covariate);
  }
  return out;
}

std::vector<FreeNumber> Calibrator::numbers_of_accepted() const {
  std::vector<FreeNumber> out;
  for (const AcceptedEffect& accepted : accepted_) {
    const auto numbers = free_numbers(model_, accepted.effect);
    out.insert(out.end(), numbers.begin(), numbers.end());
  }
  return out;
}

std::vector<std::vector<float>> Calibrator::known_columns(
    const std::vector<SurfacePoint>& points) const {
  auto known = slopes(job_, model_, points, numbers_of_accepted());
  for (auto& column : scanner_columns(job_, model_, points)) known.push_back(std::move(column));
  return known;
}

bool Calibrator::add_one() {
  const std::string what = fmt::format("looking for effect {}", accepted_.size() + 1);
  job_.work.note(what);
  const Stage stage(job_.work, what);
  std::vector<FittedCandidate> fitted = fit_ranked_candidates();
  for (FittedCandidate& one : fit_ranked_trials()) fitted.push_back(std::move(one));
  return !fitted.empty() && accept_best(std::move(fitted));
}

// What the residual in dose points to. The regression is linear and blind to what was fused or
// lost; the real forward model decides among those that it cannot part by far.
std::vector<Calibrator::FittedCandidate> Calibrator::fit_ranked_candidates() {
  constexpr std::size_t kMaxTried = 4;
  constexpr int kTrialRounds = 3;
  const std::vector<Candidate> candidates = all_candidates(job_.extent(), model_);
  const auto points = surface_points(job_, model_, seen_, kChoicePoints, kPairReachMm);
  const std::vector<ScoredCandidate> ranked =
      rank_candidates(job_, model_, points, known_columns(points), candidates);
  if (ranked.empty()) return {};
  const ScoredCandidate& best = ranked.front();
  const Candidate& winner = candidates[best.place];
  remaining_ = Remaining{winner.covariate, std::max(0.0, best.share)};
  job_.work.note(fmt::format("best is {} of {} ({}): {:.3f} of the residual, p {:.3f}", winner.kind,
                             word(winner.covariate.axis), word(winner.covariate.form), best.share,
                             best.p));
  if (!limits_.sure(best.p, best.share) || best.share < limits_.min_share || !best.folds_agree)
    return {};
  untried_equals_.clear();
  std::vector<FittedCandidate> out;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    const ScoredCandidate& scored = ranked[i];
    const Candidate& candidate = candidates[scored.place];
    if (i >= kMaxTried) {
      if (scored.equal && candidate.named) untried_equals_.push_back(candidate.kind);
      continue;
    }
    FittedCandidate one{candidate, {}, scored.p, scored.share, scored.equal, {}};
    one.model =
        refit_with_accepted(candidate.apply(scored.coefficients), candidate.effect, kTrialRounds);
    out.push_back(std::move(one));
  }
  return out;
}

// What only the printed voxels show.
std::vector<Calibrator::FittedCandidate> Calibrator::fit_ranked_trials() {
  constexpr std::size_t kMaxTried = 2;
  std::vector<FittedCandidate> out;
  for (ScoredTrial& trial : rank_trials(job_, model_, seen_)) {
    if (out.size() == kMaxTried || trial.share < limits_.min_gain) break;
    job_.work.note(fmt::format("tried {}: {:.3f} of the wrong voxels, p {:.3f}{}",
                               trial.candidate.kind, trial.share, trial.p,
                               trial.folds_agree ? "" : ", in some places only"));
    if (!limits_.sure(trial.p, trial.share) || !trial.folds_agree) continue;
    FittedCandidate one{std::move(trial.candidate), {}, trial.p, trial.share, false, {}};
    one.model = with_places_fitted(job_, std::move(trial.model), one.candidate.effect, seen_);
    out.push_back(std::move(one));
  }
  return out;
}

bool Calibrator::accept_best(std::vector<FittedCandidate> fitted) {
  for (FittedCandidate& one : fitted) {
    one.counts = counts_of(one.model);
    job_.work.note(fmt::format("fitted {}: {:.3f} of the residual, {} voxels wrong",
                               one.candidate.kind, one.share, sum_of(one.counts)));
  }
  // A hundredth is no reason to prefer what is less simple or has no name.
  constexpr double kClearly = 0.985;
  std::size_t best = 0;
  for (std::size_t i = 1; i < fitted.size(); ++i) {
    const auto wrong = static_cast<double>(sum_of(fitted[i].counts));
    if (wrong < kClearly * static_cast<double>(sum_of(fitted[best].counts))) best = i;
  }
  const Candidate& candidate = fitted[best].candidate;
  EffectList model = with_places_fitted(job_, fitted[best].model, candidate.effect, seen_);
  model = refit_with_accepted(model, candidate.effect, kLastRounds);
  const Errors errors = errors_of(model);
  job_.work.note(fmt::format("{}: printed error {:.5f} to {:.5f} on layers not seen",
                             candidate.kind, errors_.held, errors.held));
  const auto enough = [&](double Errors::*of) {
    const double gain = errors_.*of - errors.*of;
    return gain >= limits_.min_gain * errors_.*of &&
           gain >= limits_.min_gain / 2 * first_errors_.*of;
  };
  // What is in some layers only may be in none of those not seen: folds along x and y have judged
  // it, and there it must do no harm.
  const bool in_layers = (candidate.along & kAlongZ) != 0;
  const bool harmless = errors.held <= errors_.held;
  if (!enough(&Errors::held) && !(in_layers && harmless && enough(&Errors::all))) return false;

  AcceptedEffect accepted;
  accepted.found.kind = candidate.kind;
  accepted.found.named = candidate.named;
  accepted.found.covariate = candidate.covariate;
  accepted.found.p = fitted[best].p;
  accepted.found.heldout_gain = fitted[best].share;
  accepted.found.rivals = rivals_of(fitted, best);
  accepted.effect = candidate.effect;
  accepted.along = candidate.along;
  accepted_.push_back(std::move(accepted));
  model_ = std::move(model);
  errors_ = errors;
  remaining_.reset();
  return true;
}

// Names that neither the printed voxels nor, if these are nearly as many, the residual can tell
// from the best. An effect without a name is no rival: it says no more than the residual does.
std::vector<std::string> Calibrator::rivals_of(const std::vector<FittedCandidate>& fitted,
                                               std::size_t best) const {
  constexpr double kNearly = 1.015;
  const WrongCounts before = counts_of(model_);
  const std::vector<double> gain = gains(before, fitted[best].counts);
  const auto fewest = static_cast<double>(sum_of(fitted[best].counts));
  std::vector<std::string> out;
  const auto add = [&](const std::string& kind) {
    const bool known = std::find(out.begin(), out.end(), kind) != out.end();
    if (!known && kind != fitted[best].candidate.kind) out.push_back(kind);
  };
  for (const FittedCandidate& other : fitted) {
    const bool nearly = static_cast<double>(sum_of(other.counts)) <= kNearly * fewest;
    if (!other.candidate.named) continue;
    if (alike(gain, gains(before, other.counts)) || (other.equal && nearly)) {
      add(other.candidate.kind);
    }
  }
  if (fitted[best].equal) std::for_each(untried_equals_.begin(), untried_equals_.end(), add);
  return out;
}

Calibrator::Errors Calibrator::errors_of(const EffectList& model) const {
  return {wrong_share(job_, model, held_),
          wrong_share(job_, model, LayerChoice(job_.masks.size(), true))};
}

WrongCounts Calibrator::counts_of(const EffectList& model) const {
  return wrong_counts(job_, print_layers(job_, model, seen_));
}

EffectList Calibrator::refit_with_accepted(const EffectList& model, std::size_t effect,
                                           int rounds) const {
  std::vector<FreeNumber> numbers = numbers_of_accepted();
  const auto own = free_numbers(model, effect);
  numbers.insert(numbers.end(), own.begin(), own.end());
  return refit(job_, model, numbers, seen_, rounds);
}

// What was found first may stand for a part of what was found later; it goes if the others do as
// well without it.
void Calibrator::drop_superseded() {
  for (std::size_t i = 0; accepted_.size() > 1 && i < accepted_.size();) {
    const std::size_t place = accepted_[i].effect;
    EffectList without = model_;
    if (place < declared_effects_) {
      ++i;  // a declared effect with another number
      continue;
    }
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(place));
    std::vector<FreeNumber> numbers;
    for (std::size_t k = 0; k < accepted_.size(); ++k) {
      const std::size_t effect = accepted_[k].effect - (accepted_[k].effect > place ? 1 : 0);
      if (k == i) continue;
      const auto own = free_numbers(without, effect);
      numbers.insert(numbers.end(), own.begin(), own.end());
    }
    const std::string what = fmt::format("trying without {}", accepted_[i].found.kind);
    job_.work.note(what);
    const Stage stage(job_.work, what);
    without = refit(job_, std::move(without), numbers, seen_, kLastRounds);
    const Errors errors = errors_of(without);
    const auto missed = [&](double Errors::*of) {
      return errors.*of - errors_.*of > limits_.min_gain / 2 * errors.*of;
    };
    const bool in_layers = (accepted_[i].along & kAlongZ) != 0;
    if (missed(&Errors::held) || (in_layers && missed(&Errors::all))) {
      ++i;
      continue;
    }
    model_ = std::move(without);
    errors_ = errors;
    accepted_.erase(accepted_.begin() + static_cast<std::ptrdiff_t>(i));
    for (AcceptedEffect& accepted : accepted_) accepted.effect -= accepted.effect > place ? 1 : 0;
    i = 0;
  }
}

// All numbers together, those that were declared too.
void Calibrator::refit_all() {
  job_.work.note("fitting all numbers");
  const Stage stage(job_.work, "fitting all numbers");
  std::vector<FreeNumber> numbers;
  for (std::size_t effect = 0; effect < model_.size(); ++effect) {
    const auto own = free_numbers(model_, effect);
    numbers.insert(numbers.end(), own.begin(), own.end());
  }
  EffectList all = refit(job_, model_, numbers, seen_, kLastRounds);
  // What was declared is believed unless the print clearly says otherwise.
  constexpr double kClearly = 0.97;
  if (wrong_share(job_, all, seen_) < kClearly * wrong_share(job_, model_, seen_) &&
      wrong_share(job_, all, held_) < kClearly * wrong_share(job_, model_, held_)) {
    model_ = std::move(all);
  }
}

// Last, since every shift that follows a rule would look like it.
void Calibrator::look_for_random_layers() {
  const auto kind =
      std::find_if(effect_kinds().begin(), effect_kinds().end(),
                   [](const EffectKind& one) { return one.random_layers != nullptr; });
  if (kind == effect_kinds().end()) return;
  job_.work.note("looking for " + kind->name);
  const Stage stage(job_.work, "looking for " + kind->name);
  const auto points = surface_points(job_, model_, LayerChoice(job_.masks.size(), true),
                                     kChoicePoints, kPairReachMm);
  const auto found = find_random_layers(job_, model_, points, known_columns(points));
  if (!found || found->p > limits_.max_p || found->share < limits_.min_gain) return;
  model_.push_back(kind->random_layers(found->sigma_mm));
  AcceptedEffect accepted;
  accepted.found.kind = kind->name;
  accepted.found.covariate = {Covariate::Axis::kLayer, Covariate::Form::kLocal};
  accepted.found.p = found->p;
  accepted.found.heldout_gain = found->share;
  accepted.effect = model_.size() - 1;
  accepted_.push_back(std::move(accepted));
}

}  // namespace binderjet
