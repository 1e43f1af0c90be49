// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/local_dose.h"

#include <algorithm>
#include <limits>

#include "slicer/vector_clones.h"

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

// The cost of the voxels that reach `least` with the stamp, less that of those that do without.
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
    : repeat_{grid.detail_vx[0], grid.detail_vx[1]}, slices_(grid.detail_vx[2]), around_(around) {
  for (const StampedModel& model : models) {
    for (const Stamp& stamp : model.stamps) {
      fields_.push_back({&model, &stamp, {}, &model == &models.front()});
      first_ = {std::min(first_[0], stamp.first[0]), std::min(first_[1], stamp.first[1])};
      last_ = {std::max(last_[0], stamp.first[0] + stamp.width),
               std::max(last_[1], stamp.first[1] + stamp.height)};
    }
  }
  voxels_ = {tile.x0 * repeat_[0] + first_[0], tile.y0 * repeat_[1] + first_[1],
             (tile.x1 - 1) * repeat_[0] + last_[0], (tile.y1 - 1) * repeat_[1] + last_[1]};
  masks_ = {floor_div(voxels_.x0 - last_[0], repeat_[0]),
            floor_div(voxels_.y0 - last_[1], repeat_[1]),
            floor_div(voxels_.x1 - first_[0], repeat_[0]) + 1,
            floor_div(voxels_.y1 - first_[1], repeat_[1]) + 1};
}

std::array<int, 2> LocalDose::pixel_reach() const {
  return {(last_[0] - first_[0]) / repeat_[0] + 1, (last_[1] - first_[1]) / repeat_[1] + 1};
}

PixelSight LocalDose::sight(int x, int y) const {
  PixelSight sight{std::numeric_limits<int>::max(), std::numeric_limits<int>::min(), 0};
  double weighted = 0;
  double binder = 0;
  for (const Field& field : fields_) {
    const Plane<int>& costs = cost(field);
    double by_cost = 0;
    weigh(*field.stamp, under(costs, *field.stamp, x, y), costs.stride(), sight.least_cost,
          sight.most_cost, by_cost);
    if (!field.nominal) continue;
    weighted += by_cost;
    binder += field.stamp->total;
  }
  sight.wanted = 0.5 - 0.5 * weighted / (binder * slices_);
  return sight;
}

void LocalDose::reset() {
  const Rect doses{masks_.x0 * repeat_[0] + first_[0], masks_.y0 * repeat_[1] + first_[1],
                   masks_.x1 * repeat_[0] + last_[0], masks_.y1 * repeat_[1] + last_[1]};
  for (Field& field : fields_) {
    field.dose.reset(doses, 0);
    for (const Stamp& stamp : field.model->stamps) {
      const Plane<int> line = half_line(stamp, masks_.width() * repeat_[0], repeat_[0]);
      const Plane<std::uint8_t>& mask = around_.mask(stamp.layer - field.stamp->layer);
      for (int y = masks_.y0; y < masks_.y1; ++y) {
        const std::uint8_t* row = mask.at(masks_.x0, y) - masks_.x0;
        for (int x = masks_.x0; x < masks_.x1; ++x) {
          if (row[x] == 0) continue;
          const int begin = x;
          while (x < masks_.x1 && row[x] != 0) ++x;
          add_run(line, (x - begin) * repeat_[0], stamp.width, under(field.dose, stamp, begin, y),
                  field.dose.stride());
        }
      }
    }
  }
}

StampOverlay LocalDose::overlay(const Field& field, int x, int y, int sign) const {
  const Plane<int>& costs = cost(field);
  return {field.stamp->dose.data(),
          under(field.dose, *field.stamp, x, y),
          under(costs, *field.stamp, x, y),
          field.stamp->width,
          field.stamp->height,
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
  for (Field& field : fields_) {
    add_stamp(*field.stamp, under(field.dose, *field.stamp, x, y), field.dose.stride(), sign);
  }
}

double LocalDose::dose(int x_vx, int y_vx) const {
  for (const Field& field : fields_) {
    if (field.stamp->layer != 0) continue;
    return static_cast<double>(*field.dose.at(x_vx, y_vx)) / field.model->unit;
  }
  return 0;
}

}  // namespace binderjet
