// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/rules/mask_rules.h"

#include <algorithm>
#include <utility>

namespace binderjet {
namespace {

constexpr std::array<std::array<int, 2>, 4> kSides{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

}  // namespace

// Collects pixels until there are enough of them, or no more.
bool RuleCheck::fits(const Plane<std::uint8_t>& mask, int x, int y) {
  const std::uint8_t state = *mask.at(x, y);
  const auto enough =
      static_cast<std::size_t>(state != 0 ? rules_.min_island_px : rules_.min_hole_px);
  found_.assign(1, {x, y});
  for (std::size_t next = 0; next < found_.size() && found_.size() < enough; ++next) {
    const auto [px, py] = found_[next];
    for (const auto& [dx, dy] : kSides) {
      const std::array<int, 2> beside{px + dx, py + dy};
      if (!mask.rect().holds(beside[0], beside[1])) return true;
      if (*mask.at(beside[0], beside[1]) != state) continue;
      if (std::find(found_.begin(), found_.end(), beside) == found_.end()) found_.push_back(beside);
    }
  }
  return found_.size() >= enough;
}

bool RuleCheck::fits_around(const Plane<std::uint8_t>& mask, int x, int y) {
  if (rules_.largest_px() <= 1) return true;
  return fits(mask, x, y) && std::all_of(kSides.begin(), kSides.end(), [&](const auto& side) {
           return !mask.rect().holds(x + side[0], y + side[1]) ||
                  fits(mask, x + side[0], y + side[1]);
         });
}

void RuleCheck::repair(Plane<std::uint8_t>& mask, int x, int y) {
  if (fits(mask, x, y)) return;
  for (const auto& [px, py] : found_) *mask.at(px, py) ^= 1;
}

void obey(const MaskRules& rules, const Rect& area, Plane<std::uint8_t>& mask) {
  RuleCheck check(rules);
  for (const std::uint8_t state : {std::uint8_t{0}, std::uint8_t{1}}) {
    if ((state == 0 ? rules.min_hole_px : rules.min_island_px) <= 1) continue;
    for (int y = area.y0; y < area.y1; ++y) {
      const std::uint8_t* row = mask.at(area.x0, y) - area.x0;
      for (int x = area.x0; x < area.x1; ++x) {
        // What is too small has its first pixel in a row, seen from the left, at its own edge.
        if (row[x] == state && (x == mask.rect().x0 || row[x - 1] != state)) {
          check.repair(mask, x, y);
        }
      }
    }
  }
}

}  // namespace binderjet
