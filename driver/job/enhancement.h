// SPDX-License-Identifier: GPL-3.0-or-later
// How a job's masks answer the printer's blur: by its word on the command line and in files.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace binderjet {

enum class Enhancement {
  kNone,    // the target as it is
  kPaper,   // the paper's rule (slicer/MODEL.md, The paper's rule)
  kInverse  // searched on the printer model
};
inline constexpr std::array kEnhancements{Enhancement::kNone, Enhancement::kPaper,
                                          Enhancement::kInverse};
const char* word(Enhancement enhancement);
// The words of all, and the one of a word.
std::vector<std::string> enhancement_words();
std::optional<Enhancement> enhancement_of(const std::string& text);

}  // namespace binderjet
