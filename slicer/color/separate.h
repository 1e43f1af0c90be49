// SPDX-License-Identifier: GPL-3.0-or-later
// Color bitmaps as planes of drops: one bit each of cyan, magenta and yellow.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "slicer/layers/run_layer.h"

namespace binderjet {

// Ink wets powder as binder does, so it goes only where the mask is: all else becomes white.
void whiten_outside(const RunLayer& mask, std::span<std::byte> rgb);

// Ink is what is missing to white: cyan takes away red, magenta green, yellow blue. `rgb` holds
// 24-bit rows; white gets no drop. Error diffusion there and back over the rows, with thresholds
// and first errors shaken by a hash of the place, so that even tones show neither worms nor seams
// and no two layers repeat each other. A pure function of its arguments.
std::array<RunLayer, 3> separate_cmy(std::span<const std::byte> rgb, int width, int height,
                                     int layer);

}  // namespace binderjet
