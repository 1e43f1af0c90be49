// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/jet_out.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "slicer/model/effects/assembled_model.h"

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

}  // namespace

std::function<double(double)> share_from_jets(const AssembledModel& form, const Grid& grid,
                                              double from_mm, double to_mm) {
  const auto spread = std::make_shared<const Spread>(form);
  return [spread, from_mm, to_mm, voxel_mm = grid.voxel_mm(1)](double y_mm) {
    return spread->part((y_mm - from_mm) / voxel_mm) - spread->part((y_mm - to_mm) / voxel_mm);
  };
}

EffectKind jet_out_kind() {
  return {"jet_out",
          {},
          {{"from_mm", 1, -1000, 1000}, {"to_mm", 1, -1000, 1000}, {"amount", 1, -1, 2}},
          [](const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
            const double amount = spec.number("amount");
            form.placed.gains.push_back(
                {[amount, share = share_from_jets(form, grid, spec.number("from_mm"),
                                                  spec.number("to_mm"))](const Spot& spot) {
                   return amount * share(spot.y_mm);
                 },
                 std::abs(amount)});
          }};
}

}  // namespace binderjet
