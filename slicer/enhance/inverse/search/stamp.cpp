// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/stamp.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace binderjet {
namespace {

// The share of one pixel's binder along an axis, in voxels from its first: the kernel of each of
// its `repeat` voxels.
std::vector<double> along(const Kernel& kernel, int repeat) {
  std::vector<double> shares(kernel.weights.size() + static_cast<std::size_t>(repeat) - 1, 0);
  const auto total = static_cast<double>(kernel.total());
  for (std::size_t voxel = 0; voxel < static_cast<std::size_t>(repeat); ++voxel) {
    for (std::size_t i = 0; i < kernel.weights.size(); ++i) {
      shares[voxel + i] += static_cast<double>(kernel.weights[i]) / total;
    }
  }
  return shares;
}

// The corner and size that hold all terms of a layer.
Stamp empty_stamp(std::span<const DoseTerm> terms, int layer, const Grid& grid) {
  Stamp stamp;
  stamp.layer = layer;
  std::array<int, 2> last{};
  bool any = false;
  for (const DoseTerm& term : terms) {
    if (term.layer != layer) continue;
    const std::array<const Kernel*, 2> kernels{&term.x, &term.y};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const int end = kernels[axis]->last() + grid.detail_vx[axis] - 1;
      stamp.first[axis] =
          any ? std::min(stamp.first[axis], kernels[axis]->first) : kernels[axis]->first;
      last[axis] = any ? std::max(last[axis], end) : end;
    }
    any = true;
  }
  stamp.width = whole_vectors(last[0] - stamp.first[0] + 1);
  stamp.height = last[1] - stamp.first[1] + 1;
  return stamp;
}

Stamp stamp_of(std::span<const DoseTerm> terms, int layer, const Grid& grid, int unit) {
  Stamp stamp = empty_stamp(terms, layer, grid);
  std::vector<double> sum(
      static_cast<std::size_t>(stamp.width) * static_cast<std::size_t>(stamp.height), 0);
  for (const DoseTerm& term : terms) {
    if (term.layer != layer) continue;
    const std::vector<double> x = along(term.x, grid.detail_vx[0]);
    const std::vector<double> y = along(term.y, grid.detail_vx[1]);
    const auto dx = static_cast<std::size_t>(term.x.first - stamp.first[0]);
    const auto dy = static_cast<std::size_t>(term.y.first - stamp.first[1]);
    for (std::size_t j = 0; j < y.size(); ++j) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        sum[(dy + j) * static_cast<std::size_t>(stamp.width) + dx + i] += term.gain * x[i] * y[j];
      }
    }
  }
  for (const double share : sum) {
    stamp.dose.push_back(static_cast<int>(std::lround(share * unit)));
    stamp.total += stamp.dose.back();
  }
  return stamp;
}

bool same_dose(const AssembledModel& a, const AssembledModel& b) {
  return a.placed.gains.empty() &&
         std::equal(a.terms.begin(), a.terms.end(), b.terms.begin(), b.terms.end(),
                    [](const DoseTerm& s, const DoseTerm& t) {
                      return s.layer == t.layer && s.x == t.x && s.y == t.y && s.gain == t.gain;
                    });
}

int min_dose(const AssembledModel& form, const std::vector<Stamp>& stamps, int unit) {
  // Each pixel in reach may be half a unit off.
  std::size_t pixels = 1;
  for (const Stamp& stamp : stamps) pixels += stamp.dose.size();
  return static_cast<int>(std::lround(form.level * unit)) - static_cast<int>(pixels / 2);
}

int dose_unit(const AssembledModel& form) {
  double gains = 0;
  for (const DoseTerm& term : form.terms) gains += std::abs(term.gain);
  return static_cast<int>((1 << 29) / std::max(1.0, gains));
}

StampedModel stamped(const AssembledModel& form, const Grid& grid) {
  StampedModel model;
  model.terms = form.terms;
  model.unit = dose_unit(form);
  std::set<int> layers;
  for (const DoseTerm& term : form.terms) layers.insert(term.layer);
  for (const int layer : layers) {
    model.stamps.push_back(stamp_of(form.terms, layer, grid, model.unit));
  }
  return model;
}

}  // namespace

std::vector<StampedModel> stamped(std::span<const PrinterModel> models,
                                  std::span<const int> weights, const Grid& grid) {
  std::vector<StampedModel> out;
  std::vector<const AssembledModel*> forms;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const AssembledModel& form = models[m].form();
    const auto known = std::find_if(forms.begin(), forms.end(), [&](const AssembledModel* other) {
      return same_dose(form, *other);
    });
    const auto at = static_cast<std::size_t>(known - forms.begin());
    if (known == forms.end()) {
      forms.push_back(&form);
      out.push_back(stamped(form, grid));
    }
    out[at].levels.push_back({min_dose(form, out[at].stamps, out[at].unit), weights[m]});
  }
  return out;
}

}  // namespace binderjet
