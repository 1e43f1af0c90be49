// SPDX-License-Identifier: GPL-3.0-or-later
// What a hidden printer's part suffers once it is bound: thin parts break off, and it soaks.
#pragma once

#include <array>
#include <vector>

#include "tests/hidden_printers/hidden_printer.h"

namespace binderjet::hidden {

// The layers after that; `voxel_mm` of a voxel along x and y, and of a layer.
std::vector<Shared<RunLayer>> worn(const Printer& printer, std::vector<Shared<RunLayer>> layers,
                                   const std::array<double, 3>& voxel_mm);

}  // namespace binderjet::hidden
