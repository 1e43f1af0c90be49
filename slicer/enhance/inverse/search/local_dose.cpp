// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/local_dose.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "slicer/base/vector_clones.h"

namespace binderjet {

// The rows of a stamp, of the dose and of the cost below them.
struct StampOverlay {
  const int* stamp;
  const int* dose;
  const int* cost;
  int width;
  int height;
  std::ptrdiff_t dose_stride;
  std::ptrdiff_t cost_stride;
  int held;  // all ones where the dose already holds the stamp
};

namespace {

constexpr int kWeighShift = 14;

int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

// The cost of the voxels that are bound with the stamp, less the cost of those bound without it.
BINDERJET_VECTOR_CLONES
int lifted_cost(StampOverlay o, int least) {
  int sum = 0;
  for (int y = 0; y < o.height; ++y) {
    for (int x = 0; x < o.width; ++x) {
      const int without = o.dose[x] - (o.stamp[x] & o.held);
      const int with = without + o.stamp[x];
      sum += (with >= least ? o.cost[x] : 0) - (without >= least ? o.cost[x] : 0);
    }
    o.stamp += o.width;
    o.dose += o.dose_stride;
    o.cost += o.cost_stride;
  }
  return sum;
}

BINDERJET_VECTOR_CLONES
void add_stamp(const Stamp& stamp, int* dose, std::ptrdiff_t stride, int sign) {
  const int* from = stamp.dose.data();
  for (int y = 0; y < stamp.height; ++y) {
    for (int x = 0; x < stamp.width; ++x) dose[x] += sign * from[x];
    from += stamp.width;
    dose += stride;
  }
}

// The stamps of an endless row of pixels, from the first one's corner on, `length` voxels beyond a
// stamp's own.
Plane<int> half_line(const Stamp& stamp, int length, int repeat) {
  Plane<int> line(Rect{0, 0, stamp.width + length, stamp.height});
  for (int y = 0; y < stamp.height; ++y) {
    const int* from = stamp.dose.data() + static_cast<std::ptrdiff_t>(y) * stamp.width;
    int* to = line.at(0, y);
    for (int x = 0; x < stamp.width + length; ++x) {
      to[x] = (x < stamp.width ? from[x] : 0) + (x < repeat ? 0 : to[x - repeat]);
    }
  }
  return line;
}

// Adds the stamps of a run of pixels that is `length` voxels long: the half-line at its first less
// that behind its last.
BINDERJET_VECTOR_CLONES
void add_run(const Plane<int>& line, int length, int width, int* dose, std::ptrdiff_t stride) {
  for (int y = 0; y < line.rect().height(); ++y) {
    const int* from = line.at(0, y);
    for (int x = 0; x < length + width; ++x) dose[x] += from[x];
    for (int x = 0; x < width; ++x) dose[length + x] -= from[x];
    dose += stride;
  }
}

// Calls act(y, begin, end) for each run of the mask's pixels within `rect`.
template <class Act>
void for_each_run(const Plane<std::uint8_t>& mask, const Rect& rect, Act act) {
  for (int y = rect.y0; y < rect.y1; ++y) {
    const std::uint8_t* row = mask.at(rect.x0, y) - rect.x0;
    for (int x = rect.x0; x < rect.x1; ++x) {
      if (row[x] == 0) continue;
      const int begin = x;
      while (x < rect.x1 && row[x] != 0) ++x;
      act(y, begin, x);
    }
  }
}

// Adds a row of a half-line, from voxel `first` on, up to `last`.
void add_half_line(const int* line, int width, int first, int last, int sign, int y,
                   Plane<int>& dose) {
  int* to = dose.at(first, y);
  const int count = last - first;
  const int rising = std::min(width, count);
  for (int x = 0; x < rising; ++x) to[x] += sign * line[x];
  const int whole = sign * line[width - 1];
  for (int x = rising; x < count; ++x) to[x] += whole;
}

// The credit of dose that stands for a voxel's gain (stamp.h). Alone a credit never reaches the
// level; a gain of 0 is a debt that no dose makes up for.
int credit(int least, float gain) {
  constexpr double kNever = 1 << 30;
  const double needed = gain > 0 ? static_cast<double>(least) / gain : kNever;
  return static_cast<int>(std::lround(least - std::min(needed, kNever)));
}

// The costs that a stamp has binder for, and its binder by cost.
BINDERJET_VECTOR_CLONES
void weigh(const Stamp& stamp, const int* cost, std::ptrdiff_t stride, int& least, int& most,
           double& weighted) {
  const int* from = stamp.dose.data();
  int low = least;
  int high = most;
  for (int y = 0; y < stamp.height; ++y) {
    int sum = 0;
    for (int x = 0; x < stamp.width; ++x) {
      low = std::min(low, from[x] != 0 ? cost[x] : low);
      high = std::max(high, from[x] != 0 ? cost[x] : high);
      // Whole rows of the largest stamp and cost stay within an int.
      sum += (from[x] >> kWeighShift) * cost[x];
    }
    from += stamp.width;
    cost += stride;
    weighted += static_cast<double>(sum) * (1 << kWeighShift);
  }
  least = low;
  most = high;
}

}  // namespace

LocalDose::LocalDose(std::span<const StampedModel> models, const Grid& grid, const Rect& tile,
                     const Surroundings& around)
    : grid_(grid), repeat_{grid.detail_vx[0], grid.detail_vx[1]}, around_(around) {
  for (const StampedModel& model : models) {
    for (const Stamp& stamp : model.stamps) {
      fields_.push_back({&model, &stamp, {}, {}, &model == &models.front()});
      first_ = {std::min(first_[0], stamp.first[0]), std::min(first_[1], stamp.first[1])};
      last_ = {std::max(last_[0], stamp.first[0] + stamp.width),
               std::max(last_[1], stamp.first[1] + stamp.height)};
    }
  }
  const bool shifts = around_.shifts(0) != nullptr;
  for (std::size_t axis = 0; axis < 2 && shifts; ++axis) {
    // A part of a voxel more on each side, and what makes stamps whole vectors.
    const int most = around_.max_shift_vx()[axis] + 2;
    first_[axis] -= most;
    last_[axis] += most + kStampVector;
  }
  voxels_ = {tile.x0 * repeat_[0] + first_[0], tile.y0 * repeat_[1] + first_[1],
             (tile.x1 - 1) * repeat_[0] + last_[0], (tile.y1 - 1) * repeat_[1] + last_[1]};
  masks_ = {floor_div(voxels_.x0 - last_[0], repeat_[0]),
            floor_div(voxels_.y0 - last_[1], repeat_[1]),
            floor_div(voxels_.x1 - first_[0], repeat_[0]) + 1,
            floor_div(voxels_.y1 - first_[1], repeat_[1]) + 1};
  land(tile);
}

ShiftedStamps& LocalDose::shifted(const StampedModel& model, int layer) {
  return shifted_stamps_.try_emplace({&model, layer}, model, layer, grid_).first->second;
}

// Finds where the tile's pixels land.
void LocalDose::land(const Rect& tile) {
  landings_.reset(tile, {});
  const ShiftedMask* shifts = around_.shifts(0);
  if (shifts == nullptr) {
    add_fit(nullptr);
  } else {
    std::map<PixelFit, std::size_t> fits;
    for (int y = tile.y0; y < tile.y1; ++y) {
      const ShiftedMask::Row row = shifts->row(y);
      const FineLength along_y = split_fine(within_most(row.shift, 1));
      for (int x = tile.x0; x < tile.x1; ++x) {
        const int start = x * repeat_[0] * kFine;
        const int end = start + repeat_[0] * kFine;
        const int by = within_most(shifts->edge(row, x) - start, 0);
        const FineLength along_x = split_fine(by);
        const int end_by = within_most(shifts->edge(row, x + 1) - end, 0);
        const PixelFit fit{along_x.part, repeat_[0] * kFine + end_by - by, along_y.part};
        const auto [known, is_new] = fits.emplace(fit, fits.size());
        if (is_new) add_fit(&fit);
        *landings_.at(x, y) = {{along_x.whole, along_y.whole}, known->second};
      }
    }
  }
  find_reach();
}

// The stamps of this fit, or of pixels that are not shifted.
void LocalDose::add_fit(const PixelFit* fit) {
  Rect all{};
  for (Field& field : fields_) {
    const Stamp& stamp =
        fit == nullptr ? *field.stamp : shifted(*field.model, field.stamp->layer).pixel(*fit);
    field.fitted.push_back(&stamp);
    all = all.joined({stamp.first[0], stamp.first[1], stamp.first[0] + stamp.width,
                      stamp.first[1] + stamp.height});
  }
  fit_rects_.push_back(all);
}

int LocalDose::within_most(int shift, std::size_t axis) const {
  const int most = around_.max_shift_vx()[axis] * kFine;
  return std::clamp(shift, -most, most);
}

void LocalDose::find_reach() {
  const Rect& tile = landings_.rect();
  fit_reach_ = landed(*landings_.at(tile.x0, tile.y0));
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      fit_reach_ = fit_reach_.joined(landed(*landings_.at(x, y)));
    }
  }
}

// What a pixel that lands there reaches, from its first voxel.
Rect LocalDose::landed(const Landing& landing) const {
  const Rect& of = fit_rects_[landing.fit];
  const auto [x, y] = landing.by;
  return {of.x0 + x, of.y0 + y, of.x1 + x, of.y1 + y};
}

Rect LocalDose::voxels_of(int x, int y) const {
  const Rect reach = landed(*landings_.at(x, y));
  const int x0 = x * repeat_[0];
  const int y0 = y * repeat_[1];
  return {x0 + reach.x0, y0 + reach.y0, x0 + reach.x1, y0 + reach.y1};
}

std::array<int, 2> LocalDose::pixel_reach() const {
  return {fit_reach_.width() / repeat_[0] + 1, fit_reach_.height() / repeat_[1] + 1};
}

PixelSight LocalDose::sight(int x, int y) const {
  PixelSight sight{std::numeric_limits<int>::max(), std::numeric_limits<int>::min(), 0};
  const Landing& landing = *landings_.at(x, y);
  double weighted = 0;
  double binder = 0;
  for (const Field& field : fields_) {
    const Plane<int>& costs = cost(field);
    const Stamp& stamp = *field.fitted[landing.fit];
    double by_cost = 0;
    weigh(stamp, under(costs, stamp, x, y, landing), costs.stride(), sight.min_cost, sight.max_cost,
          by_cost);
    if (!field.nominal) continue;
    weighted += by_cost;
    binder += stamp.total;
  }
  sight.wanted = 0.5 - 0.5 * weighted / (binder * grid_.detail_vx[2]);
  return sight;
}

void LocalDose::reset() {
  const Rect doses{masks_.x0 * repeat_[0] + first_[0], masks_.y0 * repeat_[1] + first_[1],
                   masks_.x1 * repeat_[0] + last_[0], masks_.y1 * repeat_[1] + last_[1]};
  for (Field& field : fields_) {
    field.dose.reset(doses, 0);
    for (const Stamp& stamp : field.model->stamps) {
      const int layer = stamp.layer - field.stamp->layer;
      const ShiftedMask* shifts = around_.shifts(layer);
      if (shifts == nullptr) {
        add_mask(stamp, around_.mask(layer), field);
      } else {
        add_shifted_mask(stamp, around_.mask(layer), *shifts, field);
      }
    }
    add_credit(field);
  }
}

void LocalDose::add_mask(const Stamp& stamp, const Plane<std::uint8_t>& mask, Field& field) const {
  const Plane<int> line = half_line(stamp, masks_.width() * repeat_[0], repeat_[0]);
  for_each_run(mask, masks_, [&](int y, int begin, int end) {
    add_run(line, (end - begin) * repeat_[0], stamp.width, under(field.dose, stamp, begin, y),
            field.dose.stride());
  });
}

void LocalDose::add_shifted_mask(const Stamp& stamp, const Plane<std::uint8_t>& mask,
                                 const ShiftedMask& shifts, Field& field) {
  ShiftedStamps& stamps = shifted(*field.model, stamp.layer);
  for_each_run(mask, masks_, [&](int y, int begin, int end) {
    const ShiftedMask::Row row = shifts.row(y);
    const FineLength along_y = split_fine(within_most(row.shift, 1));
    const auto side = [&](int x) {
      const int unshifted = x * repeat_[0] * kFine;
      return split_fine(unshifted + within_most(shifts.edge(row, x) - unshifted, 0));
    };
    const FineLength low = side(begin);
    const FineLength high = side(end);
    const Stamp& begins = stamps.half_line(low.part, along_y.part);
    const Stamp& ends = stamps.half_line(high.part, along_y.part);
    const int y_vx = y * repeat_[1] + along_y.whole + begins.first[1];
    // Both lines are constant there, and equal.
    const int last = std::max(low.whole, high.whole) + begins.first[0] + begins.width;
    for (int j = 0; j < begins.height; ++j) {
      const int* rise = begins.dose.data() + static_cast<std::ptrdiff_t>(j) * begins.width;
      const int* fall = ends.dose.data() + static_cast<std::ptrdiff_t>(j) * ends.width;
      add_half_line(rise, begins.width, low.whole + begins.first[0], last, 1, y_vx + j, field.dose);
      add_half_line(fall, ends.width, high.whole + ends.first[0], last, -1, y_vx + j, field.dose);
    }
  });
}

void LocalDose::add_credit(Field& field) const {
  const Plane<float>* gain = around_.gain(-field.stamp->layer);
  if (gain == nullptr) return;
  const int least = field.model->levels.front().least;
  for (int y = voxels_.y0; y < voxels_.y1; ++y) {
    const float* g = gain->at(voxels_.x0, y);
    int* dose = field.dose.at(voxels_.x0, y);
    for (int x = 0; x < voxels_.width(); ++x) dose[x] += credit(least, g[x]);
  }
}

StampOverlay LocalDose::overlay(const Field& field, int x, int y, int sign) const {
  const Plane<int>& costs = cost(field);
  const Landing& landing = *landings_.at(x, y);
  const Stamp& stamp = *field.fitted[landing.fit];
  return {stamp.dose.data(),
          under(field.dose, stamp, x, y, landing),
          under(costs, stamp, x, y, landing),
          stamp.width,
          stamp.height,
          field.dose.stride(),
          costs.stride(),
          sign < 0 ? -1 : 0};
}

int LocalDose::flip_cost(int x, int y, int sign) const {
  int sum = 0;
  for (const Field& field : fields_) {
    for (const DoseLevel& level : field.model->levels) {
      sum += level.weight * lifted_cost(overlay(field, x, y, sign), level.least);
    }
  }
  return sum * sign;
}

int LocalDose::nominal_cost(int x, int y, int sign) const {
  int sum = 0;
  for (const Field& field : fields_) {
    if (!field.nominal) continue;
    sum += lifted_cost(overlay(field, x, y, sign), field.model->levels.front().least);
  }
  return sum * sign;
}

void LocalDose::flip(int x, int y, int sign) {
  const Landing& landing = *landings_.at(x, y);
  for (Field& field : fields_) {
    const Stamp& stamp = *field.fitted[landing.fit];
    add_stamp(stamp, under(field.dose, stamp, x, y, landing), field.dose.stride(), sign);
  }
}

double LocalDose::dose(int x_vx, int y_vx) const {
  for (const Field& field : fields_) {
    if (field.stamp->layer != 0) continue;
    const double dose = *field.dose.at(x_vx, y_vx);
    const Plane<float>* gains = around_.gain(0);
    if (gains == nullptr) return dose / field.model->unit;
    const float gain = *gains->at(x_vx, y_vx);
    return (dose - credit(field.model->levels.front().least, gain)) * gain / field.model->unit;
  }
  return 0;
}

}  // namespace binderjet
