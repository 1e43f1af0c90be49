// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/base/json_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "slicer/base/byte_text.h"

namespace binderjet {
namespace {

nlohmann::ordered_json escaped(const nlohmann::ordered_json& json) {
  if (json.is_string()) return escape_bytes(json.get_ref<const std::string&>());
  if (json.is_array()) {
    auto out = nlohmann::ordered_json::array();
    for (const auto& element : json) out.push_back(escaped(element));
    return out;
  }
  if (json.is_object()) {
    auto out = nlohmann::ordered_json::object();
    for (const auto& [key, value] : json.items()) out[escape_bytes(key)] = escaped(value);
    return out;
  }
  return json;
}

// DEL and C1, which stand only within strings.
std::string without_controls(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    if (byte == 0x7f) {
      out += "\\u007f";
    } else if (byte == 0xc2 && next >= 0x80 && next < 0xa0) {
      out += fmt::format("\\u00{:02x}", next);
      ++i;
    } else {
      out += text[i];
    }
  }
  return out;
}

}  // namespace

std::string to_json_text(const nlohmann::ordered_json& json, int indent) {
  try {
    return without_controls(json.dump(indent));
  } catch (const nlohmann::json::type_error&) {  // 316: a string is not UTF-8
    return without_controls(escaped(json).dump(indent));
  }
}

}  // namespace binderjet
