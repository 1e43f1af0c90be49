// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/pieces.h"

#include <algorithm>
#include <set>
#include <utility>

#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

constexpr int kNone = -1;

// Calls take(part, piece, first, last, y) for each stretch of row y that lies in a run of the
// target and in one of the print, with their numbers.
template <class Take>
void for_each_shared(const RunLayer& target, const std::vector<int>& parts, const RunLayer& printed,
                     const std::vector<int>& pieces, Take take) {
  std::size_t part_begin = 0;
  std::size_t piece_begin = 0;
  for (int y = 0; y < target.height(); ++y) {
    const rows::Row wanted = target.row(y);
    const rows::Row row = printed.row(y);
    rows::for_each_overlap(wanted, row, [&](std::size_t i, std::size_t j) {
      take(parts[part_begin + i], pieces[piece_begin + j], std::max(wanted[2 * i], row[2 * j]),
           std::min(wanted[2 * i + 1], row[2 * j + 1]), y);
    });
    part_begin += wanted.size() / 2;
    piece_begin += row.size() / 2;
  }
}

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

PieceFinder::PieceFinder(int slices_per_layer, int first_layer, Contacts contacts)
    : slices_(slices_per_layer),
      finds_contacts_(contacts == Contacts::kFind),
      parts_(first_layer * slices_per_layer),
      pieces_(first_layer),
      contacts_(first_layer * slices_per_layer),
      slice_(first_layer * slices_per_layer) {}

const std::vector<int>& PieceFinder::add(const VoxelLayer& target, const RunLayer& printed) {
  const std::vector<int>& pieces = pieces_.add(printed);
  for (const RunLayer& slice : target.slices) {
    const std::vector<int>& parts = parts_.add(slice);
    if (finds_contacts_) contacts_.add(slice, parts, printed);
    for_each_shared(slice, parts, printed, pieces,
                    [&](int part, int piece, int first, int last, int y) {
                      const auto at = static_cast<std::size_t>(part);
                      if (at >= pieces_of_.size()) pieces_of_.resize(at + 1);
                      pieces_of_[at][piece].include(
                          {{first, y, slice_}, {last, y + 1, slice_ + 1}, last - first, false});
                    });
    ++slice_;
  }
  return pieces;
}

std::map<int, std::map<int, Region>> PieceFinder::pieces_by_part() {
  std::map<int, std::map<int, Region>> by_part;
  for (std::size_t part = 0; part < pieces_of_.size(); ++part) {
    std::map<int, Region>& all = by_part[parts_.root(static_cast<int>(part))];
    for (const auto& [piece, region] : pieces_of_[part]) all[pieces_.root(piece)].include(region);
  }
  return by_part;
}

std::vector<Region> PieceFinder::loose(const std::function<bool(const Region&)>& goes_on) {
  const std::vector<Region> regions = pieces_.regions();
  const auto whole = [&](int piece) {
    return in_slices(regions[static_cast<std::size_t>(piece)], slices_);
  };
  std::set<int> loose;  // a piece may come off two parts at once
  for (auto& [part, pieces] : pieces_by_part()) {
    if (pieces.size() < 2) continue;
    std::set<int> off;
    for (const auto& [piece, shared] : pieces) {
      if (!goes_on || !goes_on(whole(piece))) off.insert(piece);
    }
    if (off.size() == pieces.size()) {
      off.erase(std::max_element(off.begin(), off.end(),
                                 [&](int a, int b) { return whole(a).voxels < whole(b).voxels; }));
    }
    loose.insert(off.begin(), off.end());
  }
  std::vector<Region> out;
  out.reserve(loose.size());
  for (const int piece : loose) out.push_back(whole(piece));
  return out;
}

std::vector<Region> PieceFinder::joined() {
  std::map<int, std::set<int>> parts_by_piece;
  for (const auto& [part, pieces] : pieces_by_part()) {
    for (const auto& [piece, shared] : pieces) parts_by_piece[piece].insert(part);
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
