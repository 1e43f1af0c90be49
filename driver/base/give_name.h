// SPDX-License-Identifier: GPL-3.0-or-later
// Outputs that get their names together.
#pragma once

#include <functional>

namespace binderjet {

// Gives what is written whole, under a temporary name, its own name. Uncalled, what was written
// vanishes: whoever writes several outputs calls it for none before all are written.
using GiveName = std::function<void()>;

}  // namespace binderjet
