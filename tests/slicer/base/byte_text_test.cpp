// SPDX-License-Identifier: GPL-3.0-or-later
// Names that are not UTF-8 keep their bytes, and no byte commands a terminal.
#include "slicer/base/byte_text.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace binderjet {
namespace {

TEST(ByteText, LeavesUtf8AsItIs) {
  for (const char* text : {"", "größe.obj", "部品 1.stl", "\U0001F600", "a\\b", "line\nend"}) {
    EXPECT_EQ(escape_bytes(text), text);
    EXPECT_EQ(visible(text), text);
  }
}

TEST(ByteText, WritesOtherBytesByTheirNumber) {
  EXPECT_EQ(escape_bytes("gr\xf6\xdf"
                         "e.obj"),
            "gr\\xf6\\xdfe.obj");
  EXPECT_EQ(escape_bytes("\xc3"), "\\xc3") << "half a character";
  EXPECT_EQ(escape_bytes("\xc0\xaf"), "\\xc0\\xaf") << "overlong";
  EXPECT_EQ(escape_bytes("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(escape_bytes("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "above U+10FFFF";
  EXPECT_EQ(escape_bytes("a\\x41"), "a\\x5cx41") << "or it would come back as aA";
}

RC_GTEST_PROP(ByteText, BringsEveryNameBackThroughJson, (const std::string& bytes)) {
  const std::string escaped = escape_bytes(bytes);
  RC_ASSERT(unescape_bytes(escaped) == bytes);
  RC_ASSERT(nlohmann::json::parse(nlohmann::json(escaped).dump()) == escaped);
}

TEST(ByteText, ShowsWhatATerminalWouldObey) {
  EXPECT_EQ(visible("\x1b]0;title\x07"), "\\x1b]0;title\\x07");
  EXPECT_EQ(visible("a\rb\x7f"), "a\\x0db\\x7f");
  EXPECT_EQ(visible("\xc2\x9b"
                    "31m"),
            "\\xc2\\x9b31m")
      << "CSI as one character of C1";
  EXPECT_EQ(visible_line("two\nlines"), "two\\x0alines");
}

RC_GTEST_PROP(ByteText, LeavesNothingToObey, (const std::string& bytes)) {
  for (const char c : visible_line(bytes)) {
    RC_ASSERT(static_cast<unsigned char>(c) >= 0x20);
    RC_ASSERT(c != '\x7f');
  }
  RC_ASSERT(visible_line(visible_line(bytes)) == visible_line(bytes));
}

}  // namespace
}  // namespace binderjet
