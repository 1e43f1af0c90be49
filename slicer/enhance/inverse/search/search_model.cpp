// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/search_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace binderjet {
namespace {

// A dose of 1, such that sums of doses, levels and credits stay within 16 bits.
int dose_unit(std::span<const PrinterModel> window) {
  double most = 1;
  for (const PrinterModel& model : window) {
    double gains = 0;
    for (const DoseTerm& term : model.form().terms) gains += std::abs(term.gain);
    most = std::max(most, gains);
  }
  return static_cast<int>(8192 / most);
}

bool same_dose(const AssembledModel& a, const AssembledModel& b) {
  return a.placed.gains.empty() &&
         std::equal(a.terms.begin(), a.terms.end(), b.terms.begin(), b.terms.end(),
                    [](const DoseTerm& s, const DoseTerm& t) {
                      return s.layer == t.layer && s.x == t.x && s.y == t.y && s.gain == t.gain;
                    });
}

// A straight edge that is exact in the model must not fall short of the level by rounding: each end
// of each row of pixels in reach may be half a unit off.
int least_dose(const AssembledModel& form, const Grid& grid, int unit) {
  int rows = 0;
  for (const DoseTerm& term : form.terms) {
    rows += static_cast<int>(term.y.weights.size()) / grid.detail_vx[1] + 2;
  }
  return static_cast<int>(std::lround(form.level * unit)) - rows;
}

// Where the dose beside a straight edge of a half-plane reaches the level, in mm from the edge.
double edge_mm(const AssembledModel& form, const Grid& grid, int axis) {
  int first = 0;
  int last = 0;
  for (const DoseTerm& term : form.terms) {
    const Kernel& kernel = axis == 0 ? term.x : term.y;
    first = std::min(first, kernel.first);
    last = std::max(last, kernel.last());
  }
  double before = 0;
  double dose = 0;
  int at = first - 1;
  while (at <= last && dose < form.level) {
    ++at;
    before = dose;
    for (const DoseTerm& term : form.terms) {
      const Kernel& kernel = axis == 0 ? term.x : term.y;
      dose += term.gain * static_cast<double>(kernel.at(at)) / static_cast<double>(kernel.total());
    }
  }
  const double part = dose > before ? (form.level - before) / (dose - before) : 0;
  return (at + part) * grid.voxel_mm(axis);
}

// How far a corner of the process window moves straight edges.
double edge_move_mm(const AssembledModel& corner, const AssembledModel& printer, const Grid& grid) {
  double sum = 0;
  for (const int axis : {0, 1}) {
    sum += std::abs(edge_mm(corner, grid, axis) - edge_mm(printer, grid, axis));
  }
  return sum;
}

}  // namespace

std::vector<int> window_weights(std::span<const PrinterModel> window, const Grid& grid) {
  std::vector<double> moves_mm;
  double sum_mm = 0;
  for (const PrinterModel& corner : window.subspan(1)) {
    moves_mm.push_back(edge_move_mm(corner.form(), window.front().form(), grid));
    sum_mm += moves_mm.back();
  }
  std::vector<int> weights{kNominalWeight};
  for (const double move_mm : moves_mm) {
    const bool far = move_mm > sum_mm / static_cast<double>(moves_mm.size()) + 1e-9;
    weights.push_back(far ? kFarCornerWeight : 1);
  }
  return weights;
}

SearchModel::SearchModel(std::span<const PrinterModel> window, const MaskRules& its_rules,
                         const Grid& its_grid)
    : printer(window.front()),
      unit(dose_unit(window)),
      offsets(offsets_of(printer.form())),
      rules(its_rules),
      grid(its_grid) {
  const std::vector<int> weights = window_weights(window, grid);
  std::vector<const AssembledModel*> forms;
  for (const PrinterModel& model : window) {
    const AssembledModel& form = model.form();
    const auto known = std::find_if(forms.begin(), forms.end(), [&](const AssembledModel* other) {
      return same_dose(form, *other);
    });
    const auto at = static_cast<std::size_t>(known - forms.begin());
    if (known == forms.end()) {
      forms.push_back(&form);
      models.push_back({form.terms, {}});
    }
    const auto which = static_cast<std::size_t>(&model - window.data());
    models[at].levels.push_back({least_dose(form, grid, unit), weights[which]});
  }
}

}  // namespace binderjet
