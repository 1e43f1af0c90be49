// SPDX-License-Identifier: GPL-3.0-or-later
// Equal sections are searched once.
#include "slicer/enhance/inverse/section_memo.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

#include "tests/support/rows.h"

namespace binderjet {
namespace {

Shared<VoxelLayer> section(int width) {
  return std::make_shared<const VoxelLayer>(VoxelLayer{{rows_of(20, {{0, width}})}});
}

TEST(SectionMemo, SearchesASectionOnceAndAnotherByItself) {
  SectionMemo memo;
  int searches = 0;
  const auto search = [&] {
    return std::make_shared<const RunLayer>(rows_of(20, {{0, ++searches}}));
  };
  // Equal sections of other layers.
  EXPECT_EQ(*memo.mask_of(section(5), search), rows_of(20, {{0, 1}}));
  EXPECT_EQ(*memo.mask_of(section(5), search), rows_of(20, {{0, 1}}));
  EXPECT_EQ(*memo.mask_of(section(6), search), rows_of(20, {{0, 2}}));
  EXPECT_EQ(*memo.mask_of(section(5), search), rows_of(20, {{0, 1}}));
  EXPECT_EQ(searches, 2);
}

TEST(SectionMemo, ForgetsWhatASearchThrew) {
  SectionMemo memo;
  const auto fails = []() -> Shared<RunLayer> { throw std::runtime_error("stopped"); };
  EXPECT_THROW(memo.mask_of(section(5), fails), std::runtime_error);
  const auto found = std::make_shared<const RunLayer>(rows_of(20, {{1, 2}}));
  EXPECT_EQ(memo.mask_of(section(5), [&] { return found; }), found);
}

}  // namespace
}  // namespace binderjet
