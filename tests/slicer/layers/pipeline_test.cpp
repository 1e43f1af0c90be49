// SPDX-License-Identifier: GPL-3.0-or-later
// Ranges computed backwards, against sums over all layers at once.
#include "slicer/layers/pipeline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "slicer/base/error.h"
#include "tests/support/listener.h"
#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;

// Layer k is the number k * k.
class Squares : public Stream<int> {
 public:
  explicit Squares(LayerRange range) : rest_(range) {}
  LayerRange rest() const override { return rest_; }
  std::vector<Shared<int>> next(int count) override {
    std::vector<Shared<int>> out;
    for (; count > 0 && rest_.size() > 0; --count, ++rest_.first) {
      out.push_back(std::make_shared<const int>(rest_.first * rest_.first));
    }
    return out;
  }

 private:
  LayerRange rest_;
};

// `opened` becomes the range that the chain asks its source for.
Pipeline<int> squares(LayerRange job, LayerRange& opened) {
  return {"squares", job, [&opened](LayerRange range) {
            opened = range;
            return std::make_unique<Squares>(range);
          }};
}

int sum(const Window<int>& window) {
  int out = 0;
  for (int offset = -window.reach().below; offset <= window.reach().above; ++offset) {
    if (window.at(offset) != nullptr) out += *window.at(offset);
  }
  return out;
}

std::vector<int> pulled(Stream<int>& stream, int block) {
  std::vector<int> out;
  while (stream.rest().size() > 0) {
    for (const Shared<int>& layer : stream.next(block)) out.push_back(*layer);
  }
  return out;
}

TEST(Pipeline, OpensWhatItsStepsLookAtAndNoMore) {
  LayerRange opened;
  const auto chain =
      squares({0, 20}, opened)
          .then("one below", {1, 0}, [](int, const Window<int>& w) { return sum(w); })
          .then("two above", {0, 2}, [](int, const Window<int>& w) { return sum(w); })
          .then("alone", {}, [](int, const Window<int>& w) { return w.middle(); });
  EXPECT_EQ(opened, LayerRange{}) << "nothing is opened before layers are asked for";
  EXPECT_EQ(pulled(*chain.layers({5, 6}), 1), (std::vector<int>{16 + 2 * 25 + 2 * 36 + 49}));
  EXPECT_EQ(opened, (LayerRange{4, 8}));
  chain.layers({0, 19});
  EXPECT_EQ(opened, (LayerRange{0, 20})) << "cut at the job's ends";
}

TEST(Pipeline, SeesNullBeyondTheJobAndBeyondAPieceOfIt) {
  LayerRange opened;
  const auto edges = [](int, const Window<int>& w) {
    return static_cast<int>(w.at(-1) == nullptr) + 2 * static_cast<int>(w.at(1) == nullptr);
  };
  const auto chain = squares({3, 6}, opened).then("edges", LayerReach::both_sides(1), edges);
  EXPECT_EQ(pulled(*chain.all_layers(), 2), (std::vector<int>{1, 0, 2}));
}

TEST(Pipeline, SaysItsStepsInTheirOrder) {
  LayerRange opened;
  const auto chain =
      squares({0, 20}, opened)
          .then("halves", {2, 1}, [](int, const Window<int>& w) { return w.middle() / 2.0; })
          .then_in_blocks("mended", {4, 2}, LayerReach::both_sides(1),
                          [](int, const Window<Block<double>>& w) { return w.middle(); });
  ASSERT_EQ(chain.steps().size(), 3U);
  EXPECT_EQ(chain.steps()[0].name, "squares");
  EXPECT_EQ(chain.steps()[1].name, "halves");
  EXPECT_EQ(chain.steps()[1].reach, (LayerReach{2, 1}));
  EXPECT_EQ(chain.steps()[1].from, typeid(int));
  EXPECT_EQ(chain.steps()[1].to, typeid(double));
  EXPECT_EQ(chain.steps()[2].block_layers, 4);
}

// All layers at once, in plain loops.
std::vector<int> whole_sums(const std::vector<int>& layers, LayerReach reach) {
  std::vector<int> out;
  const int count = static_cast<int>(layers.size());
  for (int k = 0; k < count; ++k) {
    out.push_back(0);
    for (int n = std::max(0, k - reach.below); n <= std::min(count - 1, k + reach.above); ++n) {
      out.back() += layers[static_cast<std::size_t>(n)];
    }
  }
  return out;
}

TEST(Pipeline, GivesAnyLayersAsTheWholeJobHasThem) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const int job = random.number(1, 30);
    LayerRange opened;
    Pipeline<int> chain = squares({0, job}, opened);
    std::vector<int> expected;
    for (int k = 0; k < job; ++k) expected.push_back(k * k);
    for (int steps = random.number(0, 4); steps > 0; --steps) {
      if (random.chance(0.3)) {
        // Each block gets the number of layers that the blocks around it hold.
        const int size = random.number(1, 5);
        const BlockForm form{size, random.number(0, size - 1)};
        chain = chain.then_in_blocks(
            "blocks", form, LayerReach::both_sides(1), [](int, const Window<Block<int>>& w) {
              std::size_t near = 0;
              for (const int b : {-1, 0, 1}) near += w.at(b) == nullptr ? 0 : w.at(b)->size();
              Block<int> out;
              for (const Shared<int>& one : w.middle()) {
                out.push_back(std::make_shared<const int>(*one + static_cast<int>(near)));
              }
              return out;
            });
        for (int k = 0; k < job; ++k) {
          const int block = (k + form.shift) / size;
          const LayerRange near{std::max(0, (block - 1) * size - form.shift),
                                std::min(job, (block + 2) * size - form.shift)};
          expected[static_cast<std::size_t>(k)] += near.size();
        }
      } else {
        const LayerReach reach{random.number(0, 3), random.number(0, 3)};
        chain = chain.then("sum", reach, [](int, const Window<int>& w) { return sum(w) % 1000; });
        expected = whole_sums(expected, reach);
        for (int& layer : expected) layer %= 1000;
      }
    }
    const int first = random.number(0, job - 1);
    const int last = random.number(first + 1, job);
    ASSERT_EQ(pulled(*chain.layers({first, last}), random.number(1, 9)),
              std::vector<int>(expected.begin() + first, expected.begin() + last));
  }
}

// Blocks of layers too; and what is asked may end the work.
TEST(Pipeline, AsksBeforeEachLayerOfEachStepWhetherToGoOn) {
  Listener listener;
  std::atomic<int> asked = 0;
  listener.on_check = [&asked] { ++asked; };
  const auto all = [](LayerRange range) { return std::make_unique<Squares>(range); };
  const auto make = [](int, const Window<int>& window) { return sum(window); };
  const Pipeline<int> steps =
      Pipeline<int>("squares", {0, 20}, all, Work(listener))
          .then("one", LayerReach::both_sides(1), make)
          .then("two", {}, make)
          .then_in_blocks("four blocks", {5, 0}, {},
                          [](int, const Window<Block<int>>& window) { return window.middle(); });
  EXPECT_EQ(pulled(*steps.all_layers(), 8).size(), 20U);
  EXPECT_EQ(asked, 20 + 20 + 4);

  listener.on_check = [] { throw Error(ErrorKind::kInterrupted, "", "enough"); };
  EXPECT_THROW(pulled(*steps.all_layers(), 8), Error);
}

}  // namespace
}  // namespace binderjet
