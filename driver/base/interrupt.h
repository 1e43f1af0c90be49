// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C, SIGTERM and SIGHUP: remembered when they come, answered where work can end.
#pragma once

namespace binderjet {

// From here on these signals are answered by check_interrupt() instead of by sudden death, which a
// second SIGINT or SIGTERM is. Calls that wait fail by EINTR.
void catch_interrupts();
// Whether a signal came.
bool interrupted();
// Throws Error{kInterrupted} if a signal came.
void check_interrupt();

}  // namespace binderjet
