// SPDX-License-Identifier: GPL-3.0-or-later
// The command line of the whole program, for main and for its manual.
#pragma once

#include <memory>

namespace CLI {
class App;
}

namespace binderjet {

// Knows every verb; parsing runs the one that is named.
std::unique_ptr<CLI::App> make_program();

}  // namespace binderjet
