// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse masks: nowhere worse than plain ones, within the rules, and the same however and wherever
// they are made.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "slicer/enhance/inverse/inverse_solver.h"
#include "slicer/enhance/inverse/search/layer_sets.h"
#include "slicer/enhance/masks.h"
#include "slicer/model/process_window.h"
#include "slicer/score/voxel_counts.h"
#include "tests/support/examples.h"
#include "tests/support/mask_regions.h"
#include "tests/support/random.h"
#include "tests/support/score_volumes.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

struct InverseCase {
  Grid grid;
  Volume target{0, 0, 0};
  MaskRules rules;
  std::vector<PrinterModel> window;
  int layers = 0;

  const PrinterModel& model() const { return window.front(); }
};

InverseCase random_inverse_case(Random& random, bool with_rules) {
  InverseCase c;
  c.grid = random.grid();
  c.layers = random.number(1, 5);
  c.target =
      random.volume(random.number(4, 14) * c.grid.detail_vx[0],
                    random.number(4, 14) * c.grid.detail_vx[1], c.layers * c.grid.detail_vx[2], 4);
  c.window = {random.model(c.grid, Random::Kernels::kAny)};
  if (with_rules) c.rules = {random.number(1, 5), random.number(1, 5)};
  return c;
}

Volume streamed_inverse(const InverseCase& c, LayerRange layers, int block) {
  const auto solver = std::make_shared<const InverseSolver>(c.window, c.grid, c.rules);
  const auto stream =
      inverse_masks(whole::voxel_layers(c.target, c.grid.detail_vx[2]), solver).layers(layers);
  std::vector<Shared<RunLayer>> masks;
  while (stream->rest().size() > 0) {
    for (const Shared<MaskLayer>& layer : stream->next(block)) {
      masks.emplace_back(layer, &layer->mask);
    }
  }
  return whole::stacked(masks);
}

// How many voxels of each layer come out wrong.
std::vector<std::int64_t> wrong(const InverseCase& c, const Volume& masks) {
  const Volume printed = whole::print(masks, c.model().form(), c.grid);
  const auto target =
      whole::voxel_stream(c.target, c.grid.detail_vx[2], {0, c.layers})->next(c.layers);
  std::vector<std::int64_t> out;
  for (int k = 0; k < c.layers; ++k) {
    const VoxelCounts counts =
        count_voxels(*target[static_cast<std::size_t>(k)], whole::slice(printed, k));
    out.push_back(counts.missing + counts.extra);
  }
  return out;
}

// The same by the streaming engine, for what the place on the bed does.
std::vector<std::int64_t> wrong_in_place(const InverseCase& c, const Volume& masks) {
  const PrinterModel& model = c.model();
  const auto target =
      whole::voxel_stream(c.target, c.grid.detail_vx[2], {0, c.layers})->next(c.layers);
  std::vector<Shared<RunLayer>> layers;
  for (int k = 0; k < c.layers; ++k) {
    layers.push_back(std::make_shared<const RunLayer>(whole::slice(masks, k)));
  }
  std::vector<std::int64_t> out;
  for (int k = 0; k < c.layers; ++k) {
    const VoxelCounts counts =
        count_voxels(*target[static_cast<std::size_t>(k)],
                     model.print(runs_around(layers, k, model.window_reach()), k));
    out.push_back(counts.missing + counts.extra);
  }
  return out;
}

std::int64_t sum(const std::vector<std::int64_t>& values) {
  return std::accumulate(values.begin(), values.end(), std::int64_t{0});
}

TEST(Inverse, NeverPrintsALayerWorseThanPlainMasks) {
  Random random;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const InverseCase c = random_inverse_case(random, false);
    const auto plain = wrong(c, whole::masks(c.target, c.grid));
    const auto inverse = wrong(c, streamed_inverse(c, {0, c.layers}, kBlockLayers));
    for (std::size_t k = 0; k < plain.size(); ++k) ASSERT_LE(inverse[k], plain[k]) << "layer " << k;
  }
}

// The distance of a voxel to the nearest of the other state in its slice, up to `most_mm`.
double depth_mm(const Volume& target, const Grid& grid, int x, int y, int z, double most_mm) {
  const auto steps = [&](int axis) { return static_cast<int>(most_mm / grid.voxel_mm(axis)) + 1; };
  double least = most_mm;
  for (int b = y - steps(1); b <= y + steps(1); ++b) {
    for (int a = x - steps(0); a <= x + steps(0); ++a) {
      if (target.at(a, b, z) == target.at(x, y, z)) continue;
      least = std::min(least, std::hypot((a - x) * grid.voxel_mm(0), (b - y) * grid.voxel_mm(1)));
    }
  }
  return least;
}

// Of the voxels of a layer that are wrong in a print, though all slices of their column agree: the
// deepest, and the deepest of those that are right in another print.
struct DeepestWrong {
  double of_all_mm = 0;
  double beside_other_mm = 0;
};
DeepestWrong deepest_wrong(const InverseCase& c, const Volume& printed, const Volume& other,
                           int layer) {
  constexpr double kMostMm = 0.5;
  DeepestWrong out;
  const int rz = c.grid.detail_vx[2];
  for (int y = 0; y < c.target.ny; ++y) {
    for (int x = 0; x < c.target.nx; ++x) {
      const int z = layer * rz;
      const int wanted = c.target.at(x, y, z);
      bool agree = true;
      for (int s = 1; s < rz; ++s) agree = agree && c.target.at(x, y, z + s) == wanted;
      if (!agree || printed.at(x, y, layer) == wanted) continue;
      double depth = kMostMm;
      for (int s = 0; s < rz; ++s) {
        depth = std::min(depth, depth_mm(c.target, c.grid, x, y, z + s, kMostMm));
      }
      out.of_all_mm = std::max(out.of_all_mm, depth);
      if (other.at(x, y, layer) == wanted) {
        out.beside_other_mm = std::max(out.beside_other_mm, depth);
      }
    }
  }
  return out;
}

void expect_no_deeper_than_plain(const InverseCase& c) {
  const Volume plain = whole::print(whole::masks(c.target, c.grid), c.model().form(), c.grid);
  const Volume inverse =
      whole::print(streamed_inverse(c, {0, c.layers}, kBlockLayers), c.model().form(), c.grid);
  for (int k = 0; k < c.layers; ++k) {
    SCOPED_TRACE(k);
    const DeepestWrong deepest = deepest_wrong(c, inverse, plain, k);
    const double plain_mm = deepest_wrong(c, plain, inverse, k).of_all_mm;
    ASSERT_LE(deepest.of_all_mm, std::max(0.1, plain_mm) + 1e-9);
    ASSERT_LE(deepest.beside_other_mm, 0.13);
  }
}

TEST(Inverse, IsNowhereWrongDeeperThanPlainMasks) {
  Random random;
  for (int round = 0; round < 30; ++round) {
    SCOPED_TRACE(round);
    expect_no_deeper_than_plain(random_inverse_case(random, false));
    if (testing::Test::HasFatalFailure()) return;
  }
}

// The pixels of a Z450 and parts of what it closes and loses: a solid with a slot, a wall and a pin
// of any width, turned.
TEST(Inverse, TakesNoBiteBesideAFineFeature) {
  Random random;
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    InverseCase c;
    c.grid = {{25.4 / 300, 25.4 / 450, 0.102}, {2, 2, 2}};
    c.layers = 2;
    c.target = Volume(96, 112, 4);
    const double angle = random.number(0, 90) * 3.14159 / 180;
    const double slot_mm = random.number(2, 8) * 0.05;
    const double wall_mm = random.number(2, 8) * 0.05;
    c.target.fill([&](int x, int y, int) {
      const double dx = (x - 48) * c.grid.voxel_mm(0);
      const double dy = (y - 56) * c.grid.voxel_mm(1);
      const double u = dx * std::cos(angle) + dy * std::sin(angle);
      const double v = dy * std::cos(angle) - dx * std::sin(angle);
      const bool inside = x >= 16 && y >= 12 && x < 80 && y < 100;
      // From left to right: solid, the slot, solid, powder, the wall.
      return inside && std::abs(v) < 1.2 &&
             ((u < 0.3 && std::abs(u + 0.4) > slot_mm / 2) || (u > 0.7 && u < 0.7 + wall_mm));
    });
    c.window = process_window({{"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.3}}}},
                               {"threshold", {}, {{"level", {random.chance(0.5) ? 0.5 : 0.25}}}}},
                              c.grid);
    c.rules = {4, 4};
    expect_no_deeper_than_plain(c);
    if (testing::Test::HasFatalFailure()) return;
  }
}

// A small relief with a slot, a pin and a step, in the middle of its box.
InverseCase in_place(Random& random, const EffectSpec& effect) {
  InverseCase c;
  c.grid = {{0.1, 0.08, 0.1}, {2, 2, 2}};
  c.layers = 6;
  c.target = Volume(80, 80, 12);
  const int slot = random.number(3, 8);
  const int pin = random.number(3, 8);
  c.target.fill([&](int x, int y, int z) {
    if (x < 20 || y < 20 || x >= 60 || y >= 60) return false;
    if (z < 6) return !(x >= 34 && x < 34 + slot && y >= 26 && y < 50);
    return x < 36 || (x >= 46 && x < 46 + pin && y >= 30 && y < 50);
  });
  const JobPlace place{{3, 5}, {4, 3.2}};
  c.window = {PrinterModel({{"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.5}}}},
                            {"threshold", {}, {{"level", {0.5}}}},
                            effect},
                           c.grid, place)};
  return c;
}

TEST(Inverse, AnswersEveryEffectAndPrintsNoLayerWorse) {
  Random random;
  std::int64_t all_plain = 0;
  std::int64_t all_inverse = 0;
  for (const EffectSpec& effect : whole::examples_beside_a_level()) {
    SCOPED_TRACE(effect.kind);
    const InverseCase c = in_place(random, effect);
    // What wears off is beyond the search.
    if (!c.model().form().wear.empty()) continue;
    const auto plain = wrong_in_place(c, whole::masks(c.target, c.grid));
    const auto inverse = wrong_in_place(c, streamed_inverse(c, {0, c.layers}, kBlockLayers));
    for (std::size_t k = 0; k < plain.size(); ++k) EXPECT_LE(inverse[k], plain[k]) << "layer " << k;
    std::cout << effect.kind << ": wrong voxels " << sum(plain) << " plain, " << sum(inverse)
              << " inverse\n";
    // Which drops are weak the search does not know; its judge does.
    if (effect.kind != "first_drops") {
      EXPECT_LT(sum(inverse), sum(plain));
    }
    all_plain += sum(plain);
    all_inverse += sum(inverse);
  }
  // Some of the random pins are beyond any mask.
  EXPECT_LT(2 * all_inverse, all_plain);
}

TEST(Inverse, KeepsToTheMaskRules) {
  Random random;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const InverseCase c = random_inverse_case(random, true);
    const Volume masks = streamed_inverse(c, {0, c.layers}, kBlockLayers);
    for (int k = 0; k < c.layers; ++k) {
      const MaskRegions found = whole::mask_regions(whole::slice(masks, k));
      ASSERT_GE(found.smallest_island_px, c.rules.min_island_px) << "layer " << k;
      ASSERT_GE(found.smallest_hole_px, c.rules.min_hole_px) << "layer " << k;
    }
  }
}

TEST(Inverse, GivesTheSameInPiecesBlocksAndWithOneThread) {
  Random random;
  for (int round = 0; round < 30; ++round) {
    SCOPED_TRACE(round);
    const InverseCase c = random_inverse_case(random, true);
    const Volume all = streamed_inverse(c, {0, c.layers}, kBlockLayers);
    const int first = random.number(0, c.layers - 1);
    const Volume piece = streamed_inverse(c, {first, c.layers}, 2);
    for (int k = first; k < c.layers; ++k) {
      ASSERT_EQ(whole::slice(piece, k - first), whole::slice(all, k));
    }
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    ASSERT_EQ(streamed_inverse(c, {0, c.layers}, random.number(1, 4)), all);
  }
}

// A slab with a slot, a pin and a step: what the binder closes, loses and rounds.
InverseCase relief(double level) {
  InverseCase c;
  c.grid = {{0.1, 0.1, 0.1}, {2, 2, 2}};
  c.layers = 6;
  c.target = Volume(120, 120, 12);
  c.target.fill([](int x, int y, int z) {
    if (x < 20 || y < 20 || x >= 100 || y >= 100) return false;
    if (z < 6) return !(x >= 40 && x < 44 && y >= 30 && y < 90);
    return x < 60 || (x >= 80 && x < 83 && y >= 40 && y < 80);
  });
  c.window = process_window({{"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.5}}}},
                             {"threshold", {}, {{"level", {level}}}}},
                            c.grid);
  return c;
}

TEST(Inverse, PrintsATenthOfThePlainErrorAtALowLevel) {
  const InverseCase c = relief(0.25);
  const auto plain = sum(wrong(c, whole::masks(c.target, c.grid)));
  const auto paper = sum(wrong(c, whole::paper_masks(c.target, c.model().form(), c.grid, 2)));
  const auto inverse = sum(wrong(c, streamed_inverse(c, {0, c.layers}, kBlockLayers)));
  std::cout << "wrong voxels: plain " << plain << ", paper " << paper << ", inverse " << inverse
            << '\n';
  EXPECT_LE(10 * inverse, plain);
  EXPECT_LE(4 * inverse, paper);
}

// A base with spires as narrow as a voxel at their tips and a thin wall that leans over: all
// narrower than the spread.
InverseCase spires(double level) {
  InverseCase c;
  c.grid = {{0.1, 0.1, 0.1}, {2, 2, 2}};
  c.layers = 12;
  c.target = Volume(120, 120, 24);
  c.target.fill([](int x, int y, int z) {
    if (z < 4) return x >= 20 && y >= 20 && x < 100 && y < 100;
    const int half = (26 - z) / 4;
    for (const int middle : {35, 55}) {
      if (std::abs(x - middle) <= half && std::abs(y - 40) <= half / 2) return true;
    }
    return x >= 40 + z && x < 43 + z && y >= 60 && y < 90;
  });
  c.window = process_window({{"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.5}}}},
                             {"threshold", {}, {{"level", {level}}}}},
                            c.grid);
  return c;
}

TEST(Inverse, PrintsWhatIsNarrowerThanTheSpreadAndInOnePiece) {
  for (const double level : {0.25, 0.5}) {
    SCOPED_TRACE(level);
    const InverseCase c = spires(level);
    const Volume masks = streamed_inverse(c, {0, c.layers}, kBlockLayers);
    const Volume printed = whole::print(masks, c.model().form(), c.grid);
    const JobScore score = whole::score(c.target, printed, c.grid).score;
    EXPECT_EQ(score.faults[FaultKind::kLoose], 0);
    EXPECT_EQ(score.faults[FaultKind::kLost], 0);
    EXPECT_EQ(score.faults[FaultKind::kFused], 0);
  }
}

// Leaning spires over several of the blocks in which layers are computed.
TEST(Inverse, GivesTheSameInPiecesOfATallJob) {
  InverseCase c;
  c.grid = {{0.1, 0.1, 0.1}, {2, 2, 2}};
  c.layers = 60;
  c.target = Volume(60, 40, 2 * c.layers);
  c.target.fill([](int x, int y, int z) {
    const int at = 6 + (z % 50) / 2;
    return y >= 10 && y < 13 && x >= at && x < at + 3 + (z / 7) % 2;
  });
  c.window = {PrinterModel({{"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.5}}}},
                            {"threshold", {}, {{"level", {0.4}}}}},
                           c.grid)};
  c.rules = {4, 4};
  const Volume all = streamed_inverse(c, {0, c.layers}, kBlockLayers);
  for (const LayerRange piece : {LayerRange{0, 9}, LayerRange{21, 40}, LayerRange{59, 60}}) {
    const Volume part = streamed_inverse(c, piece, 3);
    for (int k = piece.first; k < piece.last; ++k) {
      ASSERT_EQ(whole::slice(part, k - piece.first), whole::slice(all, k)) << "layer " << k;
    }
  }
}

// A cross section that the binder rounds, closes and loses, at (x, y), in voxels.
bool in_section(int x, int y) {
  const bool slab = x >= 0 && y >= 0 && x < 36 && y < 30;
  const bool slot = x >= 14 && x < 17 && y >= 6;
  const bool wall = x >= 42 && x < 45 && y >= 0 && y < 30;
  return (slab && !slot && x + y > 8) || wall;
}

InverseCase sections(int layers, const std::vector<std::array<int, 2>>& corners_px) {
  InverseCase c;
  c.grid = {{0.1, 0.08, 0.1}, {2, 2, 2}};
  c.layers = layers;
  c.target = Volume(200, 110, 2 * layers);
  c.target.fill([&](int x, int y, int) {
    return std::any_of(corners_px.begin(), corners_px.end(), [&](const auto& corner) {
      return in_section(x - 2 * corner[0], y - 2 * corner[1]);
    });
  });
  c.window = process_window({{"spread", {{"shape", "box"}}, {{"width_mm", {0.5, 0.4}}}},
                             {"threshold", {}, {{"level", {0.4}}}}},
                            c.grid);
  c.rules = {4, 4};
  return c;
}

std::int64_t pixels_apart(const RunLayer& a, const RunLayer& b) {
  return without(a, b).count() + without(b, a).count();
}

TEST(Inverse, GivesEqualCrossSectionsEqualMasks) {
  const auto masks_of = [](const InverseCase& c) {
    return streamed_inverse(c, {0, c.layers}, kBlockLayers);
  };
  const auto cut = [](const RunLayer& mask, const std::array<int, 2>& corner) {
    return window(mask, corner[0] - 9, corner[1] - 9, 42, 34);
  };
  const std::array<int, 2> here{10, 10};
  const std::array<int, 2> moved{17, 13};
  const std::array<int, 2> beside{62, 15};
  const InverseCase one = sections(5, {here});
  const Volume masks = masks_of(one);
  const RunLayer first = whole::slice(masks, 0);
  ASSERT_NE(first, whole::slice(whole::masks(one.target, one.grid), 0));
  for (int k = 1; k < one.layers; ++k) {
    EXPECT_EQ(pixels_apart(whole::slice(masks, k), first), 0) << "layer " << k;
  }
  // Moved by whole pixels.
  const RunLayer elsewhere = whole::slice(masks_of(sections(1, {moved})), 0);
  EXPECT_EQ(pixels_apart(cut(elsewhere, moved), cut(first, here)), 0);
  // Twice in one part.
  const RunLayer two = whole::slice(masks_of(sections(1, {here, beside})), 0);
  EXPECT_EQ(pixels_apart(cut(two, here), cut(first, here)), 0);
  EXPECT_EQ(pixels_apart(cut(two, beside), cut(first, here)), 0);
}

TEST(Inverse, OfALayerDoNotDependOnALayerFarAway) {
  InverseCase c = spires(0.25);
  ASSERT_EQ(c.model().window_reach(), 0);
  const Volume before = streamed_inverse(c, {0, c.layers}, kBlockLayers);
  const int far = c.layers - 2;
  c.target.fill([&, all = c.target](int x, int y, int z) {
    if (z / 2 == far) return x >= 30 && y >= 70 && x < 50 && y < 90;
    return all.at(x, y, z) == 1;
  });
  const Volume after = streamed_inverse(c, {0, c.layers}, kBlockLayers);
  EXPECT_NE(whole::slice(after, far), whole::slice(before, far));
  // Pieces and features are seen with the layers beside, four times over.
  for (int k = 0; k < far - 4; ++k) {
    EXPECT_EQ(whole::slice(after, k), whole::slice(before, k)) << "layer " << k;
  }
}

TEST(Inverse, AnswersBinderThatSoaksIntoTheLayersBelow) {
  // A calibrated profile's form: a share of each layer's binder reaches the two layers below.
  InverseCase c = relief(0.35);
  for (PrinterModel& model : c.window) {
    AssembledModel form = model.form();
    const DoseTerm own = form.terms.front();
    double share = 1;
    for (int layer = 1; layer <= 2; ++layer) {
      share *= 0.3;
      form.terms.push_back({layer, own.x, own.y, share});
    }
    model = PrinterModel(form, c.grid);
  }
  const auto plain = sum(wrong(c, whole::masks(c.target, c.grid)));
  const auto paper = sum(wrong(c, whole::paper_masks(c.target, c.model().form(), c.grid, 2)));
  const auto inverse = sum(wrong(c, streamed_inverse(c, {0, c.layers}, kBlockLayers)));
  std::cout << "wrong voxels: plain " << plain << ", paper " << paper << ", inverse " << inverse
            << '\n';
  EXPECT_LE(4 * inverse, plain);
  EXPECT_LE(2 * inverse, paper);
}

TEST(Inverse, IsBetterThanThePaperOverTheProcessWindow) {
  InverseCase c = relief(0.25);
  const Volume inverse = streamed_inverse(c, {0, c.layers}, kBlockLayers);
  const Volume paper = whole::paper_masks(c.target, c.model().form(), c.grid, 2);
  std::int64_t worst_inverse = 0;
  std::int64_t worst_paper = 0;
  for (const PrinterModel& model : c.window) {
    InverseCase corner = c;
    corner.window = {model};
    worst_inverse = std::max(worst_inverse, sum(wrong(corner, inverse)));
    worst_paper = std::max(worst_paper, sum(wrong(corner, paper)));
  }
  EXPECT_LT(worst_inverse, worst_paper);
}

}  // namespace
}  // namespace binderjet
