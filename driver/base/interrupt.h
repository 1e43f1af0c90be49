// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C, SIGTERM and SIGHUP, in one mechanism for every verb:
//
//   signal --> remembered --> work that advances ends by check_interrupt(), calls that wait by
//   EINTR
//      |                      and the program says so, with all it cleans up: mostly at once
//      +-----> a thread that waits for this says after a moment that the program stops; what has
//      not
//              ended 1.4 s after the signal, wherever it computes or waits, is ended by the thread
//
// The second way is as safe as kill -9, against which spools, journals and slices are made, and it
// takes the temporary files along.
#pragma once

namespace binderjet {

// From here on these signals are answered as above instead of by sudden death, which a second
// SIGINT or SIGTERM is. Calls that wait fail by EINTR. To be called before there are threads.
void catch_interrupts();
// Whether a signal came.
bool interrupted();
// Throws Error{kInterrupted} if a signal came.
void check_interrupt();

// The program is about to end by itself and says how: from here on the thread does not end it.
void claim_end();

}  // namespace binderjet
