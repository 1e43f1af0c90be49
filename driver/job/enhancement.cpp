// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/enhancement.h"

namespace binderjet {

const char* word(Enhancement enhancement) {
  switch (enhancement) {
    case Enhancement::kNone:
      return "none";
    case Enhancement::kPaper:
      return "paper";
    case Enhancement::kInverse:
      break;
  }
  return "inverse";
}

std::vector<std::string> enhancement_words() {
  std::vector<std::string> words;
  for (const Enhancement each : kEnhancements) words.emplace_back(word(each));
  return words;
}

std::optional<Enhancement> enhancement_of(const std::string& text) {
  for (const Enhancement each : kEnhancements) {
    if (text == word(each)) return each;
  }
  return std::nullopt;
}

}  // namespace binderjet
