// SPDX-License-Identifier: GPL-3.0-or-later
// A job says how its masks were made by a word, and is read by that word.
#include "driver/job/enhancement.h"

#include <gtest/gtest.h>

#include "driver/job/job.h"
#include "slicer/base/error.h"

namespace binderjet {
namespace {

JobHeader header_of(Enhancement enhancement) {
  JobHeader header;
  header.profile = load_profile("z450");
  header.grid = header.profile.grid(std::nullopt);
  header.box.size_px = {1, 1, 1};
  header.sources.emplace_back();
  header.enhance = enhancement;
  return header;
}

TEST(Enhancement, IsReadBackFromTheHeaderThatNamesIt) {
  for (const Enhancement each : kEnhancements) {
    const std::string text = to_text(header_of(each));
    EXPECT_NE(text.find("\"enhance\":\"" + std::string(word(each)) + "\""), std::string::npos);
    EXPECT_EQ(parse_job_header(text, "job").enhance, each);
  }
}

TEST(Enhancement, OfANameThatNobodyKnowsIsNotRead) {
  std::string text = to_text(header_of(Enhancement::kPaper));
  text.replace(text.find("\"paper\""), 7, "\"magic\"");
  EXPECT_THROW(parse_job_header(text, "job"), Error);
  EXPECT_FALSE(enhancement_of("").has_value());
}

}  // namespace
}  // namespace binderjet
