// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/choice/forward_trials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "slicer/calibrate/choice/null_draws.h"
#include "slicer/calibrate/residual/printed_error.h"
#include "slicer/model/wear/opening.h"

namespace binderjet {
namespace {

// One model that was tried, and how many voxels fewer are wrong in each cell.
struct Tried {
  std::string kind;
  Covariate covariate;
  unsigned along;
  EffectList model;
  std::vector<double> gain;

  double total() const { return sum_of_cells(gain); }
};

class Trials {
 public:
  Trials(const MeasuredJob& job, const EffectList& model, const LayerChoice& layers)
      : job_(job), model_(model), layers_(layers) {}

  std::vector<Tried> take() {
    try_layer_orders();
    try_wear();
    return std::move(out_);
  }
  double wrong() const { return static_cast<double>(sum_of(before_)); }

 private:
  bool has(const std::string& kind) const { return find_effect(model_, kind) != nullptr; }

  // Layers that were lost or came twice, and a height that is compressed: layer k of the print is
  // what the model makes of layer k + by, so all of them need only the prints that are there.
  void try_layer_orders() {
    printed_ = print_layers(job_, model_, LayerChoice(job_.masks.size(), true));
    constexpr int kMost = 3;
    std::map<int, WrongCounts> wrong;
    for (int by = -kMost; by <= kMost; ++by) {
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
    const double pitch = job_.grid.pitch_mm[2];
    const auto add = [&](const std::string& kind, const Covariate& covariate,
                         const EffectSpec& effect, auto by_of) {
      WrongCounts after(before_.size());
      for (int k = 0; k < job_.layers(); ++k) {
        const auto here = static_cast<std::size_t>(k);
        after[here] = wrong[std::clamp(by_of(k), -kMost, kMost)][here];
      }
      out_.push_back(
          {kind, covariate, kAlongZ, with_effect(model_, effect), gains(before_, after)});
    };
    for (int from = 1; from < job_.layers(); ++from) {
      const double at_mm = (job_.first_layer + from) * pitch;
      for (const int by : {-2, -1, 1, 2}) {
        add("slice_dropout", {"z", "step", {{"at_mm", {at_mm}}}},
            {"slice_dropout", {}, {{"at_mm", {at_mm}}, {"layers", {static_cast<double>(by)}}}},
            [&](int k) { return k >= from ? by : 0; });
      }
    }
    if (has("recoat_compress")) return;
    // Shares that move the top by half a layer more each.
    const int top = job_.first_layer + job_.layers();
    for (int halves = -2 * kMost; halves <= 2 * kMost; ++halves) {
      const double share = halves / 2.0 / top;
      if (halves == 0 || std::abs(share) > 0.2) continue;
      add("recoat_compress", {"z", "trend", {}}, {"recoat_compress", {}, {{"share", {share}}}},
          [&](int k) {
            const int layer = job_.first_layer + k;
            return static_cast<int>(std::floor((layer + 0.5) / (1 - share))) - layer;
          });
    }
  }

  // What happens to the part when it is dug out: done to what is printed already. A sample of the
  // layers is enough to choose.
  void try_wear() {
    const EffectSpec level{"threshold", {}, {{"level", {0.5}}}};
    LayerChoice some(layers_.size(), false);
    int count = 0;
    for (std::size_t k = 0; k < layers_.size(); ++k) some[k] = layers_[k] && count++ % 3 == 0;
    WrongCounts before = before_;
    for (std::size_t k = 0; k < some.size(); ++k) {
      if (!some[k]) before[k] = {};
    }
    const double all = std::max(1.0, wrong()) / std::max(1.0, static_cast<double>(sum_of(before)));
    const auto add_print = [&](const std::string& kind, const std::string& axis,
                               const EffectSpec& effect,
                               const std::vector<Shared<RunLayer>>& print) {
      std::vector<double> gain = gains(before, wrong_counts(job_, print));
      for (double& cell : gain) cell *= all;
      out_.push_back(
          {kind, {axis, "local", {}}, kNowhere, with_effect(model_, effect), std::move(gain)});
    };
    const auto add = [&](const std::string& kind, const std::string& axis,
                         const EffectSpec& effect) {
      const PrinterModel printer({level, effect}, job_.grid, job_.place);
      add_print(kind, axis, effect, worn_layers(job_, printer, printed_, some));
    };
    if (!has("rounding")) {
      for (const double radius_mm : {0.07, 0.13}) {
        add("rounding", "facing",
            {"rounding", {{"shape", "gaussian"}}, {{"radius_mm", {radius_mm}}}});
      }
      for (const char* shape : {"disc", "ball"}) {
        for (const double radius_mm : {0.11, 0.21}) {
          add("rounding", "facing", {"rounding", {{"shape", shape}}, {{"radius_mm", {radius_mm}}}});
        }
      }
    }
    if (!has("infiltrant")) {
      for (const double radius_mm : {0.12, 0.25}) {
        for (const double skin_mm : {0.0, 0.06}) {
          add("infiltrant", "facing",
              {"infiltrant", {}, {{"radius_mm", {radius_mm}}, {"skin_mm", {skin_mm}}}});
        }
      }
    }
    if (has("survive")) return;
    for (const double width_mm : {0.25, 0.5}) {
      std::vector<Shared<RunLayer>> print(printed_.size());
      for (std::size_t k = 0; k < print.size(); ++k) {
        if (!some[k]) continue;
        print[k] = std::make_shared<const RunLayer>(
            opening(*printed_[k], {pixels_for(width_mm, job_.grid.voxel_mm(0)),
                                   pixels_for(width_mm, job_.grid.voxel_mm(1))}));
      }
      add_print("survive", "density", {"survive", {}, {{"width_mm", {width_mm, width_mm}}}}, print);
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
    if (one.kind == best.kind && one.gain == best.gain) equals.push_back(&one);
  }
  return equals[(equals.size() - 1) / 2];
}

// How a number that names a place or a size is moved: by steps of this; 0 for others.
double place_step(const EffectSpec& effect, const std::string& name, double value,
                  const Grid& grid) {
  const bool on_bed =
      name == "from_mm" || name == "to_mm" || name == "from" || name == "to" || name == "at";
  const auto word = [&](const std::string& key, const std::string& value_of) {
    const auto found = effect.words.find(key);
    return found != effect.words.end() && found->second == value_of;
  };
  if (name == "at_mm") return grid.pitch_mm[2];
  if (on_bed && word("axis", "z")) return grid.pitch_mm[2];
  if (on_bed && (word("axis", "x") || word("across", "x"))) return grid.voxel_mm(0);
  if (on_bed && (word("axis", "y") || word("across", "y") || effect.kind == "jet_out")) {
    return grid.voxel_mm(1);
  }
  if (name == "radius_mm" && effect.kind != "density") return 0.1 * value;
  if (name == "skin_mm") return grid.voxel_mm(1);
  if (name == "width_mm" && effect.kind == "survive") return 0.1 * value;
  if (name == "share" && effect.kind == "recoat_compress") return 0.1 * std::abs(value);
  return 0;
}

}  // namespace

std::vector<Trial> try_effects(const MeasuredJob& job, const EffectList& model,
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
    const auto of_kind = std::find_if(best.begin(), best.end(),
                                      [&](const Tried* other) { return other->kind == one.kind; });
    if (of_kind == best.end()) {
      best.push_back(&one);
    } else if (one.total() > (*of_kind)->total()) {
      *of_kind = &one;
    }
  }
  std::vector<Trial> out;
  for (const Tried* one : best) {
    if (one->total() <= 0) continue;
    one = middle_of_equals(tried, *one);
    Trial trial;
    trial.candidate.kind = one->kind;
    trial.candidate.covariate = one->covariate;
    trial.candidate.along = one->along;
    trial.candidate.effect = model.size();
    trial.model = one->model;
    trial.share = one->total() / wrong;
    trial.p = family_p(family, one->total());
    trial.folds_agree = slabs_agree(one->gain, one->along);
    out.push_back(std::move(trial));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Trial& a, const Trial& b) { return a.share > b.share; });
  return out;
}

EffectList with_places_fitted(const MeasuredJob& job, EffectList model, std::size_t effect,
                              const LayerChoice& layers) {
  std::vector<std::pair<std::string, std::size_t>> places;
  for (const auto& [name, values] : model[effect].numbers) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (place_step(model[effect], name, values[i], job.grid) > 0) places.emplace_back(name, i);
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
          value += sign * steps * place_step(next[effect], name, value, job.grid);
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
