// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/dose_filter.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

namespace binderjet {
namespace {

// A flip of some mask row, in voxels, and the sum of the weights that its rows have here.
struct Ramp {
  int at;
  std::size_t kernel;
  std::int64_t weight;
};

// Flips at one place are one ramp: along straight walls they all are.
void sort_and_merge(std::vector<Ramp>& ramps) {
  std::sort(ramps.begin(), ramps.end(), [](const Ramp& a, const Ramp& b) {
    return std::tie(a.at, a.kernel) < std::tie(b.at, b.kernel);
  });
  std::size_t kept = 0;
  for (const Ramp& ramp : ramps) {
    if (kept > 0 && ramps[kept - 1].at == ramp.at && ramps[kept - 1].kernel == ramp.kernel) {
      ramps[kept - 1].weight += ramp.weight;
    } else {
      ramps[kept++] = ramp;
    }
  }
  ramps.resize(kept);
  std::erase_if(ramps, [](const Ramp& ramp) { return ramp.weight == 0; });
}

// Adds the flips of a mask for voxel row `y` of the result.
void add_ramps(const RunLayer& mask, int y, std::array<int, 2> repeat, const Kernel& along_y,
               std::int64_t scale, std::size_t kernel, std::vector<Ramp>& ramps) {
  const int first = std::max(0, y - along_y.last());
  const int last = std::min(mask.height() * repeat[1] - 1, y - along_y.first);
  for (int voxel_row = first; voxel_row <= last;) {
    const int row = voxel_row / repeat[1];
    std::int64_t weight = 0;
    for (; voxel_row <= last && voxel_row / repeat[1] == row; ++voxel_row) {
      weight += along_y.at(y - voxel_row) * scale;
    }
    for (const int flip : mask.row(row)) {
      ramps.push_back({flip * repeat[0], kernel, weight});
      weight = -weight;
    }
  }
}

// Writes one row of the result while the dose is followed from left to right.
class RowBuilder {
 public:
  RowBuilder(RunLayer& out, const std::vector<Kernel>& kernels, std::int64_t least)
      : out_(out), kernels_(kernels), least_(least) {
    for (const Kernel& kernel : kernels) {
      first_ = std::min(first_, kernel.first);
      last_ = std::max(last_, kernel.last());
    }
  }

  void build(std::span<const Ramp> ramps) {
    dose_ = 0;
    solid_ = false;
    while (!ramps.empty()) {
      std::size_t near = 1;
      while (near < ramps.size() && ramps[near].at + first_ <= ramps[near - 1].at + last_ + 1) {
        ++near;
      }
      walk(ramps.first(near));
      ramps = ramps.subspan(near);
    }
    if (solid_) out_.flip(out_.width());
    out_.end_row();
  }

 private:
  // Follows the dose as far as these ramps change it.
  void walk(std::span<const Ramp> ramps) {
    const int begin = ramps.front().at + first_;
    const int end = ramps.back().at + last_ + 1;
    steps_.assign(static_cast<std::size_t>(end - begin), 0);
    for (const Ramp& ramp : ramps) {
      const Kernel& kernel = kernels_[ramp.kernel];
      std::int64_t* step = steps_.data() + (ramp.at + kernel.first - begin);
      for (const std::int64_t weight : kernel.weights) *step++ += weight * ramp.weight;
    }
    for (int x = begin; x < end; ++x) {
      dose_ += steps_[static_cast<std::size_t>(x - begin)];
      if ((dose_ >= least_) != solid_) {
        solid_ = !solid_;
        out_.flip(std::clamp(x, 0, out_.width()));
      }
    }
  }

  RunLayer& out_;
  const std::vector<Kernel>& kernels_;
  std::int64_t least_;
  int first_ = 0;
  int last_ = 0;
  std::int64_t dose_ = 0;
  bool solid_ = false;
  std::vector<std::int64_t> steps_;
};

}  // namespace

DoseFilter::DoseFilter(std::span<const DoseTerm> terms, double level, std::array<int, 2> repeat)
    : repeat_(repeat) {
  const auto total = [](const DoseTerm& term) {
    return static_cast<double>(term.x.total()) * static_cast<double>(term.y.total());
  };
  // One unit of dose is `unit`, a power of two of the first term's own: as fine as the sum of all
  // terms leaves room for.
  double most = 0;
  for (const DoseTerm& term : terms) most += std::abs(term.gain);
  double unit = total(terms.front());
  constexpr double kRoom = 4e18;
  for (int bit = 0; bit < 20 && unit * most * 2 < kRoom; ++bit) unit *= 2;

  for (const DoseTerm& term : terms) {
    const auto known = std::find(x_.begin(), x_.end(), term.x);
    const auto kernel = static_cast<std::size_t>(known - x_.begin());
    if (known == x_.end()) x_.push_back(term.x);
    terms_.push_back({term.layer, kernel, term.y, std::llround(term.gain * unit / total(term))});
  }
  // A product that is whole but for rounding is that number: an exact tie counts as bound.
  constexpr double kRounding = 1e-12;
  least_ = std::max<std::int64_t>(1, std::llround(std::ceil(level * unit * (1 - kRounding))));
}

RunLayer DoseFilter::operator()(std::span<const RunLayer* const> window) const {
  const int middle = static_cast<int>(window.size()) / 2;
  const RunLayer& mask = *window[static_cast<std::size_t>(middle)];
  const int height = mask.height() * repeat_[1];
  RunLayer out(mask.width() * repeat_[0]);
  out.reserve(height, mask.flip_count() * static_cast<std::size_t>(repeat_[1]));
  RowBuilder builder(out, x_, least_);
  std::vector<Ramp> ramps;
  for (int y = 0; y < height; ++y) {
    ramps.clear();
    for (const Term& term : terms_) {
      assert(std::abs(term.layer) <= middle);
      const RunLayer* from = window[static_cast<std::size_t>(middle + term.layer)];
      if (from != nullptr) add_ramps(*from, y, repeat_, term.y, term.scale, term.kernel, ramps);
    }
    sort_and_merge(ramps);
    builder.build(ramps);
  }
  return out;
}

}  // namespace binderjet
