// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/pixel_search.h"

#include <algorithm>

namespace binderjet {
namespace {

constexpr std::array<Pixel, 8> kAround{
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

// The pixels' rectangle and one pixel on each side, so that neighbors need no test.
Rect bounds(std::span<const Pixel> pixels) {
  if (pixels.empty()) return {};
  Rect rect{pixels[0][0], pixels[0][1], pixels[0][0], pixels[0][1]};
  for (const auto& [x, y] : pixels) {
    rect = {std::min(rect.x0, x), std::min(rect.y0, y), std::max(rect.x1, x), std::max(rect.y1, y)};
  }
  return Rect{rect.x0, rect.y0, rect.x1 + 1, rect.y1 + 1}.grown(1, 1);
}

}  // namespace

PixelSearch::PixelSearch(LocalDose& dose, Plane<std::uint8_t>& mask, std::span<const Pixel> pixels,
                         const MaskRules& rules)
    : dose_(dose),
      mask_(mask),
      pixels_(pixels),
      rules_(rules),
      waiting_(bounds(pixels)),
      free_(bounds(pixels)) {
  for (const auto& [x, y] : pixels_) *free_.at(x, y) = 1;
}

void PixelSearch::run(int max_sweeps) {
  // Swaps are dear and help most where flips have settled.
  for (const bool with_swaps : {false, true}) {
    for (const auto& [x, y] : pixels_) *waiting_.at(x, y) = 1;
    bool better = true;
    for (int sweep = 0; better && sweep < max_sweeps; ++sweep) {
      better = false;
      for (const Pixel& p : pixels_) {
        std::uint8_t& waits = *waiting_.at(p[0], p[1]);
        if (waits == 0) continue;
        waits = 0;
        better = improve(p, with_swaps) || better;
      }
    }
  }
}

bool PixelSearch::improve(const Pixel& p, bool with_swaps) {
  const int cost = dose_.flip_cost(p[0], p[1], sign(p));
  if (cost < 0) return take(p);
  return with_swaps && improve_by_swap(p, cost);
}

// With the best of the pixels beside it that are in the other state.
bool PixelSearch::improve_by_swap(const Pixel& p, int own_cost) {
  const int own = sign(p);
  int best = 0;
  Pixel with{};
  bool flipped = false;
  for (const auto& [dx, dy] : kAround) {
    const Pixel q{p[0] + dx, p[1] + dy};
    if (*free_.at(q[0], q[1]) == 0 || sign(q) == own) continue;
    if (!flipped) dose_.flip(p[0], p[1], own);
    flipped = true;
    const int cost = own_cost + dose_.flip_cost(q[0], q[1], -own);
    if (cost < best) {
      best = cost;
      with = q;
    }
  }
  if (flipped) dose_.flip(p[0], p[1], -own);
  if (best >= 0) return false;
  flip(p);
  flip(with);
  if (rules_.fits_around(mask_, p[0], p[1]) && rules_.fits_around(mask_, with[0], with[1])) {
    look_again_around(p);
    look_again_around(with);
    return true;
  }
  flip(with);
  flip(p);
  return false;
}

bool PixelSearch::take(const Pixel& p) {
  std::uint8_t& pixel = *mask_.at(p[0], p[1]);
  pixel ^= 1;
  const bool fits = rules_.fits_around(mask_, p[0], p[1]);
  pixel ^= 1;
  if (!fits) return false;
  flip(p);
  look_again_around(p);
  return true;
}

void PixelSearch::flip(const Pixel& p) {
  dose_.flip(p[0], p[1], sign(p));
  *mask_.at(p[0], p[1]) ^= 1;
}

void PixelSearch::look_again_around(const Pixel& p) {
  const std::array<int, 2> reach = dose_.pixel_reach();
  const Rect near =
      Rect{p[0], p[1], p[0] + 1, p[1] + 1}.grown(reach[0], reach[1]).cut(waiting_.rect());
  for (int y = near.y0; y < near.y1; ++y) {
    std::fill_n(waiting_.at(near.x0, y), near.width(), std::uint8_t{1});
  }
}

}  // namespace binderjet
