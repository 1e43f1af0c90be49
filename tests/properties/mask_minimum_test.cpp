// SPDX-License-Identifier: GPL-3.0-or-later
// The profile's mask minimum holds for every way of making masks.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "driver/job/job_masks.h"
#include "slicer/enhance/rules/mask_regions.h"
#include "tests/support/models.h"

namespace binderjet {
namespace {

// A golf ball's dimples end in single pixels wherever a layer just touches them.
JobHeader golf_ball_job(Enhancement enhance, const Mesh& ball) {
  JobHeader header;
  header.profile = load_profile("z450");
  header.grid = header.profile.grid({});
  header.enhance = enhance;
  header.passes = 2;
  header.box = job_box(bounding_box(ball).max, header.grid, {0, 0}, {8, 8});
  return header;
}

struct Sliced {
  std::vector<RunLayer> masks;
  MaskRegions regions;
  RuleTally tally;
};
Sliced slice(const JobHeader& header, const std::shared_ptr<const Mesh>& mesh) {
  Sliced out;
  const auto stream = job_masks(header, mesh).all_layers();
  while (stream->rest().size() > 0) {
    for (const Shared<MaskLayer>& layer : stream->next(kBlockLayers)) {
      out.masks.push_back(layer->mask);
      out.regions += mask_regions(layer->mask);
      out.tally.add(layer->changes);
    }
  }
  return out;
}

class MaskMinimum : public testing::TestWithParam<Enhancement> {
 protected:
  std::shared_ptr<const Mesh> ball_ =
      std::make_shared<const Mesh>(models::at_origin(models::golf_ball(3, 5)));
  JobHeader header_ = golf_ball_job(GetParam(), *ball_);
};

TEST_P(MaskMinimum, HoldsForAGolfBallHoweverItsMasksAreMade) {
  const Sliced sliced = slice(header_, ball_);
  EXPECT_GE(sliced.regions.smallest_island_px, header_.profile.mask.min_island_px);
  EXPECT_GE(sliced.regions.smallest_hole_px, header_.profile.mask.min_hole_px);
}

TEST_P(MaskMinimum, ChangesAsMuchAsItSays) {
  const Sliced sliced = slice(header_, ball_);
  header_.profile.mask = {};
  const Sliced free = slice(header_, ball_);
  std::int64_t changed = 0;
  for (std::size_t k = 0; k < free.masks.size(); ++k) {
    changed += static_cast<std::int64_t>(sliced.masks[k] != free.masks[k]);
  }
  EXPECT_FALSE(free.tally.changes.any());
  // An inverse mask obeys while it is searched, so nothing is left to change, and with other rules
  // another one is found.
  if (header_.enhance == Enhancement::kInverse) {
    EXPECT_FALSE(sliced.tally.changes.any());
  } else {
    EXPECT_EQ(sliced.tally.layers, changed);
  }
  if (header_.enhance == Enhancement::kPaper) {
    EXPECT_GT(changed, 0) << "or this test shows nothing";
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, MaskMinimum, testing::ValuesIn(kEnhancements),
                         [](const auto& way) { return std::string(word(way.param)); });

TEST(MaskMinimumWarning, SaysWhatWasErasedAndFilledAndWhere) {
  const MaskRules rules{4, 5};
  EXPECT_EQ(rule_warning({}, rules), "");
  EXPECT_EQ(rule_warning({{1, 0}, 1}, rules),
            "the profile's mask minimum erased 1 island of fewer than 4 pixels in 1 layer");
  EXPECT_EQ(
      rule_warning({{12, 3}, 7}, rules),
      "the profile's mask minimum erased 12 islands of fewer than 4 pixels, filled 3 holes of "
      "fewer than 5 pixels in 7 layers");
}

}  // namespace
}  // namespace binderjet
