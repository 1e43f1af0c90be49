// SPDX-License-Identifier: GPL-3.0-or-later
// Nearest skin by a distance transform, one axis after the other, each over no more than the depth:
//
//   cost(x, y, z) = min over dy of (dy py)^2 + min over dx of (dx px)^2 + min over dz of (dz L)^2
//                   where (x + dx, y + dy, z + dz) is skin
//
// Squared distances add up over axes, so three short minima give the nearest pixel of all. Rows are
// done in bands, so that only the bitmap itself is as large as the layer.
#include "slicer/color/shell.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "slicer/color/row_bits.h"

namespace binderjet {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr int kBandRows = 64;

struct Stretch {
  int first;
  int last;
};

// Joins stretches that touch or overlap.
void join(std::vector<Stretch>& stretches) {
  std::sort(stretches.begin(), stretches.end(),
            [](const Stretch& a, const Stretch& b) { return a.first < b.first; });
  std::size_t kept = 0;
  for (const Stretch& s : stretches) {
    if (kept > 0 && s.first <= stretches[kept - 1].last) {
      stretches[kept - 1].last = std::max(stretches[kept - 1].last, s.last);
    } else {
      stretches[kept++] = s;
    }
  }
  stretches.resize(kept);
}

// Takes what lies at `from` where that is nearer; the first to come keeps a tie.
void take_nearer(const float* from_cost, const std::uint32_t* from_color, float step, float* cost,
                 std::uint32_t* color, int count) {
  for (int i = 0; i < count; ++i) {
    const float candidate = from_cost[i] + step;
    const bool nearer = candidate < cost[i];
    cost[i] = nearer ? candidate : cost[i];
    color[i] = nearer ? from_color[i] : color[i];
  }
}

std::uint32_t packed(const Rgb& c) {
  return std::uint32_t{c[0]} | std::uint32_t{c[1]} << 8 | std::uint32_t{c[2]} << 16;
}

void put(std::byte* out, std::uint32_t color) {
  for (int c = 0; c < 3; ++c) out[c] = static_cast<std::byte>(color >> (8 * c));
}

}  // namespace

// Rows of one layer, with what the skins within reach say about them.
class Shell::Band {
 public:
  Band(const Shell& shell, int layer, const Window<SkinLayer>& window)
      : shell_(shell),
        layer_(layer),
        window_(window),
        width_(shell.box_.size_px[0]),
        reach_y_(shell.reach_[1]),
        along_z_(kBandRows + 2 * reach_y_, width_),
        along_x_(kBandRows + 2 * reach_y_, width_),
        best_cost_(static_cast<std::size_t>(width_)),
        best_color_(static_cast<std::size_t>(width_)),
        boundary_(width_) {}

  // Paints rows first <= y < last of the mask into `bitmap`.
  void paint(int first, int last, std::byte* bitmap) {
    const int low = std::max(0, first - reach_y_);
    const int high = std::min(shell_.box_.size_px[1], last + reach_y_);
    for (int y = low; y < high; ++y) {
      gather_z(y, y - low);
      gather_x(y - low);
    }
    for (int y = first; y < last; ++y) paint_row(y, low, high, bitmap);
    for (int row = 0; row < high - low; ++row) {
      along_z_.forget(row);
      along_x_.forget(row);
    }
  }

 private:
  // Costs and colors of some rows; everything is far outside a row's stretches.
  struct Rows {
    Rows(int rows, int width)
        : stride(static_cast<std::size_t>(width)),
          costs(static_cast<std::size_t>(rows) * stride, kFar),
          colors(costs.size(), 0),
          stretches(static_cast<std::size_t>(rows)) {}
    float* cost(int row) { return costs.data() + static_cast<std::size_t>(row) * stride; }
    std::uint32_t* color(int row) { return colors.data() + static_cast<std::size_t>(row) * stride; }
    std::vector<Stretch>& used(int row) { return stretches[static_cast<std::size_t>(row)]; }
    void forget(int row) {
      for (const Stretch& s : used(row)) std::fill(cost(row) + s.first, cost(row) + s.last, kFar);
      used(row).clear();
    }
    std::size_t stride;
    std::vector<float> costs;
    std::vector<std::uint32_t> colors;
    std::vector<std::vector<Stretch>> stretches;
  };

  const SkinLayer* skin(int offset) const { return window_.at(offset); }

  // Nearest layers first, so the first skin in a column is the nearest.
  void gather_z(int y, int row) {
    float* cost = along_z_.cost(row);
    std::uint32_t* color = along_z_.color(row);
    std::vector<Stretch>& used = along_z_.used(row);
    for (int step = 0; step <= shell_.reach_[2]; ++step) {
      for (const int offset : {-step, step}) {
        const SkinLayer* layer = skin(offset);
        if (layer != nullptr) {
          const float z = shell_.cost_[2][static_cast<std::size_t>(step)];
          const std::span<const int> runs = layer->pixels.row(y);
          std::size_t next = layer->rows[static_cast<std::size_t>(y)];
          for (std::size_t i = 0; i + 1 < runs.size(); i += 2) {
            used.push_back({runs[i], runs[i + 1]});
            for (int x = runs[i]; x < runs[i + 1]; ++x, ++next) {
              if (cost[x] != kFar) continue;
              cost[x] = z;
              color[x] = packed(layer->colors[next]);
            }
          }
        }
        if (step == 0) break;
      }
    }
    join(used);
  }

  void gather_x(int row) {
    const int reach = shell_.reach_[0];
    std::vector<Stretch>& used = along_x_.used(row);
    for (const Stretch& s : along_z_.used(row)) {
      used.push_back({std::max(0, s.first - reach), std::min(width_, s.last + reach)});
    }
    join(used);
    for (const Stretch& s : used) {
      gather(along_z_.cost(row), along_z_.color(row), s, along_x_.cost(row), along_x_.color(row));
    }
  }

  // Along one row: from every offset within reach, nearest first.
  void gather(const float* from_cost, const std::uint32_t* from_color, const Stretch& s,
              float* cost, std::uint32_t* color) const {
    for (int step = 0; step <= shell_.reach_[0]; ++step) {
      for (const int offset : {-step, step}) {
        const int first = std::max(s.first, -offset);
        const int last = std::min(s.last, width_ - offset);
        if (first < last) {
          take_nearer(from_cost + first + offset, from_color + first + offset,
                      shell_.cost_[0][static_cast<std::size_t>(step)], cost + first, color + first,
                      last - first);
        }
        if (step == 0) break;
      }
    }
  }

  void paint_row(int y, int low, int high, std::byte* bitmap) {
    std::byte* row = bitmap + static_cast<std::size_t>(y) * 3 * static_cast<std::size_t>(width_);
    paint_skin(y, row);
    const RunLayer& mask = skin(0)->masks->mask;
    const std::span<const int> runs = mask.row(y);
    if (runs.empty()) return;
    std::vector<Stretch> near;
    for (int from = std::max(low, y - reach_y_); from < std::min(high, y + reach_y_ + 1); ++from) {
      const std::vector<Stretch>& used = along_x_.used(from - low);
      near.insert(near.end(), used.begin(), used.end());
    }
    join(near);
    for (const Stretch& s : near) {
      const int first = std::max(s.first, runs.front());
      const int last = std::min(s.last, runs.back());
      if (first < last) gather_y(y, low, high, first, last);
    }
    mark_boundary(y);
    auto begin = near.begin();
    for (std::size_t i = 0; i + 1 < runs.size(); i += 2) {
      while (begin != near.end() && begin->last <= runs[i]) ++begin;
      for (auto s = begin; s != near.end() && s->first < runs[i + 1]; ++s) {
        const int last = std::min(s->last, runs[i + 1]);
        for (int x = std::max(s->first, runs[i]); x < last; ++x) {
          if (best_cost_[static_cast<std::size_t>(x)] <= shell_.paint_within_) {
            put(row + 3 * static_cast<std::size_t>(x), best_color_[static_cast<std::size_t>(x)]);
          }
        }
      }
    }
    paint_boundary(y, near, row);
  }

  // The skin itself, also where the mask leaves its pixel out: less than half of it is part.
  void paint_skin(int y, std::byte* row) const {
    const std::span<const int> runs = skin(0)->pixels.row(y);
    std::size_t next = skin(0)->rows[static_cast<std::size_t>(y)];
    for (std::size_t i = 0; i + 1 < runs.size(); i += 2) {
      for (int x = runs[i]; x < runs[i + 1]; ++x, ++next) {
        put(row + 3 * static_cast<std::size_t>(x), packed(skin(0)->colors[next]));
      }
    }
  }

  void gather_y(int y, int low, int high, int first, int last) {
    float* cost = best_cost_.data() + first;
    std::uint32_t* color = best_color_.data() + first;
    std::fill(cost, cost + (last - first), kFar);
    for (int step = 0; step <= reach_y_; ++step) {
      for (const int from : {y - step, y + step}) {
        if (from >= low && from < high && !along_x_.used(from - low).empty()) {
          take_nearer(along_x_.cost(from - low) + first, along_x_.color(from - low) + first,
                      shell_.cost_[1][static_cast<std::size_t>(step)], cost, color, last - first);
        }
        if (step == 0) break;
      }
    }
  }

  void mark_boundary(int y) {
    const auto mask_of = [&](int offset) -> const RunLayer* {
      const SkinLayer* layer = skin(offset);
      return layer == nullptr ? nullptr : &layer->masks->mask;
    };
    boundary_.fill(mask_of(-1), *mask_of(0), mask_of(1), y);
  }

  // Boundary that is deeper than the shell, or has no skin near.
  void paint_boundary(int y, const std::vector<Stretch>& near, std::byte* row) {
    auto stretch = near.begin();
    for (std::size_t w = 0; w < boundary_.here.size(); ++w) {
      for_each_bit(boundary_.boundary(w), w, [&](int x) {
        while (stretch != near.end() && stretch->last <= x) ++stretch;
        const bool known = stretch != near.end() && stretch->first <= x;
        const float cost = known ? best_cost_[static_cast<std::size_t>(x)] : kFar;
        if (cost <= shell_.paint_within_) return;
        const std::uint32_t color = cost <= shell_.search_within_
                                        ? best_color_[static_cast<std::size_t>(x)]
                                        : packed(surface_color(x, y));
        put(row + 3 * static_cast<std::size_t>(x), color);
      });
    }
  }

  Rgb surface_color(int x, int y) {
    const Grid& grid = shell_.grid_;
    const auto center = [&](int axis, int pixel) {
      return (pixel - shell_.box_.margin_px[static_cast<std::size_t>(axis)] + 0.5) *
             grid.pitch_mm[static_cast<std::size_t>(axis)];
    };
    if (!slab_) {
      slab_ = shell_.field_->slab(layer_ * grid.pitch_mm[2], (layer_ + 1) * grid.pitch_mm[2]);
    }
    const FloatRgb color = slab_->at({center(0, x), center(1, y), center(2, layer_)});
    Rgb out{};
    for (std::size_t c = 0; c < 3; ++c) {
      out[c] = static_cast<std::uint8_t>(std::clamp(color[c] + 0.5F, 0.0F, 255.0F));
    }
    return out;
  }

  const Shell& shell_;
  int layer_;
  Window<SkinLayer> window_;
  int width_;
  int reach_y_;
  Rows along_z_;
  Rows along_x_;
  std::vector<float> best_cost_;
  std::vector<std::uint32_t> best_color_;
  RowNeighborhood boundary_;
  std::unique_ptr<ColorSlab> slab_;
};

Shell::Shell(const Grid& grid, const JobBox& box, double depth_mm,
             std::shared_ptr<const ColorField> field)
    : grid_(grid), box_(box), field_(std::move(field)) {
  // From the skin's pixel outward the surface is half a pixel away; the pixel itself is skin.
  const auto cost = [&](std::size_t axis, int offset) {
    const double mm = offset == 0 ? 0 : (offset + 0.5) * grid.pitch_mm[axis];
    return static_cast<float>(mm * mm);
  };
  constexpr std::array<int, 3> kLeast = {2, 2, 1};  // enhancement moves boundary by a pixel or two
  paint_within_ = static_cast<float>(depth_mm * depth_mm);
  search_within_ = std::max(paint_within_, cost(0, 2) + cost(1, 2) + cost(2, 1));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    int reach = kLeast[axis];
    while (cost(axis, reach + 1) <= paint_within_) ++reach;
    reach_[axis] = reach;
    for (int offset = 0; offset <= reach; ++offset) cost_[axis].push_back(cost(axis, offset));
  }
}

std::vector<std::byte> Shell::paint(int layer, const Window<SkinLayer>& window) const {
  std::vector<std::byte> bitmap(
      3 * static_cast<std::size_t>(box_.size_px[0]) * static_cast<std::size_t>(box_.size_px[1]),
      std::byte{255});
  Band band(*this, layer, window);
  for (int y = 0; y < box_.size_px[1]; y += kBandRows) {
    band.paint(y, std::min(box_.size_px[1], y + kBandRows), bitmap.data());
  }
  return bitmap;
}

}  // namespace binderjet
