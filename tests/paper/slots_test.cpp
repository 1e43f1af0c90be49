// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's Fig. 3: a block with slots of 0.1 to 1.0 mm, printed in three orientations, and the
// first slot that can be seen: measured by the paper, predicted by the model that it declares.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <iostream>

#include "driver/profile/profile.h"
#include "slicer/enhance/masks.h"
#include "tests/support/models.h"

namespace binderjet {
namespace {

constexpr int kSlots = 10;
constexpr double kWall = 2;
constexpr double kDepth = 4;  // of the slots; the block is as wide
constexpr double kBase = 1;   // what holds the walls together
constexpr int kPhases = 8;

double slot_mm(int slot) { return 0.1 * (slot + 1); }
double slot_begin(int slot, double shift) {
  double at = shift + kWall;
  for (int i = 0; i < slot; ++i) at += slot_mm(i) + kWall;
  return at;
}

// The block with its slots across `axis`; `shift` moves the slots against the printer's grid.
std::shared_ptr<const Mesh> slotted_block(int axis, double shift) {
  const auto turned = [axis](double along, double across, double up) -> Point {
    if (axis == 0) return {along, across, up};
    if (axis == 1) return {across, along, up};
    return {across, up, along};
  };
  const double length = slot_begin(kSlots, shift);
  Mesh mesh = models::box(turned(0, 0, 0), turned(length, kDepth, kBase));
  for (int wall = 0; wall <= kSlots; ++wall) {
    const double begin = wall == 0 ? 0 : slot_begin(wall - 1, shift) + slot_mm(wall - 1);
    const double end = wall == kSlots ? length : slot_begin(wall, shift);
    mesh = models::joined(std::move(mesh),
                          models::box(turned(begin, 0, 0), turned(end, kDepth, kBase + kDepth)));
  }
  return std::make_shared<const Mesh>(std::move(mesh));
}

// The printed layers of a mesh.
std::vector<RunLayer> printed_layers(const std::shared_ptr<const Mesh>& mesh, const Grid& grid,
                                     const PrinterModel& model, JobBox& box) {
  box = job_box(bounding_box(*mesh).max, grid, {0, 0}, model.reach().xy_vx);
  const auto masks = plain_masks(voxel_layers(mesh, grid, box), grid).all_layers();
  std::vector<RunLayer> out;
  while (masks->rest().size() > 0) {
    for (const auto& layer : masks->next(kBlockLayers)) out.push_back(model.print(layer->mask));
  }
  return out;
}

// The width of the first slot from which on one can look through them all; 1.1 if there is none.
double first_visible(int axis, double shift, const Grid& grid, const PrinterModel& model) {
  JobBox box;
  const auto layers = printed_layers(slotted_block(axis, shift), grid, model, box);
  const auto printed_at = [&](double along, double across, double up) {
    const double x = axis == 0 ? along : across;
    const double y = axis == 0 ? across : axis == 1 ? along : up;
    const double z = axis == 2 ? along : up;
    const auto layer = static_cast<std::size_t>(z / grid.pitch_mm[2]);
    const auto voxel = [&](double mm, int a) {
      return static_cast<int>(mm / grid.voxel_mm(a)) +
             box.margin_px[static_cast<std::size_t>(a)] *
                 grid.detail_vx[static_cast<std::size_t>(a)];
    };
    return layers[layer].at(voxel(x, 0), voxel(y, 1));
  };
  double first = slot_mm(kSlots);
  for (int slot = kSlots - 1; slot >= 0; --slot) {
    bool open = false;
    // Closer than any voxel, and only well within the slot's own place.
    for (double at = 0.002; at < slot_mm(slot); at += 0.005) {
      open = open || !printed_at(slot_begin(slot, shift) + at, kDepth / 2, kBase + kDepth / 2);
    }
    if (!open) break;
    first = slot_mm(slot);
  }
  return first;
}

struct Range {
  double low = 10;
  double high = 0;
  std::string text() const {
    return low + 0.05 < high ? fmt::format("{:.1f} to {:.1f}", low, high)
                             : fmt::format("{:.1f}", low);
  }
};
// Over all places of the slots within a printer pixel.
Range predicted(int axis, const Grid& grid, const PrinterModel& model) {
  Range range;
  for (int phase = 0; phase < kPhases; ++phase) {
    const double shift = grid.pitch_mm[static_cast<std::size_t>(axis)] * (phase + 0.25) / kPhases;
    const double first = first_visible(axis, shift, grid, model);
    range.low = std::min(range.low, first);
    range.high = std::max(range.high, first);
  }
  return range;
}

PrinterModel at_level(const Profile& profile, const Grid& grid, double level) {
  std::vector<EffectSpec> effects = profile.effects;
  for (EffectSpec& effect : effects) {
    if (effect.kind == "threshold") effect.numbers["level"] = {level};
  }
  return {effects, grid};
}

// "we can only appreciate holes of thickness equal or bigger than 0.6-0.7mm ... equal or bigger
// than 0.3mm ... even if the resolution in z is 0.1mm, we can appreciate all the holes"
constexpr Range kMeasured[3] = {{0.6, 0.7}, {0.3, 0.3}, {0.1, 0.1}};

TEST(PaperSlots, DoNotAgreeWithTheDeclaredModelAtHalfAndDoAtAQuarter) {
  const Profile profile = load_profile("z450");
  const Grid grid = profile.grid(std::nullopt);
  std::cout
      << "first visible slot, mm     paper's print   level 0.5    misfit         level 0.25\n";
  for (int axis = 0; axis < 3; ++axis) {
    const Range measured = kMeasured[axis];
    const Range half = predicted(axis, grid, PrinterModel(profile.effects, grid));
    const Range quarter = predicted(axis, grid, at_level(profile, grid, 0.25));
    std::cout << fmt::format("slots across {}             {:<15} {:<12} {:<14} {}\n", "xyz"[axis],
                             measured.text(), half.text(),
                             Range{measured.low - half.high, measured.high - half.low}.text(),
                             quarter.text());
    // The misfit, as it stands: the model sees slots in x and y that the print had closed. Across z
    // a slot of 0.1 mm is less than a layer, and where it lies decides; at a quarter all else fits.
    const Range expected[3] = {{0.4, 0.5}, {0.2, 0.2}, {0.1, 0.2}};
    EXPECT_NEAR(half.low, expected[axis].low, 1e-9);
    EXPECT_NEAR(half.high, expected[axis].high, 1e-9);
    EXPECT_NEAR(quarter.low, measured.low, 1e-9);
    EXPECT_NEAR(quarter.high, axis < 2 ? measured.high : half.high, 1e-9);
  }
}

}  // namespace
}  // namespace binderjet
