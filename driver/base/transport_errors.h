// SPDX-License-Identifier: GPL-3.0-or-later
// Where transport's results meet the program's errors.
#pragma once

#include <utility>

#include "slicer/base/error.h"
#include "transport/base/result.h"

namespace binderjet {

inline ErrorKind error_kind(FaultKind kind) {
  switch (kind) {
    case FaultKind::kBadInput:
      return ErrorKind::kBadInput;
    case FaultKind::kNoRoom:
      return ErrorKind::kNoRoom;
    case FaultKind::kInterrupted:
      return ErrorKind::kInterrupted;
    case FaultKind::kDevice:
      break;
  }
  return ErrorKind::kDevice;
}

// The value, or the fault as the Error that ends the job.
template <class T>
T value_or_throw(Result<T> result) {
  if (!result) {
    const Fault& fault = result.error();
    throw Error(error_kind(fault.kind), fault.where, fault.what);
  }
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

}  // namespace binderjet
