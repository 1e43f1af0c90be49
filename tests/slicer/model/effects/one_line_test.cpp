// SPDX-License-Identifier: GPL-3.0-or-later
// What adding an effect costs, counted in the sources: its own file and one line of the catalogue.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "slicer/model/effects/catalogue.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

const std::string kEffects = "slicer/model/effects/";

// The sources of slicer/ and driver/ by path from the root of the tree.
std::map<std::string, std::string> sources() {
  const fs::path root(BINDERJET_SOURCE_DIR);
  std::map<std::string, std::string> out;
  for (const char* folder : {"slicer", "driver"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      out[fs::relative(entry.path(), root).generic_string()] = text.str();
    }
  }
  return out;
}

// Without what is said about the code.
std::string without_comments(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t comment = line.find("//");
    // An address in a string is no comment.
    const bool is_comment =
        comment != std::string::npos && (comment == 0 || line[comment - 1] != ':');
    out += (is_comment ? line.substr(0, comment) : line) + "\n";
  }
  return out;
}

std::set<std::string> files_with(const std::map<std::string, std::string>& files,
                                 const std::string& word) {
  std::set<std::string> out;
  for (const auto& [path, text] : files) {
    if (text.find(word) != std::string::npos) out.insert(path);
  }
  return out;
}

// Words in quotes that name something else in the program too, and where. All other words of
// effects and of their parameters stand in the files of effects alone.
const std::map<std::string, std::set<std::string>> kOtherMeanings = {
    // the cut of a scan's gray values (stack.json)
    {"threshold", {"slicer/stack/read_stack.cpp", "driver/manual/keys.cpp"}},
    // what a dependence may be on
    {"density",
     {"slicer/calibrate/residual/residual_by_axis.cpp", kEffects + "covariate.cpp",
      kEffects + "empirical.cpp", kEffects + "empirical_scan.cpp"}},
};

TEST(AddingAnEffect, CostsItsFileAndOneLineOfTheCatalogue) {
  std::map<std::string, std::string> files = sources();
  ASSERT_GT(files.size(), 100U);
  for (auto& [path, text] : files) text = without_comments(text);
  const std::string& catalogue = files.at(kEffects + "catalogue.cpp");
  for (const EffectKind& kind : effect_kinds()) {
    SCOPED_TRACE(kind.name);
    // In quotes, for some names are words of the language of the trade.
    std::set<std::string> found = files_with(files, '"' + kind.name + '"');
    EXPECT_EQ(found.erase(kEffects + kind.name + ".cpp"), 1U) << "its own file";
    const auto known = kOtherMeanings.find(kind.name);
    if (known != kOtherMeanings.end()) {
      for (const std::string& path : known->second) found.erase(path);
    }
    EXPECT_EQ(found, std::set<std::string>{});
    // The macro's line, and the function that it declares in the effect's own file.
    const std::regex line("^ *EFFECT\\(" + kind.name + "\\)", std::regex::multiline);
    EXPECT_EQ(std::distance(std::sregex_iterator(catalogue.begin(), catalogue.end(), line),
                            std::sregex_iterator()),
              1);
    EXPECT_EQ(files_with(files, kind.name + "_effect("),
              std::set<std::string>{kEffects + kind.name + ".cpp"});
    EXPECT_FALSE(files.contains(kEffects + kind.name + ".h")) << "an effect needs no header";
  }
}

// Parameters with a word that is no common one: no list of them may stand outside the effects.
TEST(AddingAnEffect, LeavesTheNamesOfItsParametersInItsFile) {
  std::map<std::string, std::string> files = sources();
  for (auto& [path, text] : files) text = without_comments(text);
  // Keys of JSON and tables of a profile that mean something else there.
  const std::set<std::string> common = {
      "level",  "amount", "from", "to",    "at",    "by",    "wave",   "width", "period",  "at_mm",
      "layers", "axis",   "form", "shape", "after", "share", "across", "acts",  "strength"};
  std::set<std::string> names;
  for (const EffectKind& kind : effect_kinds()) {
    for (const NumberRule& rule : kind.numbers) names.insert(rule.name);
    for (const WordRule& rule : kind.words) names.insert(rule.name);
  }
  for (const std::string& name : names) {
    if (common.contains(name)) continue;
    for (const std::string& path : files_with(files, '"' + name + '"')) {
      EXPECT_EQ(path.rfind(kEffects, 0), 0U) << name << " stands in " << path;
    }
  }
}

}  // namespace
}  // namespace binderjet
