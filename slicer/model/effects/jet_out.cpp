// SPDX-License-Identifier: GPL-3.0-or-later
// Weak jets: a row of the head gives less binder, along all of the fast axis (x).
//
//   from_mm, to_mm: the jets' place on the bed along y
//   amount: these jets give 1 + amount of their binder; above -1, at most 2, negative: less
//
// Binder spreads, so a row beyond the jets lacks what it would have got from them. The spread is
// that of the effects before this one in the model.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

// The running sum of how far binder spreads along y, in voxels: part(u) of it lands at most u
// further along.
class Spread {
 public:
  explicit Spread(const AssembledModel& form) {
    first_ = form.terms.front().y.first;
    int last = first_;
    for (const DoseTerm& term : form.terms) {
      first_ = std::min(first_, term.y.first);
      last = std::max(last, term.y.last());
    }
    std::vector<double> share(static_cast<std::size_t>(last - first_ + 1), 0);
    double all = 0;
    for (const DoseTerm& term : form.terms) {
      all += term.gain;
      const double scale = term.gain / static_cast<double>(term.y.total());
      for (std::size_t i = 0; i < term.y.weights.size(); ++i) {
        share[static_cast<std::size_t>(term.y.first - first_) + i] +=
            scale * static_cast<double>(term.y.weights[i]);
      }
    }
    for (const double one : share) sums_.push_back(sums_.back() + one / all);
  }

  double part(double offset_vx) const {
    // The weight of offset i is that of [i - 1/2, i + 1/2].
    const double place =
        std::clamp(offset_vx - first_ + 0.5, 0.0, static_cast<double>(sums_.size() - 1));
    const auto below = std::min(static_cast<std::size_t>(place), sums_.size() - 2);
    return std::lerp(sums_[below], sums_[below + 1], place - static_cast<double>(below));
  }

 private:
  int first_;
  std::vector<double> sums_{0};
};

// The share of its binder that a place at y_mm gets from the jets in [from_mm, to_mm), where all
// around is printed.
std::function<double(double y_mm)> share_from_jets(const AssembledModel& form, const Grid& grid,
                                                   double from_mm, double to_mm) {
  const auto spread = std::make_shared<const Spread>(form);
  return [spread, from_mm, to_mm, voxel_mm = grid.voxel_mm(1)](double y_mm) {
    return spread->part((y_mm - from_mm) / voxel_mm) - spread->part((y_mm - to_mm) / voxel_mm);
  };
}

void write_into(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
  const double amount = spec.number("amount");
  const auto share = share_from_jets(form, grid, spec.number("from_mm"), spec.number("to_mm"));
  form.placed.gains.push_back(
      {[amount, share](const Spot& spot) { return amount * share(spot.y_mm); }, std::abs(amount)});
}

EffectSpec effect(double from_mm, double to_mm, double amount) {
  return {"jet_out", {}, {{"from_mm", {from_mm}}, {"to_mm", {to_mm}}, {"amount", {amount}}}};
}

// Windows of 1 to 24 pixels, everywhere along y.
void add_candidates(CandidateList& list) {
  const JobExtent& job = list.job();
  const AssembledModel form = assemble(list.model(), job.grid, job.place);
  const double pixel = job.grid.pitch_mm[1];
  const double end = job.place.origin_mm[1] + job.place.size_mm[1];
  for (const int width_px : {1, 2, 4, 8, 16, 24}) {
    const double width = width_px * pixel;
    const double step = std::max(1, width_px / 4) * pixel;
    for (double from = job.place.origin_mm[1]; from + width <= end; from += step) {
      const double to = from + width;
      list.add_effect(
          {Covariate::Axis::kY, Covariate::Form::kWindow, {{"from_mm", {from}}, {"to_mm", {to}}}},
          {dose_column([share = share_from_jets(form, job.grid, from, to)](const Spot& s) {
            return share(s.y_mm);
          })},
          kAlongY,
          [from, to](Coefficients c) { return effect(from, to, std::clamp(c[0], -0.99, 1.9)); });
    }
  }
}

}  // namespace

EffectKind jet_out_effect() {
  return {.name = "jet_out",
          .numbers = {{.name = "from_mm", .min = -1000, .max = 1000, .search_step = one_voxel_y},
                      {.name = "to_mm", .min = -1000, .max = 1000, .search_step = one_voxel_y},
                      {.name = "amount", .min = -1, .max = 2, .fit_step = 0.005}},
          .write_into = write_into,
          .examples = {effect(5.8, 6.2, -0.5)},
          .add_candidates = add_candidates};
}

}  // namespace binderjet
