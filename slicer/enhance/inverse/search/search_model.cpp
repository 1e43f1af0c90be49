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

}  // namespace

SearchModel::SearchModel(std::span<const PrinterModel> window, const MaskRules& its_rules,
                         const Grid& its_grid)
    : printer(window.front()),
      unit(dose_unit(window)),
      offsets(offsets_of(printer.form())),
      rules(its_rules),
      grid(its_grid) {
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
    models[at].levels.push_back(
        {least_dose(form, grid, unit), &model == &window.front() ? kNominalWeight : 1});
  }
}

}  // namespace binderjet
