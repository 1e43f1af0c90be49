// SPDX-License-Identifier: GPL-3.0-or-later
// The words for a job's state, as people and scripts read them.
#include "transport/base/backend.h"

namespace binderjet {

const char* job_state_word(JobState state) {
  switch (state) {
    case JobState::kIncoming:
      return "incoming";
    case JobState::kHeld:
      return "held";
    case JobState::kDone:
      break;
  }
  return "done";
}

}  // namespace binderjet
