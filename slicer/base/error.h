// SPDX-License-Identifier: GPL-3.0-or-later
// The one exception of the program: what ends a job, where, and what to do about it.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace binderjet {

// The kinds are the program's exit statuses.
enum class ErrorKind { kUsage = 2, kBadInput = 3, kDevice = 4, kNoRoom = 5, kInterrupted = 130 };

class Error : public std::runtime_error {
 public:
  // `where` is a place a person can open ("gargoyle.obj: face 1042", "z450.toml:10:19") or empty;
  // `what` says what is wrong and what to do.
  Error(ErrorKind kind, const std::string& where, const std::string& what)
      : std::runtime_error(where.empty() ? what : where + ": " + what), kind_(kind) {}

  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

}  // namespace binderjet
