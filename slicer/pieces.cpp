// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/pieces.h"

#include <algorithm>
#include <map>
#include <utility>

#include "slicer/rows.h"

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
    }
    below_begin += last_.row(y).size() / 2;
  }
  of_run_ = std::move(of_run);
  last_ = slice;
  return of_run_;
}

void PieceCounter::add(const VoxelLayer& target, const RunLayer& printed) {
  const std::vector<int>& pieces = pieces_.add(printed);
  for (const RunLayer& slice : target.slices) {
    for_each_shared(slice, parts_.add(slice), printed, pieces, [&](int part, int piece, auto...) {
      const auto at = static_cast<std::size_t>(part);
      if (at >= pieces_of_.size()) pieces_of_.resize(at + 1);
      pieces_of_[at].insert(piece);
    });
  }
}

std::int64_t PieceCounter::separated() {
  std::map<int, std::set<int>> by_part;
  for (std::size_t part = 0; part < pieces_of_.size(); ++part) {
    std::set<int>& all = by_part[parts_.root(static_cast<int>(part))];
    for (const int piece : pieces_of_[part]) all.insert(pieces_.root(piece));
  }
  return std::count_if(by_part.begin(), by_part.end(),
                       [](const auto& part) { return part.second.size() > 1; });
}

}  // namespace binderjet
