// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/doses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "slicer/base/vector_clones.h"
#include "slicer/enhance/inverse/search/prices.h"

namespace binderjet {
namespace {

constexpr int kFarOff = 12000;  // a hinge rises no further, and no credit is larger

// The rows of a stamp and of the cells below them.
struct Overlay {
  const std::int16_t* stamp;
  const std::int16_t* dose;
  const std::int16_t* price;
  const std::size_t* rows;  // where they begin
  std::ptrdiff_t column;
  int width;
  int height;
  std::int16_t less;  // all ones where the stamp is taken off
};

// The sum of price(voxel) * act(dose, by), where `by` is what the stamp adds. Stamps of up to four
// vectors have a loop of their own, for a known width is worked on without any.
template <int kWidth, class Act>
[[gnu::always_inline]] inline int sum_over(Overlay o, Act act) {
  const int width = kWidth > 0 ? kWidth : o.width;
  int sum = 0;
  for (int j = 0; j < o.height; ++j) {
    const std::int16_t* dose = o.dose + o.rows[j] + o.column;
    const std::int16_t* price = o.price + o.rows[j] + o.column;
    for (int i = 0; i < width; ++i) {
      const auto by = static_cast<std::int16_t>((o.stamp[i] ^ o.less) - o.less);
      sum += act(dose[i], static_cast<std::int16_t>(dose[i] + by)) * price[i];
    }
    o.stamp += width;
  }
  return sum;
}
template <class Act>
[[gnu::always_inline]] inline int sum_over(const Overlay& o, Act act) {
  switch (o.width / kStampVector) {
    case 1:
      return sum_over<kStampVector>(o, act);
    case 2:
      return sum_over<2 * kStampVector>(o, act);
    case 3:
      return sum_over<3 * kStampVector>(o, act);
    case 4:
      return sum_over<4 * kStampVector>(o, act);
    default:
      return sum_over<0>(o, act);
  }
}

BINDERJET_VECTOR_CLONES
int change_on_ramp(const Overlay& o, std::int16_t span) {
  return sum_over(o, [span](std::int16_t now, std::int16_t then) {
    const std::int16_t before = std::min(std::max<std::int16_t>(now, 0), span);
    const std::int16_t after = std::min(std::max<std::int16_t>(then, 0), span);
    return static_cast<std::int16_t>(after - before);
  });
}

// Of one level, or of two by their weights.
BINDERJET_VECTOR_CLONES
int change_of_count(const Overlay& o, std::int16_t least) {
  return sum_over(o, [least](std::int16_t now, std::int16_t then) {
    return static_cast<std::int16_t>((then >= least ? 1 : 0) - (now >= least ? 1 : 0));
  });
}
BINDERJET_VECTOR_CLONES
int change_of_counts(const Overlay& o, std::array<std::int16_t, 2> least,
                     std::array<std::int16_t, 2> weight) {
  return sum_over(o, [=](std::int16_t now, std::int16_t then) {
    const int one = (then >= least[0] ? 1 : 0) - (now >= least[0] ? 1 : 0);
    const int other = (then >= least[1] ? 1 : 0) - (now >= least[1] ? 1 : 0);
    return static_cast<std::int16_t>(one * weight[0] + other * weight[1]);
  });
}

// Adds a row of a half-line that begins at voxel `begin`, as often as `sign` says, to the voxels
// [x0, x1) of `to`.
void add_half_line(const std::int16_t* line, int width, int begin, int x1, int sign, int x0,
                   std::int16_t* to) {
  const int constant = std::min(x1, begin + width);
  int x = std::max(x0, begin);
  for (; x < constant; ++x) to[x] = static_cast<std::int16_t>(to[x] + sign * line[x - begin]);
  const int add = sign * line[width - 1];
  for (; x < x1; ++x) to[x] = static_cast<std::int16_t>(to[x] + add);
}

// The credit of dose that stands for a voxel's gain; where the gain is 0 a debt that no dose makes
// up for.
int credit(int least, double gain) {
  const double needed = gain > 0 ? least / gain : std::numeric_limits<double>::max();
  return static_cast<int>(std::lround(std::max<double>(-kFarOff, least - needed)));
}

}  // namespace

Doses::Doses(const SearchModel& by, const LayerWindow& layers, const RunLayer& open)
    : by_(by), layers_(layers), places_(by.printer, by.grid, layers, by.offsets) {
  number_pixels(open);
  land();
  make_planes();
}

void Doses::number_pixels(const RunLayer& open) {
  std::size_t count = 0;
  for (int y = 0; y < open.height(); ++y) {
    const std::span<const int> row = open.row(y);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      runs_.push_back({y, row[i], row[i + 1], count});
      count += static_cast<std::size_t>(row[i + 1] - row[i]);
    }
    row_ends_.push_back(runs_.size());
  }
}

std::array<std::size_t, 2> Doses::runs_of(int y) const {
  const auto at = static_cast<std::size_t>(y);
  return {at == 0 ? 0 : row_ends_[at - 1], row_ends_[at]};
}

int Doses::within_most(int shift, std::size_t axis) const {
  const int most = places_.max_shift_vx()[axis] * kFine;
  return std::clamp(shift, -most, most);
}

// Finds where the pixels land.
void Doses::land() {
  const int rx = by_.grid.detail_vx[0];
  const ShiftedMask* shifts = places_.shifts(0);
  if (shifts == nullptr) {
    fits_.push_back({0, rx * kFine, 0});
    return;
  }
  std::map<PixelFit, std::size_t> known;
  for (const PixelRun& run : runs_) {
    const ShiftedMask::Row row = shifts->row(run.y);
    const FineLength along_y = split_fine(within_most(row.shift, 1));
    for (int x = run.x0; x < run.x1; ++x) {
      const int start = x * rx * kFine;
      const int by = within_most(shifts->edge(row, x) - start, 0);
      const int end_by = within_most(shifts->edge(row, x + 1) - start - rx * kFine, 0);
      const FineLength along_x = split_fine(by);
      const PixelFit fit{along_x.part, rx * kFine + end_by - by, along_y.part};
      const auto [at, is_new] = known.emplace(fit, fits_.size());
      if (is_new) fits_.push_back(fit);
      landings_.push_back({{along_x.whole, along_y.whole}, at->second});
    }
  }
}

Stamps& Doses::stamps(std::size_t model, int layer) {
  return stamps_
      .try_emplace({static_cast<int>(model), layer}, by_.models[model].terms, layer, by_.grid,
                   by_.unit)
      .first->second;
}

void Doses::make_planes() {
  if (runs_.empty()) return;
  for (const int printed : by_.offsets.printed) {
    if (layers_.at(printed) == nullptr) continue;  // nobody asks what is printed there
    for (std::size_t m = 0; m < by_.models.size(); ++m) {
      planes_.push_back({m, printed, 0, 0, {}});
      for (const PixelFit& fit : fits_) {
        planes_.back().stamps.push_back(&stamps(m, -printed).pixel(fit));
      }
    }
  }
  bool any = false;
  const auto join = [&](const Landing& landing) {
    for (const Plane& plane : planes_) {
      const Stamp& stamp = *plane.stamps[landing.fit];
      const int x0 = landing.by[0] + stamp.first[0];
      const int y0 = landing.by[1] + stamp.first[1];
      const Rect lands{x0, y0, x0 + stamp.width, y0 + stamp.height};
      reach_ = any ? reach_.joined(lands) : lands;
      any = true;
    }
  };
  if (landings_.empty()) join({});
  for (const Landing& landing : landings_) join(landing);

  const auto [rx, ry, rz] = by_.grid.detail_vx;
  RunLayer open(layers_.middle().mask->width());
  for (int y = 0; y < static_cast<int>(row_ends_.size()); ++y) {
    const auto [begin, end] = runs_of(y);
    std::vector<int> row;
    for (std::size_t r = begin; r < end; ++r) row.insert(row.end(), {runs_[r].x0, runs_[r].x1});
    open.append_row(row);
  }
  band_.emplace(open, reach_, std::array<int, 2>{rx, ry});
  for (const PixelRun& run : runs_) {
    for (int y = reach_.y0; y < reach_.y1; ++y) {
      rows_.push_back(band_->number(run.x0 * rx + reach_.x0, run.y * ry + y));
    }
  }
  std::size_t next = 0;
  std::size_t price = 0;
  cells_.resize((planes_.size() + planes_.size() / by_.models.size()) * band_->size());
  for (Plane& plane : planes_) {
    if (plane.model == 0) {
      price = next;
      next += band_->size();
      const std::vector<std::int16_t> prices =
          voxel_prices(*layers_.at(plane.printed)->target, *band_);
      std::copy(prices.begin(), prices.end(), cells_.begin() + static_cast<std::ptrdiff_t>(price));
    }
    plane.price = price;
    plane.dose = next;
    next += band_->size();
  }
}

std::array<int, 2> Doses::pixel_reach() const {
  return {reach_.width() / by_.grid.detail_vx[0] + 1, reach_.height() / by_.grid.detail_vx[1] + 1};
}

void Doses::fill_nominal(const RunLayer& own) {
  for (const Plane& plane : planes_) {
    if (plane.model == 0) fill(plane, own);
  }
  filled_ = 1;
}

void Doses::fill_drifted(const RunLayer& own) {
  for (const Plane& plane : planes_) {
    if (plane.model > 0) fill(plane, own);
  }
  filled_ = by_.models.size();
}

void Doses::fill(const Plane& plane, const RunLayer& own) {
  std::int16_t* dose = cells_.data() + plane.dose;
  std::fill_n(dose, band_->size(), std::int16_t{0});
  const std::vector<DoseTerm>& terms = by_.models[plane.model].terms;
  std::set<int> layers;
  for (const DoseTerm& term : terms) layers.insert(term.layer);
  for (const int layer : layers) {
    const int offset = plane.printed + layer;
    const RunLayer* mask = &own;
    if (offset != 0) {
      mask = layers_.at(offset) == nullptr ? nullptr : layers_.at(offset)->mask.get();
    }
    if (mask != nullptr) add_mask(*mask, stamps(plane.model, layer), places_.shifts(offset), dose);
  }
  if (places_.has_gains()) {
    add_credit(plane.printed, by_.models[plane.model].levels.front().least, dose);
  }
}

void Doses::add_mask(const RunLayer& mask, Stamps& stamps, const ShiftedMask* shifts,
                     std::int16_t* dose) const {
  const auto [rx, ry, rz] = by_.grid.detail_vx;
  for (int y = 0; y < mask.height(); ++y) {
    const std::span<const int> row = mask.row(y);
    if (row.empty()) continue;
    std::optional<ShiftedMask::Row> shifted;
    FineLength along_y{0, 0};
    if (shifts != nullptr) {
      shifted = shifts->row(y);
      along_y = split_fine(within_most(shifted->shift, 1));
    }
    const auto side = [&, rx = rx](int x) {
      const int fine = x * rx * kFine;
      return split_fine(shifted ? fine + within_most(shifts->edge(*shifted, x) - fine, 0) : fine);
    };
    for (std::size_t i = 0; i < row.size(); i += 2) {
      const FineLength low = side(row[i]);
      const FineLength high = side(row[i + 1]);
      const Stamp& begins = stamps.half_line(low.part, along_y.part);
      const Stamp& ends = stamps.half_line(high.part, along_y.part);
      const int begin = low.whole + begins.first[0];
      const int fall = high.whole + ends.first[0];
      const int end = std::max(begin, fall) + begins.width;  // both are constant there, and equal
      for (int j = 0; j < begins.height; ++j) {
        const std::int16_t* up = begins.dose.data() + static_cast<std::ptrdiff_t>(j) * begins.width;
        const std::int16_t* down = ends.dose.data() + static_cast<std::ptrdiff_t>(j) * ends.width;
        const std::span<const BandRun> runs =
            band_->row(y * ry + along_y.whole + begins.first[1] + j);
        auto run = std::partition_point(runs.begin(), runs.end(),
                                        [&](const BandRun& r) { return r.x1 <= begin; });
        for (; run != runs.end() && run->x0 < end; ++run) {
          std::int16_t* to = dose + run->first - run->x0;
          add_half_line(up, begins.width, begin, std::min(end, run->x1), 1, run->x0, to);
          add_half_line(down, ends.width, fall, std::min(end, run->x1), -1, run->x0, to);
        }
      }
    }
  }
}

void Doses::add_credit(int printed, int least, std::int16_t* dose) const {
  for (int y = band_->first_row(); y < band_->last_row(); ++y) {
    for (const BandRun& run : band_->row(y)) {
      std::int16_t* to = dose + run.first;
      for (int x = run.x0; x < run.x1; ++x, ++to) {
        *to = static_cast<std::int16_t>(*to + credit(least, places_.gain(printed, x, y)));
      }
    }
  }
}

void Doses::raise_prices(int offset, const RunLayer& voxels, bool missing, int times) {
  const auto plane = std::find_if(planes_.begin(), planes_.end(),
                                  [&](const Plane& p) { return p.printed == offset; });
  if (plane == planes_.end()) return;
  // Such that what a flip changes on a ramp stays within 32 bits.
  const int flipped = by_.unit * by_.grid.detail_vx[0] * by_.grid.detail_vx[1];
  const int most = std::min<int>(std::numeric_limits<std::int16_t>::max(), (1 << 30) / flipped);
  for (int y = band_->first_row(); y < band_->last_row(); ++y) {
    const std::span<const int> row = voxels.row(y);
    for (const BandRun& run : band_->row(y)) {
      std::int16_t* price = cells_.data() + plane->price + run.first;
      for (std::size_t i = 0; i < row.size(); i += 2) {
        for (int x = std::max(run.x0, row[i]); x < std::min(run.x1, row[i + 1]); ++x) {
          std::int16_t& of = price[x - run.x0];
          const int raised = std::max(kPriceUnit, missing ? -of : +of) * times;
          of = static_cast<std::int16_t>(std::clamp(missing ? -raised : raised, -most, most));
        }
      }
    }
  }
}

void Doses::shift(const Ramp& ramp, int sign) {
  const auto powder = static_cast<std::int16_t>(sign * ramp.powder_from);
  const auto solid = static_cast<std::int16_t>(sign * ramp.solid_from);
  for (const Plane& plane : planes_) {
    if (plane.model > 0) continue;
    std::int16_t* dose = cells_.data() + plane.dose;
    const std::int16_t* price = cells_.data() + plane.price;
    for (std::size_t i = 0; i < band_->size(); ++i) {
      dose[i] = static_cast<std::int16_t>(dose[i] + (price[i] > 0 ? powder : solid));
    }
  }
}

template <class Act>
void Doses::on_stamp(const OpenPixel& pixel, const Plane& plane, Act act) const {
  const PixelRun& run = runs_[pixel.run];
  const auto along = static_cast<std::size_t>(pixel.x - run.x0);
  const Landing landing = landings_.empty() ? Landing() : landings_[run.first + along];
  const Stamp& stamp = *plane.stamps[landing.fit];
  const std::size_t row = pixel.run * static_cast<std::size_t>(reach_.height()) +
                          static_cast<std::size_t>(landing.by[1] + stamp.first[1] - reach_.y0);
  act(stamp, rows_.data() + row,
      static_cast<std::ptrdiff_t>(along) * by_.grid.detail_vx[0] + landing.by[0] + stamp.first[0] -
          reach_.x0);
}

int Doses::ramp_change(const OpenPixel& pixel, int sign, const Ramp& ramp) const {
  int sum = 0;
  for (const Plane& plane : planes_) {
    if (plane.model > 0) continue;
    on_stamp(pixel, plane, [&](const Stamp& s, const std::size_t* rows, std::ptrdiff_t column) {
      sum += change_on_ramp(
          {s.dose.data(), cells_.data() + plane.dose, cells_.data() + plane.price, rows, column,
           s.width, s.height, static_cast<std::int16_t>(sign < 0 ? -1 : 0)},
          static_cast<std::int16_t>(ramp.span));
    });
  }
  return sum;
}

int Doses::nominal_change(const OpenPixel& pixel, int sign) const {
  int sum = 0;
  for (const Plane& plane : planes_) {
    if (plane.model == 0) sum += count_change(pixel, sign, plane);
  }
  return sum;
}

int Doses::drifted_change(const OpenPixel& pixel, int sign) const {
  int sum = 0;
  for (const Plane& plane : planes_) {
    if (plane.model > 0 && plane.model < filled_) sum += count_change(pixel, sign, plane);
  }
  return sum;
}

int Doses::count_change(const OpenPixel& pixel, int sign, const Plane& plane) const {
  int sum = 0;
  on_stamp(pixel, plane, [&](const Stamp& s, const std::size_t* rows, std::ptrdiff_t column) {
    const Overlay o{s.dose.data(),
                    cells_.data() + plane.dose,
                    cells_.data() + plane.price,
                    rows,
                    column,
                    s.width,
                    s.height,
                    static_cast<std::int16_t>(sign < 0 ? -1 : 0)};
    const std::vector<DoseLevel>& levels = by_.models[plane.model].levels;
    const auto least = [&](std::size_t at) { return static_cast<std::int16_t>(levels[at].least); };
    const auto weight = [&](std::size_t at) {
      return static_cast<std::int16_t>(levels[at].weight);
    };
    if (levels.size() == 2) {
      sum = change_of_counts(o, {least(0), least(1)}, {weight(0), weight(1)});
      return;
    }
    for (std::size_t at = 0; at < levels.size(); ++at) {
      sum += weight(at) * change_of_count(o, least(at));
    }
  });
  return sum;
}

void Doses::flip(const OpenPixel& pixel, int sign) {
  for (const Plane& plane : planes_) {
    if (plane.model >= filled_) continue;
    std::int16_t* cells = cells_.data() + plane.dose;
    on_stamp(pixel, plane, [&](const Stamp& s, const std::size_t* rows, std::ptrdiff_t column) {
      const std::int16_t* from = s.dose.data();
      for (int j = 0; j < s.height; ++j, from += s.width) {
        std::int16_t* dose = cells + rows[j] + column;
        for (int i = 0; i < s.width; ++i) {
          dose[i] = static_cast<std::int16_t>(dose[i] + sign * from[i]);
        }
      }
    });
  }
}

int Doses::weights() const {
  int sum = 0;
  for (std::size_t m = 0; m < filled_; ++m) {
    for (const DoseLevel& level : by_.models[m].levels) sum += level.weight;
  }
  return sum;
}

double Doses::dose(int x_vx, int y_vx) const {
  for (const Plane& plane : planes_) {
    if (plane.model > 0 || plane.printed != 0) continue;
    const double dose = cells_[plane.dose + band_->number(x_vx, y_vx)];
    if (!places_.has_gains()) return dose / by_.unit;
    const double gain = places_.gain(0, x_vx, y_vx);
    return (dose - credit(by_.models.front().levels.front().least, gain)) * gain / by_.unit;
  }
  return 0;
}

}  // namespace binderjet
