// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/choice/forward_trials.h"

#include <algorithm>
#include <map>
#include <string>

#include "slicer/base/work.h"
#include "slicer/calibrate/choice/null_draws.h"
#include "slicer/calibrate/residual/printed_error.h"
#include "slicer/model/effects/catalogue.h"

namespace binderjet {
namespace {

// One effect that was tried, and how many voxels fewer are wrong in each cell.
struct Tried {
  EffectSpec effect;
  Covariate covariate;
  unsigned along;
  std::vector<double> gain;

  double total() const { return sum_of_cells(gain); }
};

class Trials {
 public:
  Trials(const MeasuredJob& job, const EffectList& model, const LayerChoice& layers)
      : job_(job), model_(model), layers_(layers) {}

  std::vector<Tried> take() {
    const TrialList list = all_trials(job_.extent(), model_);
    Stage stage(job_.work, "trying effects", static_cast<std::int64_t>(list.wears.size()),
                "effects");
    try_orders(list.orders);
    try_wears(list.wears, stage);
    return std::move(out_);
  }
  double wrong() const { return static_cast<double>(sum_of(before_)); }

 private:
  // Layer k of the print is what the model makes of layer k + by, so all orders of layers need only
  // the prints that are there.
  void try_orders(const std::vector<OrderTrial>& orders) {
    printed_ = print_layers(job_, model_, LayerChoice(job_.masks.size(), true));
    std::map<int, WrongCounts> wrong;
    for (int by = -kMaxMovedLayers; by <= kMaxMovedLayers; ++by) {
      std::vector<Shared<RunLayer>> moved(printed_.size());
      for (int k = 0; k < job_.layers(); ++k) {
        const auto here = static_cast<std::size_t>(k);
        if (!layers_[here]) continue;
        const int from = k + by;
        moved[here] = from < 0 || from >= job_.layers()
                          ? std::make_shared<const RunLayer>(
                                RunLayer::powder(printed_[here]->width(), printed_[here]->height()))
                          : printed_[static_cast<std::size_t>(from)];
      }
      wrong[by] = wrong_counts(job_, moved);
    }
    before_ = wrong[0];
    for (const OrderTrial& order : orders) {
      WrongCounts after(before_.size());
      for (int k = 0; k < job_.layers(); ++k) {
        const auto here = static_cast<std::size_t>(k);
        const int by = order.by(job_.first_layer + k);
        after[here] = wrong[std::clamp(by, -kMaxMovedLayers, kMaxMovedLayers)][here];
      }
      out_.push_back({order.effect, order.covariate, kAlongZ, gains(before_, after)});
    }
  }

  // A sample of the layers is enough to choose.
  void try_wears(const std::vector<WearTrial>& wears, Stage& stage) {
    LayerChoice some(layers_.size(), false);
    int count = 0;
    for (std::size_t k = 0; k < layers_.size(); ++k) some[k] = layers_[k] && count++ % 3 == 0;
    WrongCounts before = before_;
    for (std::size_t k = 0; k < some.size(); ++k) {
      if (!some[k]) before[k] = {};
    }
    const double all = std::max(1.0, wrong()) / std::max(1.0, static_cast<double>(sum_of(before)));
    for (const WearTrial& wear : wears) {
      AssembledModel form = assemble({wear.effect}, job_.grid, job_.place);
      form.bind_at(0.5);  // a printer model must bind; what is worn here is bound already
      const PrinterModel printer(form, job_.grid, job_.place);
      const auto print = worn_layers(job_, printer, printed_, some);
      std::vector<double> gain = gains(before, wrong_counts(job_, print));
      for (double& cell : gain) cell *= all;
      out_.push_back({wear.effect, wear.covariate, kNowhere, std::move(gain)});
      stage.advance();
    }
  }

  const MeasuredJob& job_;
  const EffectList& model_;
  const LayerChoice& layers_;
  std::vector<Shared<RunLayer>> printed_;  // by the model as it is
  WrongCounts before_;
  std::vector<Tried> out_;
};

// Among layers of one shape nothing says which was lost: the middle one is wrong by the least on a
// part that has another shape there.
const Tried* middle_of_equals(const std::vector<Tried>& tried, const Tried& best) {
  std::vector<const Tried*> equals;
  for (const Tried& one : tried) {
    if (one.effect.kind == best.effect.kind && one.gain == best.gain) equals.push_back(&one);
  }
  return equals[(equals.size() - 1) / 2];
}

double search_step(const EffectSpec& effect, const std::string& name, double value,
                   const Grid& grid) {
  const NumberRule& rule = find_effect_kind(effect.kind)->rule(name);
  return rule.search_step == nullptr ? 0 : rule.search_step(effect, value, grid);
}

}  // namespace

std::vector<ScoredTrial> rank_trials(const MeasuredJob& job, const EffectList& model,
                                     const LayerChoice& layers) {
  Trials trials(job, model, layers);
  const std::vector<Tried> tried = trials.take();
  std::vector<const std::vector<double>*> family;
  // What makes the print worse is no chance finding either way.
  for (const Tried& one : tried) {
    if (one.total() > 0) family.push_back(&one.gain);
  }
  const double wrong = std::max(1.0, trials.wrong());

  // The best of each kind, in the order of trying: among equals the first is the simplest.
  std::vector<const Tried*> best;
  for (const Tried& one : tried) {
    const auto of_kind = std::find_if(best.begin(), best.end(), [&](const Tried* other) {
      return other->effect.kind == one.effect.kind;
    });
    if (of_kind == best.end()) {
      best.push_back(&one);
    } else if (one.total() > (*of_kind)->total()) {
      *of_kind = &one;
    }
  }
  std::vector<ScoredTrial> out;
  for (const Tried* one : best) {
    if (one->total() <= 0) continue;
    one = middle_of_equals(tried, *one);
    ScoredTrial trial;
    trial.candidate.kind = one->effect.kind;
    trial.candidate.covariate = one->covariate;
    trial.candidate.along = one->along;
    trial.candidate.effect = model.size();
    trial.model = with_effect(model, one->effect);
    trial.share = one->total() / wrong;
    trial.p = p_over_all_gains(family, one->total());
    trial.folds_agree = slabs_agree(one->gain, one->along);
    out.push_back(std::move(trial));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const ScoredTrial& a, const ScoredTrial& b) { return a.share > b.share; });
  return out;
}

EffectList with_places_fitted(const MeasuredJob& job, EffectList model, std::size_t effect,
                              const LayerChoice& layers) {
  std::vector<std::pair<std::string, std::size_t>> places;
  for (const auto& [name, values] : model[effect].numbers) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (search_step(model[effect], name, values[i], job.grid) > 0) places.emplace_back(name, i);
    }
  }
  if (places.empty()) return model;
  double wrong = wrong_share(job, model, layers);
  // Large steps first; one that helps is taken again.
  for (const double steps : {4.0, 1.0}) {
    for (const auto& [name, index] : places) {
      for (const double sign : {-1.0, 1.0}) {
        for (int moves = 0; moves < 4; ++moves) {
          EffectList next = model;
          double& value = next[effect].numbers.at(name)[index];
          value += sign * steps * search_step(next[effect], name, value, job.grid);
          if (!check_effect(next[effect]).what.empty()) break;
          const double after = wrong_share(job, next, layers);
          if (after >= wrong) break;
          model = std::move(next);
          wrong = after;
        }
      }
    }
  }
  return model;
}

}  // namespace binderjet
