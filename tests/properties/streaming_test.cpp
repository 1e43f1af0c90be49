// SPDX-License-Identifier: GPL-3.0-or-later
// The streaming engine and the whole-volume engine are one function.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "slicer/enhance/masks.h"
#include "slicer/model/print_masks.h"
#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

struct Case {
  Grid grid;
  Volume target{0, 0, 0};
  std::shared_ptr<const PrinterModel> model;
  int passes = 0;
  int layers = 0;
};

Case random_case(Random& random) {
  Case c;
  c.grid = random.grid();
  c.layers = random.number(1, 9);
  c.target =
      random.volume(random.number(1, 9) * c.grid.detail_vx[0],
                    random.number(1, 9) * c.grid.detail_vx[1], c.layers * c.grid.detail_vx[2]);
  c.model = std::make_shared<const PrinterModel>(random.model(c.grid, Random::Kernels::kAny));
  c.passes = random.number(0, 3);
  return c;
}

// The masks of `layers` pulled `block` at a time.
Volume streamed(const Case& c, LayerRange layers, int block) {
  const auto stream =
      paper_masks(whole::voxel_layers(c.target, c.grid.detail_vx[2]), c.grid, c.model, c.passes)
          .layers(layers);
  std::vector<Shared<RunLayer>> masks;
  while (stream->rest().size() > 0) {
    for (const Shared<MaskLayer>& layer : stream->next(block)) {
      masks.emplace_back(layer, &layer->mask);
    }
  }
  return whole::stacked(masks);
}

Volume printed(const PrinterModel& model, const Volume& mask) {
  const Pipeline<RunLayer> masks("masks", {0, mask.nz}, whole::layer_stream(mask));
  const auto print = print_masks(masks, std::make_shared<const PrinterModel>(model)).all_layers();
  return whole::stacked(print->next(mask.nz));
}

TEST(Streaming, GivesTheMasksAndThePrintOfTheWholeVolume) {
  Random random;
  for (int round = 0; round < 1000; ++round) {
    SCOPED_TRACE(round);
    const Case c = random_case(random);
    const Volume expected = whole::paper_masks(c.target, c.model->form(), c.grid, c.passes);
    const Volume masks = streamed(c, {0, c.layers}, random.number(1, 5));
    ASSERT_EQ(masks, expected) << c.passes << " passes";
    ASSERT_EQ(printed(*c.model, masks), whole::print(expected, c.model->form(), c.grid));
  }
}

TEST(Streaming, GivesTheSameLayersInPieces) {
  Random random;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const Case c = random_case(random);
    const Volume all = streamed(c, {0, c.layers}, kBlockLayers);
    const int first = random.number(0, c.layers - 1);
    const Volume piece = streamed(c, {first, c.layers}, 2);
    for (int k = first; k < c.layers; ++k) {
      ASSERT_EQ(whole::slice(piece, k - first), whole::slice(all, k));
    }
  }
}

TEST(Streaming, GivesTheSameWithOneThreadAndAnyBlock) {
  Random random;
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE(round);
    const Case c = random_case(random);
    const Volume many = streamed(c, {0, c.layers}, kBlockLayers);
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    ASSERT_EQ(streamed(c, {0, c.layers}, 1), many);
    ASSERT_EQ(streamed(c, {0, c.layers}, random.number(2, 4)), many);
  }
}

}  // namespace
}  // namespace binderjet
