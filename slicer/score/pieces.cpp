// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/pieces.h"

#include <algorithm>
#include <map>
#include <utility>

#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

constexpr int kNone = -1;

}  // namespace

int RegionNumbers::root(int number) {
  const auto parent = [this](int n) -> int& { return parent_[static_cast<std::size_t>(n)]; };
  while (parent(number) != number) {
    parent(number) = parent(parent(number));
    number = parent(number);
  }
  return number;
}

void RegionNumbers::take(int& own, int other) {
  other = root(other);
  if (own != kNone && root(own) != other) {
    const int low = std::min(root(own), other);
    parent_[static_cast<std::size_t>(std::max(root(own), other))] = low;
    other = low;
  }
  own = other;
}

const std::vector<int>& RegionNumbers::add(const RunLayer& slice) {
  std::vector<int> of_run;
  std::size_t row_begin = 0;     // the row's first run
  std::size_t before_begin = 0;  // that of the row before
  std::size_t below_begin = 0;   // that of the same row in the slice below
  for (int y = 0; y < slice.height(); ++y) {
    const auto row = slice.row(y);
    before_begin = std::exchange(row_begin, of_run.size());
    of_run.resize(row_begin + row.size() / 2, kNone);
    rows::for_each_overlap(row, slice.row(y - 1), [&](std::size_t i, std::size_t j) {
      take(of_run[row_begin + i], of_run[before_begin + j]);
    });
    rows::for_each_overlap(row, last_.row(y), [&](std::size_t i, std::size_t j) {
      take(of_run[row_begin + i], of_run_[below_begin + j]);
    });
    for (std::size_t i = row_begin; i < of_run.size(); ++i) {
      if (of_run[i] != kNone) continue;
      of_run[i] = static_cast<int>(parent_.size());
      parent_.push_back(of_run[i]);
      region_.emplace_back();
    }
    for (std::size_t i = row_begin; i < of_run.size(); ++i) {
      const std::size_t flip = 2 * (i - row_begin);
      region_[static_cast<std::size_t>(of_run[i])].include({{row[flip], y, slice_},
                                                            {row[flip + 1], y + 1, slice_ + 1},
                                                            row[flip + 1] - row[flip],
                                                            false});
    }
    below_begin += last_.row(y).size() / 2;
  }
  of_run_ = std::move(of_run);
  last_ = slice;
  ++slice_;
  return of_run_;
}

std::vector<Region> RegionNumbers::regions() {
  std::vector<Region> all(region_.size());
  for (std::size_t number = 0; number < region_.size(); ++number) {
    all[static_cast<std::size_t>(root(static_cast<int>(number)))].include(region_[number]);
  }
  return all;
}

void PieceCounter::add(const VoxelLayer& target, const RunLayer& printed) {
  slices_ = static_cast<int>(target.slices.size());
  const std::vector<int>& pieces = pieces_.add(printed);
  for (const RunLayer& slice : target.slices) {
    const std::vector<int>& parts = parts_.add(slice);
    contacts_.add(slice, parts, printed);
    for_each_shared(slice, parts, printed, pieces, [&](int part, int piece, auto...) {
      const auto at = static_cast<std::size_t>(part);
      if (at >= pieces_of_.size()) pieces_of_.resize(at + 1);
      pieces_of_[at].insert(piece);
    });
  }
}

std::map<int, std::set<int>> PieceCounter::pieces_by_part() {
  std::map<int, std::set<int>> by_part;
  for (std::size_t part = 0; part < pieces_of_.size(); ++part) {
    std::set<int>& all = by_part[parts_.root(static_cast<int>(part))];
    for (const int piece : pieces_of_[part]) all.insert(pieces_.root(piece));
  }
  return by_part;
}

std::int64_t PieceCounter::separated() {
  const auto by_part = pieces_by_part();
  return std::count_if(by_part.begin(), by_part.end(),
                       [](const auto& part) { return part.second.size() > 1; });
}

std::vector<Region> PieceCounter::loose_pieces(const GoesOn& goes_on) {
  const std::vector<Region> regions = pieces_.regions();
  const auto region = [&](int piece) {
    return in_slices(regions[static_cast<std::size_t>(piece)], slices_);
  };
  std::set<int> loose;  // a piece may come off two parts at once
  auto by_part = pieces_by_part();
  for (auto& [part, pieces] : by_part) {
    if (pieces.size() < 2) continue;
    const auto kept = [&](int piece) { return goes_on && goes_on(region(piece)); };
    if (std::erase_if(pieces, kept) == 0) {
      pieces.erase(std::max_element(pieces.begin(), pieces.end(), [&](int a, int b) {
        return region(a).voxels < region(b).voxels;
      }));
    }
    loose.insert(pieces.begin(), pieces.end());
  }
  std::vector<Region> out;
  out.reserve(loose.size());
  for (const int piece : loose) out.push_back(region(piece));
  return out;
}

std::vector<Region> PieceCounter::joints() {
  std::map<int, std::set<int>> parts_by_piece;
  for (const auto& [part, pieces] : pieces_by_part()) {
    for (const int piece : pieces) parts_by_piece[piece].insert(part);
  }
  const auto bridges = contacts_.contacts([this](int number) { return parts_.root(number); });
  std::set<int> bridged;
  std::vector<Region> out;
  for (const auto& [pair, bridge] : bridges) {
    out.push_back(bridge);
    bridged.insert({pair.first, pair.second});
  }
  const std::vector<Region> regions = pieces_.regions();
  for (const auto& [piece, parts] : parts_by_piece) {
    if (parts.size() < 2) continue;
    if (std::all_of(parts.begin(), parts.end(), [&](int part) { return bridged.contains(part); })) {
      continue;
    }
    out.push_back(in_slices(regions[static_cast<std::size_t>(piece)], slices_));
  }
  return out;
}

}  // namespace binderjet
