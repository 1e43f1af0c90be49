// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/profile/write_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "slicer/base/byte_text.h"
#include "slicer/base/error.h"

namespace binderjet {
namespace {

// A TOML basic string.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : escape_bytes(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < ' ' || c == '\x7f' ? ' ' : c;
  }
  return out + "\"";
}

std::string one_line(const std::string& text) {
  std::string out = escape_bytes(text);
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
  }
  return out;
}

std::string to_toml(const EffectSpec& effect) {
  std::string text = fmt::format("[[effects]]\nkind = {}\n", quoted(effect.kind));
  for (const auto& [name, word] : effect.words)
    text += fmt::format("{} = {}\n", name, quoted(word));
  for (const auto& [name, values] : effect.numbers) {
    // {} writes a double with as many digits as bring the same double back.
    text += values.size() == 1 ? fmt::format("{} = {}\n", name, values.front())
                               : fmt::format("{} = [{}]\n", name, fmt::join(values, ", "));
  }
  return text + "\n";
}

bool starts_with_key(const std::string& line, const std::string& key) {
  const std::size_t end = line.find_first_of(" \t=");
  return end != std::string::npos && line.substr(0, end) == key;
}

bool same(const std::vector<EffectSpec>& a, const std::vector<EffectSpec>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const EffectSpec& x, const EffectSpec& y) {
                      return x.kind == y.kind && x.words == y.words && x.numbers == y.numbers;
                    });
}

}  // namespace

std::string calibrated_profile(const Profile& declared, const std::string& name,
                               const std::string& source, std::span<const std::string> notes,
                               const std::vector<EffectSpec>& effects) {
  std::string replacement;
  for (const std::string& note : notes) replacement += "# " + one_line(note) + "\n";
  for (const EffectSpec& effect : effects) replacement += to_toml(effect);
  std::istringstream lines(declared.text);
  std::string text;
  bool in_effects = false;
  bool in_tables = false;
  bool replaced = false;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.front() == '[') {
      in_tables = true;
      in_effects = line.compare(0, 11, "[[effects]]") == 0;
      if (in_effects && !replaced) text += replacement;
      replaced = replaced || in_effects;
    }
    if (in_effects) continue;
    if (!in_tables && starts_with_key(line, "name")) {
      line = "name = " + quoted(name);
    } else if (!in_tables && starts_with_key(line, "source")) {
      line = "source = " + quoted(source);
    }
    text += line + "\n";
  }
  const Profile written = parse_profile(text, declared.path + " (calibrated)");
  if (!replaced || !same(written.effects, effects) || written.name != name) {
    throw Error(ErrorKind::kBadInput, declared.path,
                "its effects cannot be replaced; write each as an [[effects]] table of its own");
  }
  return text;
}

std::string calibrated_file_name(const Profile& declared) {
  std::string name = declared.name;
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return std::isalnum(c) != 0 ? static_cast<char>(std::tolower(c)) : '-';
  });
  return name + ".calibrated.toml";
}

}  // namespace binderjet
