// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/mesh/read/materials.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "slicer/mesh/read/input_file.h"

namespace binderjet {
namespace {

std::string trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) {
    text.remove_prefix(1);
  }
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) {
    text.remove_suffix(1);
  }
  return std::string(text);
}

// Skips "-s 1 1 1", "-bm 0.2" and their like; each takes words up to its most.
std::string image_name(Words words) {
  constexpr std::array<std::pair<std::string_view, int>, 12> kOptions = {{{"-s", 3},
                                                                          {"-o", 3},
                                                                          {"-t", 3},
                                                                          {"-mm", 2},
                                                                          {"-bm", 1},
                                                                          {"-clamp", 1},
                                                                          {"-blendu", 1},
                                                                          {"-blendv", 1},
                                                                          {"-boost", 1},
                                                                          {"-texres", 1},
                                                                          {"-imfchan", 1},
                                                                          {"-type", 1}}};
  while (true) {
    Words ahead = words;
    const std::string_view word = ahead.next();
    const auto option = std::find_if(kOptions.begin(), kOptions.end(),
                                     [&](const auto& known) { return known.first == word; });
    if (option == kOptions.end()) return trimmed(words.rest());
    double number = 0;
    words = ahead;
    for (int i = 0; i < option->second; ++i) {
      ahead.next();
      // -s, -o and -t take one to three numbers.
      Words probe = words;
      if (option->second == 3 && !parse_number(probe.next(), number)) break;
      words = ahead;
    }
  }
}

}  // namespace

void read_materials(const std::string& path, std::map<std::string, Material>& materials) {
  InputFile file(path);
  std::string_view text;
  Material* current = nullptr;
  while (file.line(text)) {
    Words words(text);
    const std::string_view keyword = words.next();
    if (keyword == "newmtl") {
      current = &materials[trimmed(words.rest())];
    } else if (current != nullptr && keyword == "Kd") {
      std::array<double, 3> kd{};
      bool good = true;
      for (double& value : kd) good = good && parse_number(words.next(), value);
      if (good) current->color = rgb_of(kd[0], kd[1], kd[2]);
    } else if (current != nullptr && keyword == "map_Kd") {
      current->image = image_name(words);
    }
  }
}

}  // namespace binderjet
