// SPDX-License-Identifier: GPL-3.0-or-later
// What the emulated printer makes of the masks it received: powder, binder, and a physics of its
// own that no profile and no solver knows.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slicer/stack/slice_stack.h"
#include "transport/emulator/printer_emulator.h"

namespace binderjet {

// The printed layers, as masks come; each has one byte a pixel, so two of them are held.
class PowderBed {
 public:
  // `header` is a job's; Error{kBadInput} if it does not say how large a layer is.
  PowderBed(const std::string& header, int layer_count);
  ~PowderBed();

  // The stack of kind "measured" that the printed layers make.
  const StackInfo& info() const { return info_; }

  // Takes the records of the next layer and gives the printed layer below it, packed as masks are:
  // binder sinks, so a layer is known once that above it is. Error{kBadInput} if there is no mask
  // of the header's size among them.
  std::optional<std::vector<std::byte>> take(std::span<const std::byte> records);
  // The layer on top, behind the last mask; nothing if none came.
  std::optional<std::vector<std::byte>> top() const;

 private:
  struct Plane;
  static std::vector<std::byte> bind(const Plane& mask, const Plane* above);

  StackInfo info_;
  std::unique_ptr<const Plane> newest_;  // the last mask; null before the first
};

struct PrintedVolume {
  std::array<int, 3> size_px{};
  std::array<double, 3> pitch_mm{};
  std::array<double, 3> origin_mm{};
  std::vector<std::vector<std::byte>> layers;  // packed rows, as masks are

  bool operator==(const PrintedVolume&) const = default;
};

// The whole of a job, which has kept its layers; Error{kBadInput} as PowderBed's.
PrintedVolume print_volume(const EmulatedJob& job);

// Writes it as a slice stack of kind "measured".
void write_measured(const PrintedVolume& volume, const std::string& folder);

}  // namespace binderjet
