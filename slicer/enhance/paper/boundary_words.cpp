// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/paper/boundary_words.h"

#include <algorithm>
#include <bit>

#include "slicer/base/vector_clones.h"

namespace binderjet {
namespace {

// A tile is a whole number of granules, so tiles that begin at one do not meet.
constexpr int kGranule = 2;
static_assert(kTileColumns % kGranule == 0);

constexpr std::uint64_t kOnes = ~std::uint64_t{0};

std::span<const int> row_of(const RunLayer* slice, int row) {
  return slice == nullptr ? std::span<const int>() : slice->row(row);
}

// The bits of a word from a place on; a place below 0 is 0.
std::uint64_t ones_from(int place) {
  const auto shift = static_cast<std::uint64_t>(std::max(place, 0));
  return shift < 64 ? kOnes << shift : 0;
}

// The words of `rows` rows of two flips each, column x first. Most of a real part's rows are such.
BINDERJET_VECTOR_CLONES void draw_pairs(const int* flips, int rows, int x, std::uint64_t* words) {
  for (std::ptrdiff_t r = 0; r < rows; ++r) {
    words[r] = ones_from(flips[2 * r] - x) ^ ones_from(flips[2 * r + 1] - x);
  }
}

bool all_pairs(const RunLayer& layer, int first, int last) {
  for (int y = first; y < last; ++y) {
    if (layer.row(y).size() != 2) return false;
  }
  return true;
}

}  // namespace

ActiveTiles::ActiveTiles(int width)
    : width_(width), granules_(static_cast<std::size_t>(width / kGranule / 64 + 1)) {}

const std::vector<int>& ActiveTiles::find(const Slab& volume, int y) {
  std::fill(granules_.begin(), granules_.end(), 0);
  for (std::size_t s = 0; s < volume.size(); ++s) {
    for (int row = y - 1; row <= y + kTileRows; ++row) {
      const std::span<const int> here = row_of(volume[s], row);
      widen(here);
      // Rows with as many flips differ only between flips of the same rank, and those are seen
      // to by widen; others are compared where they meet.
      const std::span<const int> before = row_of(volume[s], row - 1);
      if (row >= y && before.size() != here.size()) mark_difference(before, here);
      if (s == 0) continue;
      const std::span<const int> under = row_of(volume[s - 1], row);
      if (under.size() != here.size()) mark_difference(under, here);
    }
  }
  flush();
  place_tiles();
  return tiles_;
}

// Rows with the same number of flips share one range per rank.
void ActiveTiles::widen(std::span<const int> row) {
  if (row.size() != low_.size()) {
    flush();
    low_.assign(row.begin(), row.end());
    high_ = low_;
    return;
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    low_[i] = std::min(low_[i], row[i]);
    high_[i] = std::max(high_[i], row[i]);
  }
}

void ActiveTiles::flush() {
  for (std::size_t i = 0; i < low_.size(); ++i) mark(low_[i] - 1, high_[i]);
  low_.clear();
  high_.clear();
}

// Each row is the exclusive or of the half-lines from its flips, so two rows differ only between
// flips of the same rank; what one row has more is taken as one.
void ActiveTiles::mark_difference(std::span<const int> a, std::span<const int> b) {
  const std::size_t both = std::min(a.size(), b.size());
  for (std::size_t i = 0; i < both; ++i) {
    if (a[i] != b[i]) mark(std::min(a[i], b[i]) - 1, std::max(a[i], b[i]));
  }
  const std::span<const int> rest = (a.size() > both ? a : b).subspan(both);
  if (!rest.empty()) mark(rest.front() - 1, rest.back());
}

void ActiveTiles::mark(int first, int last) {
  if (last < 0 || first >= width_) return;
  const int begin = std::max(first, 0) / kGranule;
  const int end = std::min(last, width_ - 1) / kGranule;
  const std::uint64_t head = kOnes << (begin % 64);
  const std::uint64_t tail = kOnes >> (63 - end % 64);
  const auto word = static_cast<std::size_t>(begin / 64);
  const auto last_word = static_cast<std::size_t>(end / 64);
  if (word == last_word) {
    granules_[word] |= head & tail;
    return;
  }
  granules_[word] |= head;
  std::fill(granules_.begin() + begin / 64 + 1, granules_.begin() + end / 64, kOnes);
  granules_[last_word] |= tail;
}

void ActiveTiles::place_tiles() {
  tiles_.clear();
  int covered = 0;  // granules
  for (std::size_t word = 0; word < granules_.size(); ++word) {
    const int first = static_cast<int>(word) * 64;
    for (std::uint64_t left = granules_[word] & ones_from(covered - first); left != 0;
         left &= ones_from(covered - first)) {
      const int granule = first + std::countr_zero(left);
      tiles_.push_back(granule * kGranule);
      covered = granule + kTileColumns / kGranule;
    }
  }
}

void DrawnBand::draw(const RunLayer* layer, const std::vector<int>& tiles, int y) {
  words_.resize(tiles.size());
  const int first = std::max(0, -y);
  const int last = layer == nullptr ? first : std::min(kDrawnRows, layer->height() - y);
  if (first > 0 || last < kDrawnRows) {
    for (Words& words : words_) words.fill(0);
  }
  if (last > first && all_pairs(*layer, y + first, y + last)) {
    const int* flips = layer->row(y + first).data();
    for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
      draw_pairs(flips, last - first, tiles[tile] - 1, words_[tile].data() + first);
    }
    return;
  }
  for (int r = first; r < last; ++r) {
    draw_row(layer->row(y + r), tiles, static_cast<std::size_t>(r));
  }
}

void DrawnBand::draw_row(std::span<const int> row, const std::vector<int>& tiles, std::size_t r) {
  std::size_t next = 0;  // the first flip right of the tile's first column
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    const int x = tiles[tile] - 1;
    while (next < row.size() && row[next] <= x) ++next;
    std::uint64_t word = next % 2 == 1 ? kOnes : 0;
    for (std::size_t i = next; i < row.size() && row[i] < x + 64; ++i)
      word ^= kOnes << (row[i] - x);
    words_[tile][r] = word;
  }
}

}  // namespace binderjet
