// SPDX-License-Identifier: GPL-3.0-or-later
// One layer or slice of bits as rows of runs: the x positions at which a row flips its state.
//
//   row   ...####..###.     flips 3 7 9 12: voxels [3, 7) and [9, 12) are 1
//
// "Runs" make every step cost the boundary: layers of real parts are mostly empty or full, so a row
// of 4,800 voxels is two or four numbers, where a bit for each voxel would be 600 bytes. The price
// is that no voxel can be set in place: a layer is built row after row and then only read.
//
// All rows lie in one array, because a vector for each row costs more in allocations than the rows
// hold. Copies are deep; layers that several steps look at are passed as Shared<RunLayer>.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace binderjet {

class RunLayer {
 public:
  // `width` columns; rows follow through append_row, in order of y.
  explicit RunLayer(int width = 0) : width_(width) {}

  static RunLayer powder(int width, int height) {
    RunLayer layer(width);
    layer.ends_.assign(static_cast<std::size_t>(height), 0);
    return layer;
  }

  int width() const { return width_; }
  int height() const { return static_cast<int>(ends_.size()); }
  bool empty() const { return flips_.empty(); }

  // Strictly ascending positions in [0, width], an even number of them: the voxels [f0, f1),
  // [f2, f3) ... are 1. Rows outside the layer are powder.
  std::span<const int> row(int y) const {
    if (y < 0 || y >= height()) return {};
    const std::size_t first = row_begin(y);
    return {flips_.data() + first, ends_[static_cast<std::size_t>(y)] - first};
  }

  // Voxels outside the layer read as powder. WARNING: linear in the flips of the row. A loop over
  // voxels walks row() instead.
  bool at(int x, int y) const {
    std::size_t before = 0;
    for (const int flip : row(y)) {
      if (flip > x) break;
      ++before;
    }
    return before % 2 == 1;
  }

  // How many voxels are 1; linear in the flips of the layer.
  std::int64_t count() const {
    std::int64_t ones = 0;
    for (std::size_t i = 0; i < flips_.size(); i += 2) ones += flips_[i + 1] - flips_[i];
    return ones;
  }

  // Appends one flip to the row being built; a flip at the place of the last one undoes it, so
  // touching runs join and empty runs vanish.
  void flip(int x) {
    assert(x >= 0 && x <= width_);
    if (flips_.size() > row_begin() && flips_.back() == x) {
      flips_.pop_back();
    } else {
      assert(flips_.size() == row_begin() || flips_.back() < x);
      flips_.push_back(x);
    }
  }
  void end_row() {
    assert((flips_.size() - row_begin()) % 2 == 0);
    ends_.push_back(flips_.size());
  }
  void append_row(std::span<const int> flips) {
    flips_.insert(flips_.end(), flips.begin(), flips.end());
    end_row();
  }
  // Appends the row whose voxel x is 1 where `is(x)`; asks for each x once, in order. This costs
  // the width, not the boundary.
  template <class Is>
  void append_row_where(const Is& is) {
    bool solid = false;
    for (int x = 0; x < width_; ++x) {
      if (is(x) == solid) continue;
      solid = !solid;
      flips_.push_back(x);
    }
    if (solid) flips_.push_back(width_);
    end_row();
  }
  // Appends the rows [first, last) of another layer of this width.
  void append_rows(const RunLayer& from, int first, int last) {
    if (first >= last) return;
    const std::size_t begin = from.row_begin(first);
    const std::size_t end = from.ends_[static_cast<std::size_t>(last) - 1];
    const std::size_t to = flips_.size();
    flips_.insert(flips_.end(), from.flips_.begin() + static_cast<std::ptrdiff_t>(begin),
                  from.flips_.begin() + static_cast<std::ptrdiff_t>(end));
    for (int y = first; y < last; ++y) {
      ends_.push_back(from.ends_[static_cast<std::size_t>(y)] - begin + to);
    }
  }
  void reserve(int height, std::size_t flips) {
    ends_.reserve(static_cast<std::size_t>(height));
    flips_.reserve(flips);
  }

  std::size_t flip_count() const { return flips_.size(); }
  bool operator==(const RunLayer&) const = default;

 private:
  std::size_t row_begin(int y) const { return y == 0 ? 0 : ends_[static_cast<std::size_t>(y) - 1]; }
  std::size_t row_begin() const { return row_begin(height()); }  // of the row being built

  int width_;
  std::vector<std::size_t> ends_;  // per row, where its flips end
  std::vector<int> flips_;
};

// Packed rows, one bit per voxel, first voxel in the highest bit, rows padded with 0 to whole
// bytes: the form of PNG, of the job's mask records and of the wire.
std::size_t packed_row_bytes(int width);
std::vector<std::byte> pack(const RunLayer& layer);
// `bits` is height * packed_row_bytes(width) bytes.
RunLayer unpack(std::span<const std::byte> bits, int width, int height);

// The part of a layer whose lower corner is at (x, y), which may lie outside: there it is powder.
RunLayer window(const RunLayer& layer, int x, int y, int width, int height);

}  // namespace binderjet
