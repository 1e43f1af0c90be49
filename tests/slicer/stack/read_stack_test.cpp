// SPDX-License-Identifier: GPL-3.0-or-later
// stack.json is believed only as far as its numbers make sense.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "slicer/base/error.h"
#include "slicer/stack/slice_stack.h"
#include "tests/slicer/color/colored_layers.h"

namespace binderjet {
namespace {

std::string refusal(
    const std::string& size, const std::string& first = "0",
    const std::string& place = R"("pitch_mm": [0.1, 0.1, 0.1], "origin_mm": [0, 0, 0])",
    const std::string& files = "m_%d.png") {
  const colored::Folder folder;
  std::ofstream(folder.file("stack.json"))
      << R"({"format": "slice-stack", "version": 1, "kind": "mask", "size": )" << size << ", "
      << place << R"(, "files": ")" << files << R"(", "first": )" << first << "}";
  try {
    const StackReader stack(std::filesystem::path(folder.file("stack.json")).parent_path());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ReadStack, TakesNoSizeThatIsNoWholeNumber) {
  using testing::HasSubstr;
  EXPECT_THAT(refusal("[3e43, 2, 1]"), HasSubstr("3e+43 where a whole number belongs"));
  EXPECT_THAT(refusal("[4294967297, 2, 1]"), HasSubstr("4294967297 where a whole number"));
  EXPECT_THAT(refusal("[18446744073709551615, 2, 1]"), HasSubstr("where a whole number belongs"));
  EXPECT_THAT(refusal("[-4294967295, 2, 1]"), HasSubstr("-4294967295 where a whole number"));
  EXPECT_THAT(refusal("[2.5, 2, 1]"), HasSubstr("2.5 where a whole number belongs"));
  EXPECT_THAT(refusal("[true, 2, 1]"), HasSubstr("true where a whole number belongs"));
  EXPECT_THAT(refusal("[2, 2]"), HasSubstr("where 3 whole numbers belong"));
  EXPECT_THAT(refusal("[2, 2, 1, 5]"), HasSubstr("where 3 whole numbers belong"));
  EXPECT_THAT(refusal("[2, 2, 0]"), HasSubstr("outside 1 to 2^20"));
  EXPECT_THAT(refusal("[2, 2, 2]", "2147483647"), HasSubstr("outside 0 to 2^30"));
  EXPECT_THAT(refusal("[2, 2, 1]"), HasSubstr("m_0.png: is missing")) << "else it is read";
}

TEST(ReadStack, TakesNoPlaceNoAreaAndNoNameThatNobodyMeans) {
  using testing::HasSubstr;
  const auto at = [](const std::string& pitch, const std::string& origin) {
    return R"("pitch_mm": [)" + pitch + R"(, 0.1, 0.1], "origin_mm": [)" + origin + ", 0, 0]";
  };
  EXPECT_THAT(refusal("[2, 2, 1]", "0", at("1e-6", "0")), HasSubstr("a pitch outside"));
  EXPECT_THAT(refusal("[2, 2, 1]", "0", at("0.1", "1e308")), HasSubstr("a kilometer away"));
  EXPECT_THAT(refusal("[2, 2, 1]", "0", at("0.1", "-3e6")), HasSubstr("a kilometer away"));
  EXPECT_THAT(refusal("[60000, 60000, 1]"), HasSubstr("more than 2^28"));
  EXPECT_THAT(refusal("[2, 2, 1]", "0", at("0.1", "0"), "m_%d\\u0000.png"),
              HasSubstr("needs one %d"));
}

}  // namespace
}  // namespace binderjet
