// SPDX-License-Identifier: GPL-3.0-or-later
// Whole numbers out of JSON. nlohmann's own conversion makes 2 of 2.5 and 1 of 2^32 + 1, and what
// it makes of 1e43 is undefined.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "slicer/base/error.h"

namespace binderjet {

// Throws an Error at `where` unless `json` is a whole number that an int can hold.
template <class Json>
void get_int(const Json& json, int& value, const std::string& where) {
  constexpr std::int64_t kMost = std::numeric_limits<int>::max();
  const bool in_range =
      json.is_number_unsigned()
          ? json.template get<std::uint64_t>() <= static_cast<std::uint64_t>(kMost)
          : json.is_number_integer() && json.template get<std::int64_t>() >= -kMost;
  if (!in_range) {
    throw Error(ErrorKind::kBadInput, where,
                "has " + json.dump() + " where a whole number belongs");
  }
  value = json.template get<int>();
}

template <class Json, std::size_t N>
void get_int(const Json& json, std::array<int, N>& values, const std::string& where) {
  if (!json.is_array() || json.size() != N) {
    throw Error(ErrorKind::kBadInput, where,
                "has " + json.dump() + " where " + std::to_string(N) + " whole numbers belong");
  }
  for (std::size_t i = 0; i < N; ++i) get_int(json.at(i), values[i], where);
}

}  // namespace binderjet
