// SPDX-License-Identifier: GPL-3.0-or-later
// Failures that the caller handles on its next line: time-out, stall, short write, damaged file.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace binderjet {

enum class FailureKind {
  kBadInput,     // a file or a message that is not what it should be
  kDevice,       // the device or the way to it
  kNoRoom,       // disk full, quota
  kInterrupted,  // somebody asked to stop
};

struct Failure {
  FailureKind kind;
  std::string where;  // a place a person can open: path, URI, "layer 388 of 1200"; may be empty
  std::string what;   // what is wrong and what to do
};

template <class T>
using Result = tl::expected<T, Failure>;

}  // namespace binderjet
