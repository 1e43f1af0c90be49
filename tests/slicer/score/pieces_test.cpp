// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that come out in several pieces, and pieces of several parts.
#include "slicer/score/pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

PieceFinder found(const Volume& target, const Volume& printed, int rz) {
  PieceFinder finder(rz, 0, Contacts::kFind);
  const auto layers = whole::voxel_stream(target, rz, {0, printed.nz})->next(printed.nz);
  for (int k = 0; k < printed.nz; ++k) {
    finder.add(*layers[static_cast<std::size_t>(k)], whole::slice(printed, k));
  }
  return finder;
}

// Parts in more than one piece.
std::int64_t parts_in_pieces(const Volume& target, const Volume& printed, int rz) {
  const auto by_part = found(target, printed, rz).pieces_by_part();
  return std::count_if(by_part.begin(), by_part.end(),
                       [](const auto& part) { return part.second.size() > 1; });
}

// The region of each voxel by flooding; 0 is powder.
std::vector<int> flooded(const Volume& v) {
  std::vector<int> region(v.bits.size(), 0);
  int count = 0;
  for (int z = 0; z < v.nz; ++z)
    for (int y = 0; y < v.ny; ++y)
      for (int x = 0; x < v.nx; ++x) {
        if (v.at(x, y, z) == 0 || region[v.place(x, y, z)] != 0) continue;
        region[v.place(x, y, z)] = ++count;
        std::vector<std::array<int, 3>> found{{x, y, z}};
        for (std::size_t next = 0; next < found.size(); ++next) {
          for (const auto& d : whole::kFaces) {
            const auto [a, b, c] = found[next];
            if (v.at(a + d[0], b + d[1], c + d[2]) == 0) continue;
            int& beside = region[v.place(a + d[0], b + d[1], c + d[2])];
            if (beside != 0) continue;
            beside = count;
            found.push_back({a + d[0], b + d[1], c + d[2]});
          }
        }
      }
  return region;
}

TEST(Pieces, ABarWithAGapInItsPrintComesOutInTwo) {
  Volume bar(20, 3, 2);
  bar.fill([](int x, int, int) { return x >= 2 && x < 18; });
  Volume broken(20, 3, 1);
  broken.fill([](int x, int, int) { return x >= 3 && x < 17 && x != 9; });
  EXPECT_EQ(parts_in_pieces(bar, bar, 1), 0);
  EXPECT_EQ(parts_in_pieces(bar, broken, 2), 1);
}

TEST(Pieces, TwoLegsThatMeetAboveAreOnePart) {
  // Printed without its bridge the part is two.
  Volume arch(9, 1, 4);
  arch.fill([](int x, int, int z) { return z >= 2 || x < 3 || x >= 6; });
  Volume legs(9, 1, 4);
  legs.fill([](int x, int, int) { return x < 3 || x >= 6; });
  EXPECT_EQ(parts_in_pieces(arch, arch, 1), 0);
  EXPECT_EQ(parts_in_pieces(arch, legs, 1), 1);
}

TEST(Pieces, TheLesserPieceOfABrokenBarIsLoose) {
  Volume bar(20, 3, 2);
  bar.fill([](int x, int, int) { return x >= 2 && x < 18; });
  Volume broken(20, 3, 1);
  broken.fill([](int x, int, int) { return x >= 3 && x < 17 && x != 9; });
  const std::vector<Region> loose = found(bar, broken, 2).loose();
  ASSERT_EQ(loose.size(), 1);
  EXPECT_EQ(loose[0].low, (std::array{3, 0, 0}));
  EXPECT_EQ(loose[0].high, (std::array{9, 3, 2}));  // 2 slices
  EXPECT_EQ(loose[0].voxels, 6 * 3 * 2);
}

TEST(Pieces, WhatMayGoOnElsewhereIsNotLooseAndWhatComesOffItIs) {
  Volume bar(20, 1, 1);
  bar.fill([](int, int, int) { return true; });
  Volume broken(20, 1, 1);
  broken.fill([](int x, int, int) { return x < 2 || (x >= 3 && x < 17) || x >= 18; });
  PieceFinder finder = found(bar, broken, 1);
  EXPECT_EQ(finder.loose().size(), 2);
  const auto at_the_end = [](const Region& region) {
    return region.low[0] == 0 || region.high[0] == 20;
  };
  const std::vector<Region> loose = finder.loose(at_the_end);
  ASSERT_EQ(loose.size(), 1);
  EXPECT_EQ(loose[0].low[0], 3);
}

TEST(Pieces, ABridgeBetweenTwoPartsJoinsThemAlongEachAxis) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    SCOPED_TRACE(axis);
    // Two bars of 4 x 4 along the axis, 3 apart; the print fills 2 x 2 of the gap.
    std::array<int, 3> size{4, 4, 4};
    size[axis] = 11;
    Volume bars(size[0], size[1], size[2]);
    bars.fill([&](int x, int y, int z) {
      const int along = std::array{x, y, z}[axis];
      return along < 4 || along >= 7;
    });
    Volume bridged(size[0], size[1], size[2]);
    bridged.fill([&](int x, int y, int z) {
      std::array<int, 3> at{x, y, z};
      const bool solid = at[axis] < 4 || at[axis] >= 7;
      at[axis] = 1;
      return solid || std::all_of(at.begin(), at.end(), [](int v) { return v == 1 || v == 2; });
    });
    EXPECT_TRUE(found(bars, bars, 1).joined().empty());
    const std::vector<Region> bridges = found(bars, bridged, 1).joined();
    ASSERT_EQ(bridges.size(), 1);
    std::array<int, 3> low{1, 1, 1};
    std::array<int, 3> high{3, 3, 3};
    low[axis] = 4;
    high[axis] = 7;
    EXPECT_EQ(bridges[0].low, low);
    EXPECT_EQ(bridges[0].high, high);
    EXPECT_EQ(bridges[0].voxels, 2 * 2 * 3);
  }
}

TEST(Pieces, ThatMeetRoundACornerAreJoinedByTheWholePiece) {
  Volume parts(8, 8, 1);
  parts.fill([](int x, int y, int) { return (x < 2 && y < 2) || (x >= 6 && y >= 6); });
  Volume printed(8, 8, 1);
  printed.fill([](int x, int y, int) { return x < 2 || y >= 6; });
  const std::vector<Region> bridges = found(parts, printed, 1).joined();
  ASSERT_EQ(bridges.size(), 1);
  EXPECT_EQ(bridges[0].voxels, 2 * 8 + 2 * 6);
}

// Parts are joined exactly where a flood of the print finds two parts in one piece.
TEST(Pieces, AreJoinedWhereverAPieceHasTwoParts) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const Volume target = random.volume(random.number(1, 12), random.number(1, 12), 4);
    const Volume printed = random.volume(target.nx, target.ny, 4);
    const std::vector<int> parts = flooded(target);
    const std::vector<int> pieces = flooded(printed);
    std::map<int, std::set<int>> parts_of;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (parts[i] != 0 && pieces[i] != 0) parts_of[pieces[i]].insert(parts[i]);
    }
    bool expected = false;
    for (const auto& [piece, all] : parts_of) expected |= all.size() > 1;
    ASSERT_EQ(!found(target, printed, 1).joined().empty(), expected);
  }
}

TEST(Pieces, AreThoseOfAFlood) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const int rz = random.number(1, 2);
    const int layers = random.number(1, 5);
    const Volume target = random.volume(random.number(1, 12), random.number(1, 12), layers * rz);
    const Volume printed = random.volume(target.nx, target.ny, layers);
    Volume slices(target.nx, target.ny, layers * rz);
    slices.fill([&](int x, int y, int z) { return printed.at(x, y, z / rz) == 1; });
    const std::vector<int> parts = flooded(target);
    const std::vector<int> pieces = flooded(slices);
    std::map<int, std::set<int>> of;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (parts[i] != 0 && pieces[i] != 0) of[parts[i]].insert(pieces[i]);
    }
    std::int64_t expected = 0;
    for (const auto& [part, all] : of) expected += all.size() > 1 ? 1 : 0;
    ASSERT_EQ(parts_in_pieces(target, printed, rz), expected);
  }
}

}  // namespace
}  // namespace binderjet
