// SPDX-License-Identifier: GPL-3.0-or-later
// A slice stack: a folder with stack.json and one image per layer.
//
//   {"format": "slice-stack", "version": 1, "kind": "mask", "size": [nx, ny, nz],
//    "pitch_mm": [px, py, pz], "origin_mm": [x, y, z], "files": "mask_%06d.png", "first": 0}
//
// Masks and color are at the printer grid. A printed stack is at the voxel pitch in x and y with
// one image per layer, since the slices of a layer are equal; a target has every slice. Row 0 of an
// image is the smallest y. "also": ["features.json"] names files that are part of it besides.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "slicer/layers/run_layer.h"

namespace binderjet {

enum class StackKind { kMask, kTarget, kPrinted, kMeasured, kColor };

std::string word(StackKind kind);

// Column i of row j of image k is the sample that covers [origin + (i, j, k) pitch, + pitch).
struct StackInfo {
  StackKind kind = StackKind::kMask;
  std::array<int, 3> size{};  // nx, ny, number of images
  std::array<double, 3> pitch_mm{};
  std::array<double, 3> origin_mm{};
  std::string files;              // printf pattern with one %d, e.g. "mask_%06d.png"
  int first = 0;                  // the number of the first image
  int threshold = 128;            // an 8-bit sample is solid from here on
  bool threshold_stated = false;  // in stack.json, rather than by default
  std::vector<std::string> also;  // files besides the images, of the same folder
};

// What stack.json says. Error{kBadInput} if it is not there or not one of ours.
StackInfo read_stack_info(const std::string& folder);

// Writes a stack under a temporary name beside `folder`; finish() gives it its name. A stack that
// is not finished vanishes, and what stood at `folder` before stays.
class StackWriter {
 public:
  // `folder` may be new, empty, or an earlier slice stack, which finish() replaces; anything else
  // there, or a file within it that its stack.json does not name, is an Error{kUsage} that names
  // it, for it may be somebody's work.
  StackWriter(const std::string& folder, StackInfo info);
  ~StackWriter();
  StackWriter(const StackWriter&) = delete;
  StackWriter& operator=(const StackWriter&) = delete;

  // Image `index` (0 is `first`), of the stack's size. Threads may write different images at once.
  void write(int index, const RunLayer& layer) const;
  void write_packed(int index, std::span<const std::byte> bits) const;
  void write_encoded(int index, std::span<const std::byte> file) const;
  // 24-bit rows of red, green, blue.
  void write_rgb(int index, std::span<const std::byte> rgb) const;
  // A file beside the images, which stack.json names.
  void add_file(const std::string& name, std::span<const std::byte> bytes);
  // Writes what is left and waits until the disk has all of it; then only the name is missing.
  void complete();
  // Gives the folder its name, complete() before that if need be: in one step, in which an earlier
  // stack steps aside, so that one of the two stands there whatever happens.
  void finish();

  const StackInfo& info() const { return info_; }

 private:
  void write_file(const std::string& name, std::span<const std::byte> bytes) const;

  std::string folder_;
  std::string part_;  // the temporary name; empty once finished
  bool complete_ = false;
  StackInfo info_;
};

// Reads a stack that anybody wrote: any image format of read_image.h, 1-bit or gray.
class StackReader {
 public:
  // Error{kBadInput} if stack.json is not there, not one of ours or names a missing image.
  explicit StackReader(const std::string& folder);

  const StackInfo& info() const { return info_; }
  // Image `index`, solid where 1 (1-bit) or >= threshold; threads may read different ones at once.
  RunLayer read(int index) const;
  // The same as gray values, row 0 first.
  std::vector<std::uint8_t> read_gray(int index) const;

 private:
  std::string image_path(int index) const;

  std::string folder_;
  StackInfo info_;
};

}  // namespace binderjet
