// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "slicer/calibrate/choose.h"
#include "slicer/calibrate/fit.h"
#include "slicer/calibrate/profiles.h"
#include "slicer/calibrate/score_prints.h"

namespace binderjet {
namespace {

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

// An effect that was found, and where its numbers are in the model.
struct Taken {
  FoundEffect found;
  std::size_t effect = 0;
};

class Calibrator {
 public:
  Calibrator(const MeasuredJob& job, const Model& declared, const CalibrationLimits& limits,
             const std::function<void(const std::string&)>& step)
      : job_(job),
        limits_(limits),
        step_(step),
        held_(held_out_layers(job)),
        seen_(others(held_)),
        model_(declared),
        declared_effects_(declared.size()),
        first_wrong_(wrong_share(job, declared, held_)),
        wrong_(first_wrong_) {}

  void run() {
    while (static_cast<int>(taken_.size()) < limits_.most_effects && add_one()) {
    }
    drop_superseded();
    if (!taken_.empty()) refit_all();
  }

  const Model& model() const { return model_; }
  const LayerChoice& held_out() const { return held_; }
  const std::optional<Remaining>& remaining() const { return remaining_; }

  std::vector<FoundEffect> effects() const {
    std::vector<FoundEffect> out;
    for (const Taken& taken : taken_) {
      out.push_back(taken.found);
      FoundEffect& found = out.back();
      const EffectSpec& spec = model_[taken.effect];
      found.parameters = spec.numbers;
      // The covariate's own figures are the refitted ones.
      const auto copy = [&](const char* from, const char* to) {
        if (found.covariate.numbers.contains(to) && spec.numbers.contains(from)) {
          found.covariate.numbers[to] = spec.numbers.at(from);
        }
      };
      copy("period_mm", "period_mm");
      copy("period", found.covariate.axis == "layer" ? "period_layers" : "period_mm");
      copy("direction_deg", "direction_deg");
      copy("center_mm", "centre_mm");
    }
    return out;
  }

 private:
  std::vector<FreeNumber> numbers_of_taken() const {
    std::vector<FreeNumber> out;
    for (const Taken& taken : taken_) {
      const auto numbers = free_numbers(model_, taken.effect);
      out.insert(out.end(), numbers.begin(), numbers.end());
    }
    return out;
  }

  bool add_one() {
    step_(fmt::format("looking for effect {}", taken_.size() + 1));
    std::vector<Candidate> candidates = named_candidates(job_, model_);
    std::vector<Candidate> scan = scan_candidates(job_, model_);
    candidates.insert(candidates.end(), scan.begin(), scan.end());
    const auto points = surface_points(job_, model_, seen_, kChoicePoints, kPairReachMm);
    auto known = slopes(job_, model_, points, numbers_of_taken());
    for (auto& column : scanner_columns(job_, model_, points)) known.push_back(std::move(column));
    const std::vector<Choice> choices = choose(job_, model_, points, known, candidates);
    if (choices.empty()) return false;
    const Choice& best = choices.front();
    remaining_ = Remaining{candidates[best.winner].covariate, std::max(0.0, best.share)};
    step_(fmt::format("best is {} of {} ({}): {:.3f} of the residual, p {:.3f}",
                      candidates[best.winner].kind, candidates[best.winner].covariate.axis,
                      candidates[best.winner].covariate.form, best.share, best.p));
    if (best.p > limits_.most_p || best.share < limits_.least_share || !best.folds_agree) {
      return false;
    }
    return take_best_fit(candidates, choices);
  }

  // The regression is linear and blind to what was fused or lost; the real forward model decides
  // among those that it cannot part by far.
  bool take_best_fit(const std::vector<Candidate>& candidates, const std::vector<Choice>& choices) {
    constexpr std::size_t kMostTried = 3;
    constexpr int kTrialRounds = 3;
    struct Fitted {
      const Candidate* candidate;
      const Choice* choice;
      Model model;
      double wrong;
    };
    std::vector<Fitted> fitted;
    for (std::size_t i = 0; i < std::min(kMostTried, choices.size()); ++i) {
      const Candidate& candidate = candidates[choices[i].winner];
      Model model = refit_with_taken(candidate.apply(choices[i].coefficients), candidate.effect,
                                     kTrialRounds);
      const double wrong = wrong_share(job_, model, seen_);
      step_(fmt::format("fitted {}: {:.3f} of the residual, printed error {:.5f}", candidate.kind,
                        choices[i].share, wrong));
      fitted.push_back({&candidate, &choices[i], std::move(model), wrong});
    }
    // A hundredth is no reason to prefer what is less simple or has no name.
    constexpr double kClearly = 0.985;
    std::size_t best = 0;
    for (std::size_t i = 1; i < fitted.size(); ++i) {
      if (fitted[i].wrong < kClearly * fitted[best].wrong) best = i;
    }
    fitted[best].model = refit_with_taken(std::move(fitted[best].model),
                                          fitted[best].candidate->effect, kLastRounds);
    const double wrong = wrong_share(job_, fitted[best].model, held_);
    const bool enough = wrong_ - wrong >= limits_.least_gain * wrong_ &&
                        wrong_ - wrong >= limits_.least_gain / 2 * first_wrong_;
    step_(fmt::format("{}: printed error {:.5f} to {:.5f} on layers not seen",
                      fitted[best].candidate->kind, wrong_, wrong));
    if (!enough) return false;

    Taken taken;
    const Candidate& candidate = *fitted[best].candidate;
    taken.found.kind = candidate.kind;
    taken.found.covariate = candidate.covariate;
    taken.found.p = fitted[best].choice->p;
    taken.found.heldout_gain = fitted[best].choice->share;
    for (const Fitted& other : fitted) {
      constexpr double kRival = 1.015;
      if (other.candidate->kind == candidate.kind) continue;
      if (other.choice->equal && other.wrong <= kRival * fitted[best].wrong) {
        std::vector<std::string>& rivals = taken.found.rivals;
        if (std::find(rivals.begin(), rivals.end(), other.candidate->kind) == rivals.end()) {
          rivals.push_back(other.candidate->kind);
        }
      }
    }
    taken.effect = candidate.effect;
    taken_.push_back(taken);
    model_ = std::move(fitted[best].model);
    wrong_ = wrong;
    remaining_.reset();
    return true;
  }

  static constexpr int kLastRounds = 4;

  Model refit_with_taken(Model model, std::size_t effect, int rounds) const {
    std::vector<FreeNumber> numbers = numbers_of_taken();
    const auto own = free_numbers(model, effect);
    numbers.insert(numbers.end(), own.begin(), own.end());
    return refit(job_, model, numbers, seen_, rounds);
  }

  // What was found first may stand for a part of what was found later; it goes if the others do as
  // well without it.
  void drop_superseded() {
    for (std::size_t i = 0; taken_.size() > 1 && i < taken_.size();) {
      const std::size_t place = taken_[i].effect;
      Model without = model_;
      if (place < declared_effects_) {
        ++i;  // a declared effect with another number
        continue;
      }
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(place));
      std::vector<FreeNumber> numbers;
      for (std::size_t k = 0; k < taken_.size(); ++k) {
        const std::size_t effect = taken_[k].effect - (taken_[k].effect > place ? 1 : 0);
        if (k == i) continue;
        const auto own = free_numbers(without, effect);
        numbers.insert(numbers.end(), own.begin(), own.end());
      }
      step_(fmt::format("trying without {}", taken_[i].found.kind));
      without = refit(job_, std::move(without), numbers, seen_, kLastRounds);
      const double wrong = wrong_share(job_, without, held_);
      if (wrong - wrong_ > limits_.least_gain / 2 * wrong) {
        ++i;
        continue;
      }
      model_ = std::move(without);
      wrong_ = wrong;
      taken_.erase(taken_.begin() + static_cast<std::ptrdiff_t>(i));
      for (Taken& taken : taken_) taken.effect -= taken.effect > place ? 1 : 0;
      i = 0;
    }
  }

  // All numbers together, those that were declared too.
  void refit_all() {
    step_("fitting all numbers");
    std::vector<FreeNumber> numbers;
    for (std::size_t effect = 0; effect < model_.size(); ++effect) {
      const auto own = free_numbers(model_, effect);
      numbers.insert(numbers.end(), own.begin(), own.end());
    }
    Model all = refit(job_, model_, numbers, seen_, kLastRounds);
    // What was declared is believed unless the print clearly says otherwise.
    constexpr double kClearly = 0.97;
    if (wrong_share(job_, all, seen_) < kClearly * wrong_share(job_, model_, seen_) &&
        wrong_share(job_, all, held_) < kClearly * wrong_share(job_, model_, held_)) {
      model_ = std::move(all);
    }
  }

  const MeasuredJob& job_;
  CalibrationLimits limits_;
  const std::function<void(const std::string&)>& step_;
  LayerChoice held_;
  LayerChoice seen_;
  Model model_;
  std::size_t declared_effects_;
  double first_wrong_;
  double wrong_;
  std::vector<Taken> taken_;
  std::optional<Remaining> remaining_;
};

std::string verdict_of(const std::vector<FoundEffect>& effects) {
  if (effects.empty()) return "none";
  const bool nameless = std::all_of(effects.begin(), effects.end(), [](const FoundEffect& effect) {
    return effect.kind == "empirical";
  });
  return nameless ? "unexplained" : "effect";
}

}  // namespace

Calibration calibrate(const MeasuredJob& job, const std::vector<MeasuredJob>& checks,
                      const std::vector<EffectSpec>& declared, const CalibrationLimits& limits,
                      const std::function<void(const std::string&)>& step) {
  Calibrator calibrator(job, declared, limits, step);
  calibrator.run();

  Calibration out;
  out.before_model = declared;
  out.after_model = calibrator.model();
  out.effects = calibrator.effects();
  out.verdict = verdict_of(out.effects);
  out.remaining = calibrator.remaining();
  step("before and after");
  for (const MeasuredJob& check : checks) {
    const LayerChoice all(check.masks.size(), true);
    out.scores.push_back(score_models(check, check.name, declared, out.after_model, all));
  }
  out.scores.push_back(
      score_models(job, "held-out layers", declared, out.after_model, calibrator.held_out()));
  out.profiles = residual_profiles(job, declared, out.after_model);
  return out;
}

}  // namespace binderjet
