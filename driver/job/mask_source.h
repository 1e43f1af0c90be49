// SPDX-License-Identifier: GPL-3.0-or-later
// Masks to read, whether they lie in a job or in a slice stack.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "driver/base/console.h"
#include "driver/job/job.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/stream.h"
#include "slicer/stack/slice_stack.h"

namespace binderjet {

struct MaskSource {
  std::string path;
  std::optional<JobHeader> header;  // of a job; a stack has none
  std::array<int, 3> size_px{};     // nx, ny, layers that are there
  int first = 0;                    // the first of them
  std::array<double, 3> pitch_mm{};
  std::array<double, 3> origin_mm{};  // of the first layer's lower corner
  // The mask of layer first + index, packed (see pack()); threads may read different ones at once.
  std::function<std::vector<std::byte>(int index)> packed;
  // Likewise its color bitmap, 24-bit rows; empty function if the job has no color.
  std::function<std::vector<std::byte>(int index)> color;

  JobPlace place() const;
  LayerRange layers() const { return {first, first + size_px[2]}; }
  RunLayer read(int index) const { return unpack(packed(index), size_px[0], size_px[1]); }
  // The source must outlive the stream.
  std::unique_ptr<Stream<RunLayer>> stream() const;
  // How a stack of this box is described.
  StackInfo stack_info(StackKind kind) const;
};

// A .bjob file or a folder with masks. A cut job is read as far as it is whole, with a warning.
MaskSource open_masks(const std::string& path, const Console& console);

// A job's masks; Error{kUsage} for a stack.
MaskSource open_job(const std::string& path, const Console& console);

}  // namespace binderjet
