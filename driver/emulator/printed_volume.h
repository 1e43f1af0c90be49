// SPDX-License-Identifier: GPL-3.0-or-later
// What the emulated printer makes of the masks it received: powder, binder, and a physics of its
// own that no profile and no solver knows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "transport/emulator/printer_emulator.h"

namespace binderjet {

struct PrintedVolume {
  std::array<int, 3> size_px{};
  std::array<double, 3> pitch_mm{};
  std::array<double, 3> origin_mm{};
  std::vector<std::vector<std::byte>> layers;  // packed rows, as masks are

  bool operator==(const PrintedVolume&) const = default;
};

// Throws std::runtime_error if a record is not a mask of the header's size.
PrintedVolume print_volume(const EmulatedJob& job);

// Writes it as a slice stack of kind "measured".
void write_measured(const PrintedVolume& volume, const std::string& folder);

}  // namespace binderjet
