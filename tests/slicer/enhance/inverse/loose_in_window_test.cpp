// SPDX-License-Identifier: GPL-3.0-or-later
// Loose pieces, and where a bridge to them could be.
#include "slicer/enhance/inverse/loose_in_window.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "tests/support/rows.h"

namespace binderjet {
namespace {

constexpr int kWidth = 20;

ComparedLayer layer_of(const RunLayer& target, const RunLayer& printed) {
  return {std::make_shared<const VoxelLayer>(VoxelLayer{{target, target}}),
          std::make_shared<const RunLayer>(printed)};
}

LooseInWindow found(const ComparedLayer* below, const ComparedLayer& layer,
                    const ComparedLayer* above) {
  const std::array<const ComparedLayer*, 3> window{below, &layer, above};
  return find_loose_in_window(window);
}

const RunLayer kNothing = RunLayer::powder(kWidth, 3);

TEST(LooseInWindow, ALineThatPrintsInTwoPiecesHasOneAndAGapToBridge) {
  const ComparedLayer line =
      layer_of(rows_of(kWidth, {{}, {2, 18}, {}}), rows_of(kWidth, {{}, {2, 9, 11, 14}, {}}));
  const LooseInWindow pieces = found(nullptr, line, nullptr);
  EXPECT_EQ(pieces.count, 1);
  EXPECT_EQ(pieces.loose, rows_of(kWidth, {{}, {11, 14}, {}}));
  // What is missing near the smaller piece.
  EXPECT_EQ(pieces.gap, rows_of(kWidth, {{}, {9, 11, 14, 18}, {}}));
}

TEST(LooseInWindow, APieceHeldByTheLayerAboveIsNone) {
  const RunLayer whole = rows_of(kWidth, {{}, {2, 18}, {}});
  const ComparedLayer line = layer_of(whole, rows_of(kWidth, {{}, {2, 9, 11, 14}, {}}));
  const ComparedLayer above = layer_of(whole, whole);
  const LooseInWindow pieces = found(nullptr, line, &above);
  EXPECT_EQ(pieces.count, 0);
  EXPECT_EQ(pieces.loose, kNothing);
  EXPECT_EQ(pieces.gap, kNothing);
}

TEST(LooseInWindow, ALayerThatDoesNotPrintHasTheGap) {
  const RunLayer pin = rows_of(kWidth, {{}, {4, 8}, {}});
  const ComparedLayer below = layer_of(pin, pin);
  const ComparedLayer above = layer_of(pin, rows_of(kWidth, {{}, {4, 7}, {}}));
  const LooseInWindow pieces = found(&below, layer_of(pin, kNothing), &above);
  EXPECT_EQ(pieces.count, 1);
  EXPECT_EQ(pieces.loose, kNothing);
  EXPECT_EQ(pieces.gap, pin);
}

TEST(LooseInWindow, TwoPartsAreNoneWhetherTheyPrintApartOrTogether) {
  const RunLayer parts = rows_of(kWidth, {{}, {2, 6, 10, 14}, {}});
  EXPECT_EQ(found(nullptr, layer_of(parts, parts), nullptr).count, 0);
  EXPECT_EQ(found(nullptr, layer_of(parts, rows_of(kWidth, {{}, {2, 14}, {}})), nullptr).count, 0);
}

}  // namespace
}  // namespace binderjet
