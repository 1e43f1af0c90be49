// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/contacts.h"

#include <algorithm>

namespace binderjet {

// One step of ways that go across rows (or slices): what is printed carries them on, a target run
// ends them and begins its own. Reports the ends that a way has bridged.
template <class Found>
void ContactFinder::walk(Ways& ways, std::span<const int> target, const int* numbers,
                         std::span<const int> printed, int at, Found found) {
  spare_.clear();
  std::size_t first = 0;  // of `ways` that may reach beyond what was seen
  const auto overlapping = [&](int begin, int end, auto take) {
    while (first < ways.size() && ways[first].end <= begin) ++first;
    for (std::size_t i = first; i < ways.size() && ways[i].begin < end; ++i) {
      take(Way{std::max(begin, ways[i].begin), std::min(end, ways[i].end), ways[i].number,
               ways[i].last});
    }
  };
  const auto carry_on = [&](int begin, int end) {
    if (begin < end) overlapping(begin, end, [&](const Way& way) { spare_.push_back(way); });
  };
  std::size_t run = 0;
  for (std::size_t p = 0; p < printed.size(); p += 2) {
    int x = printed[p];
    while (run < target.size() && target[run + 1] <= x) run += 2;
    for (std::size_t t = run; t < target.size() && target[t] < printed[p + 1]; t += 2) {
      const int begin = std::max(target[t], printed[p]);
      const int end = std::min(target[t + 1], printed[p + 1]);
      const int number = numbers[t / 2];
      carry_on(x, begin);
      overlapping(begin, end, [&](const Way& way) {
        if (way.number != number && way.last + 1 < at) found(way, number);
      });
      spare_.push_back({begin, end, number, at});
      x = end;
    }
    carry_on(x, printed[p + 1]);
  }
  std::swap(ways, spare_);
}

void ContactFinder::walk_row(std::span<const int> target, const int* numbers,
                             std::span<const int> printed, int y) {
  std::size_t p = 0;
  for (std::size_t t = 2; t < target.size(); t += 2) {
    const int from = target[t - 1];
    const int to = target[t];
    while (p < printed.size() && printed[p + 1] <= from) p += 2;
    if (p >= printed.size()) return;
    if (printed[p] >= from || printed[p + 1] <= to) continue;
    found(0, numbers[t / 2 - 1], numbers[t / 2],
          {{from, y, slice_}, {to, y + 1, slice_ + 1}, to - from, false});
  }
}

void ContactFinder::add(const RunLayer& target, const std::vector<int>& number_of_run,
                        const RunLayer& printed) {
  upward_.resize(static_cast<std::size_t>(printed.height()));
  Ways across;
  const int* numbers = number_of_run.data();
  for (int y = 0; y < printed.height(); ++y) {
    const auto row = target.row(y);
    const auto print = printed.row(y);
    walk_row(row, numbers, print, y);
    walk(across, row, numbers, print, y, [&](const Way& way, int number) {
      found(1, way.number, number,
            {{way.begin, way.last + 1, slice_},
             {way.end, y, slice_ + 1},
             std::int64_t{way.end - way.begin} * (y - way.last - 1),
             false});
    });
    walk(upward_[static_cast<std::size_t>(y)], row, numbers, print, slice_,
         [&](const Way& way, int number) {
           found(2, way.number, number,
                 {{way.begin, y, way.last + 1},
                  {way.end, y + 1, slice_},
                  std::int64_t{way.end - way.begin} * (slice_ - way.last - 1),
                  false});
         });
    numbers += row.size() / 2;
  }
  ++slice_;
}

void ContactFinder::found(std::size_t axis, int a, int b, const Region& bridge) {
  if (a == b) return;
  found_[std::minmax(a, b)][axis].include(bridge);
}

std::map<std::pair<int, int>, Region> ContactFinder::contacts(
    const std::function<int(int)>& region) const {
  std::map<std::pair<int, int>, std::array<Region, 3>> joined;
  for (const auto& [pair, by_axis] : found_) {
    const int a = region(pair.first);
    const int b = region(pair.second);
    if (a == b) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      joined[std::minmax(a, b)][axis].include(by_axis[axis]);
    }
  }
  std::map<std::pair<int, int>, Region> out;
  for (const auto& [pair, by_axis] : joined) {
    Region& all = out[pair];
    std::int64_t voxels = 0;
    for (const Region& ways : by_axis) {
      all.include(ways);
      voxels = std::max(voxels, ways.voxels);
    }
    all.voxels = voxels;
  }
  return out;
}

}  // namespace binderjet
