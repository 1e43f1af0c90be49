// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C and SIGTERM: remembered when they come, answered where work can end.
#pragma once

namespace binderjet {

// From here on Ctrl-C and SIGTERM are answered by check_interrupt() instead of by sudden death.
void catch_interrupts();
// Whether a signal came.
bool interrupted();
// Throws Error{kInterrupted} if a signal came.
void check_interrupt();

}  // namespace binderjet
