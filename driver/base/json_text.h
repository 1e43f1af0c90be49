// SPDX-License-Identifier: GPL-3.0-or-later
// JSON as text, also where a name in it is not UTF-8.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace binderjet {

// Bytes that are not UTF-8 are escaped (slicer/base/byte_text.h), and what a terminal may obey is
// written \u00NN, which JSON leaves to its writer. In one line, or with `indent`.
std::string to_json_text(const nlohmann::ordered_json& json, int indent = -1);

}  // namespace binderjet
