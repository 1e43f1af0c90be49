// SPDX-License-Identifier: GPL-3.0-or-later
// Where transport's results meet the program's errors.
#pragma once

#include <utility>

#include "slicer/base/error.h"
#include "transport/base/result.h"

namespace binderjet {

inline ErrorKind error_kind(FailureKind kind) {
  switch (kind) {
    case FailureKind::kBadInput:
      return ErrorKind::kBadInput;
    case FailureKind::kNoRoom:
      return ErrorKind::kNoRoom;
    case FailureKind::kInterrupted:
      return ErrorKind::kInterrupted;
    case FailureKind::kDevice:
      break;
  }
  return ErrorKind::kDevice;
}

// The value, or the fault as the Error that ends the job.
template <class T>
T value_or_throw(Result<T> result) {
  if (!result) {
    const Failure& fault = result.error();
    throw Error(error_kind(fault.kind), fault.where, fault.what);
  }
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

}  // namespace binderjet
