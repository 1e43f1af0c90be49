// SPDX-License-Identifier: GPL-3.0-or-later
// A number with its noun, for messages: "1 facet", "2 facets".
#pragma once

#include <cstdint>
#include <string>

namespace binderjet {

inline std::string counted(std::int64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace binderjet
