// SPDX-License-Identifier: GPL-3.0-or-later
// The faults of tests/mutations can still be put in: who changes a line that one of them changes
// makes that patch again, for the table in tests/README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace binderjet::house {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string behind(const std::string& text, const std::string& word) {
  const std::size_t at = text.find("\n" + word);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + 1 + word.size();
  return text.substr(begin, text.find('\n', begin) - begin);
}

std::vector<fs::path> patches() {
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(BINDERJET_SOURCE_DIR "/tests/mutations")) {
    if (entry.path().extension() == ".patch") all.push_back(entry.path());
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(Mutations, AllApply) {
  ASSERT_GE(patches().size(), 30U);
  for (const fs::path& patch : patches()) {
    const std::string check =
        "cd '" BINDERJET_SOURCE_DIR "' && git apply --check '" + patch.string() + "'";
    EXPECT_EQ(std::system(check.c_str()), 0) << patch << " must be made again";
  }
}

TEST(Mutations, StandInTheTableWithTheirFileAndTheirFault) {
  const std::string table = text_of(BINDERJET_SOURCE_DIR "/tests/README.md");
  for (const fs::path& patch : patches()) {
    std::string text = text_of(patch);
    text.insert(0, 1, '\n');
    std::string row = "| ";
    for (const char* word : {"+++ b/", "Fault: "}) row += behind(text, word) + " | ";
    EXPECT_NE(table.find(row), std::string::npos) << patch << ": no line " << row;
  }
}

}  // namespace
}  // namespace binderjet::house
