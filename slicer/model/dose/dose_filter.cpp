// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/dose/dose_filter.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <tuple>

#include "slicer/model/dose/density_field.h"
#include "slicer/model/dose/shifted_mask.h"

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

std::int64_t part_of(std::int64_t weight, double share) {
  return std::llround(static_cast<double>(weight) * share);
}

// Adds the flips of a mask for voxel row `y` of the result.
void add_ramps(const RunLayer& mask, int y, std::array<int, 2> repeat, const BedDependence& placed,
               const Kernel& along_y, std::int64_t scale, std::size_t kernel,
               std::vector<Ramp>& ramps) {
  const int first = std::max(0, y - along_y.last());
  const int last = std::min(mask.height() * repeat[1] - 1, y - along_y.first);
  for (int voxel_row = first; voxel_row <= last;) {
    const int row = voxel_row / repeat[1];
    std::int64_t weight = 0;
    for (; voxel_row <= last && voxel_row / repeat[1] == row; ++voxel_row) {
      weight += along_y.at(y - voxel_row) * scale;
    }
    placed.for_each_weakening(mask.row(row), [&](int pixel, double share) {
      ramps.push_back({pixel * repeat[0], kernel, -part_of(weight, share)});
    });
    for (const int flip : mask.row(row)) {
      ramps.push_back({flip * repeat[0], kernel, weight});
      weight = -weight;
    }
  }
}

// The same as add_ramps() for a mask that is shifted; every weight is kFine * kFine times as large.
class ShiftedRamps {
 public:
  ShiftedRamps(const Grid& grid, const JobPlace& place, const BedDependence& placed)
      : grid_(grid), place_(place), placed_(placed) {}

  void add(const RunLayer& mask, int y, int layer, const Kernel& along_y, std::int64_t scale,
           std::size_t kernel, std::vector<Ramp>& ramps) const {
    const ShiftedMask shifted(grid_, place_, placed_, mask.width(), layer);
    const int ry = grid_.detail_vx[1];
    const int most = placed_.max_shift_vx(grid_, 1) + 1;
    const int first = std::max(0, (y - along_y.last() - most) / ry - 1);
    const int last = std::min(mask.height() - 1, (y - along_y.first + most) / ry);
    for (int row = first; row <= last; ++row) {
      const std::span<const int> flips = mask.row(row);
      if (flips.empty()) continue;
      const ShiftedMask::Row place = shifted.row(row);
      std::int64_t weight = 0;
      for (int voxel_row = row * ry; voxel_row < (row + 1) * ry; ++voxel_row) {
        const auto [whole, part] = split_fine((y - voxel_row) * kFine - place.shift);
        weight += (kFine - part) * along_y.at(whole) + part * along_y.at(whole + 1);
      }
      if (weight == 0) continue;
      weight *= scale;
      const auto add_flip = [&](int pixel, std::int64_t change) {
        const auto [at, part] = split_fine(shifted.edge(place, pixel));
        ramps.push_back({at, kernel, change * (kFine - part)});
        if (part != 0) ramps.push_back({at + 1, kernel, change * part});
      };
      placed_.for_each_weakening(
          flips, [&](int pixel, double share) { add_flip(pixel, -part_of(weight, share)); });
      for (const int flip : flips) {
        add_flip(flip, weight);
        weight = -weight;
      }
    }
  }

 private:
  const Grid& grid_;
  const JobPlace& place_;
  const BedDependence& placed_;
};

// By what the dose of a row's voxels is multiplied.
class RowGain {
 public:
  RowGain(const Grid& grid, const JobPlace& place, const BedDependence& placed, int layer,
          const DensityField* density)
      : grid_(grid), place_(place), placed_(placed), layer_(layer), density_(density) {
    for (const DoseGain& gain : placed.gains) {
      most_ *= 1 + gain.most;
      least_ *= std::max(0.0, 1 - gain.most);
    }
  }
  void at_row(int y) { y_ = y; }
  double operator()(int x) const {
    return gain_at_voxel(grid_, place_, placed_, density_, x, y_, layer_);
  }
  bool none() const { return placed_.gains.empty(); }
  double most() const { return most_; }
  double least() const { return least_; }

 private:
  const Grid& grid_;
  const JobPlace& place_;
  const BedDependence& placed_;
  int layer_;
  const DensityField* density_;
  int y_ = 0;
  double most_ = 1;
  double least_ = 1;
};

// Writes one row of the result while the dose is followed from left to right.
class DoseRowBuilder {
 public:
  DoseRowBuilder(RunLayer& out, const std::vector<Kernel>& kernels, std::int64_t least,
                 const RowGain& gain)
      : out_(out), kernels_(kernels), least_(least), gain_(gain) {
    for (const Kernel& kernel : kernels) {
      first_ = std::min(first_, kernel.first);
      last_ = std::max(last_, kernel.last());
    }
  }

  void build(std::span<const Ramp> ramps) {
    dose_ = 0;
    solid_ = false;
    done_ = 0;
    while (!ramps.empty()) {
      std::size_t near = 1;
      while (near < ramps.size() && ramps[near].at + first_ <= ramps[near - 1].at + last_ + 1) {
        ++near;
      }
      if (!gain_.none()) follow_gain(ramps.front().at + first_);
      walk(ramps.first(near));
      ramps = ramps.subspan(near);
    }
    if (!gain_.none()) follow_gain(out_.width());
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
      set(x, gain_.none() ? dose_ >= least_ : binds(x));
    }
    done_ = end;
  }

  // Where the dose is constant it may still pass the level with the gain.
  void follow_gain(int end) {
    const double dose = static_cast<double>(dose_);
    const auto least = static_cast<double>(least_);
    if (dose * gain_.most() < least) {
      if (end > done_) set(done_, false);
    } else if (dose * gain_.least() >= least) {
      if (end > done_) set(done_, true);
    } else {
      for (int x = std::max(0, done_); x < std::min(end, out_.width()); ++x) set(x, binds(x));
    }
    done_ = std::max(done_, end);
  }
  bool binds(int x) const {
    return static_cast<double>(dose_) * gain_(x) >= static_cast<double>(least_);
  }
  void set(int x, bool solid) {
    if (solid == solid_) return;
    solid_ = solid;
    out_.flip(std::clamp(x, 0, out_.width()));
  }

  RunLayer& out_;
  const std::vector<Kernel>& kernels_;
  std::int64_t least_;
  const RowGain& gain_;
  int done_ = 0;  // the row is followed up to here
  int first_ = 0;
  int last_ = 0;
  std::int64_t dose_ = 0;
  bool solid_ = false;
  std::vector<std::int64_t> steps_;
};

}  // namespace

DoseFilter::DoseFilter(std::span<const DoseTerm> terms, double level, const Grid& grid,
                       const BedDependence& placed, const JobPlace& place)
    : grid_(grid), placed_(placed), place_(place), repeat_{grid.detail_vx[0], grid.detail_vx[1]} {
  const auto total = [](const DoseTerm& term) {
    return static_cast<double>(term.x.total()) * static_cast<double>(term.y.total());
  };
  // One unit of dose is `unit`, a power of two of the first term's own: as fine as the sum of all
  // terms leaves room for.
  double most = 0;
  for (const DoseTerm& term : terms) most += std::abs(term.gain);
  double unit = total(terms.front());
  const double room = placed.shifts.empty() ? 4e18 : 4e18 / (kFine * kFine);
  for (int bit = 0; bit < 20 && unit * most * 2 < room; ++bit) unit *= 2;

  for (const DoseTerm& term : terms) {
    const auto known = std::find(x_.begin(), x_.end(), term.x);
    const auto kernel = static_cast<std::size_t>(known - x_.begin());
    if (known == x_.end()) x_.push_back(term.x);
    terms_.push_back({term.layer, kernel, term.y, std::llround(term.gain * unit / total(term))});
  }
  // A product that is whole but for rounding is that number: an exact tie counts as bound.
  constexpr double kRounding = 1e-12;
  if (!placed.shifts.empty()) level *= kFine * kFine;
  least_ = std::max<std::int64_t>(1, std::llround(std::ceil(level * unit * (1 - kRounding))));
}

RunLayer DoseFilter::operator()(const RunWindow& window, int layer) const {
  const RunLayer& mask = window.middle();
  const int height = mask.height() * repeat_[1];
  RunLayer out(mask.width() * repeat_[0]);
  out.reserve(height, mask.flip_count() * static_cast<std::size_t>(repeat_[1]));
  const std::optional<DensityField> density = density_of(window, grid_, placed_);
  RowGain gain(grid_, place_, placed_, layer, density ? &*density : nullptr);
  DoseRowBuilder builder(out, x_, least_, gain);
  const ShiftedRamps shifted(grid_, place_, placed_);
  std::vector<Ramp> ramps;
  for (int y = 0; y < height; ++y) {
    ramps.clear();
    for (const Term& term : terms_) {
      const RunLayer* from = window.at(term.layer);
      if (from == nullptr) continue;
      if (placed_.shifts.empty()) {
        add_ramps(*from, y, repeat_, placed_, term.y, term.scale, term.kernel, ramps);
      } else {
        shifted.add(*from, y, layer + term.layer, term.y, term.scale, term.kernel, ramps);
      }
    }
    sort_and_merge(ramps);
    gain.at_row(y);
    builder.build(ramps);
  }
  return out;
}

}  // namespace binderjet
