// SPDX-License-Identifier: GPL-3.0-or-later
// export --html, opened in a real browser: the pixels on the screen are those of the PNGs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "driver/viewer/run_codec.h"
#include "slicer/stack/slice_stack.h"
#include "tests/support/models.h"
#include "tests/support/picture.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Viewer : public testing::Test {
 protected:
  // A ball, and under its edge a fin of 0.3 mm, too thin to print.
  Viewer() {
    models::write_obj(
        models::joined(models::golf_ball(6, 4), models::box({4.5, 3.5, -6}, {4.8, 5.5, -4})),
        here_ / "ball.obj");
  }

  void slice(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"slice", here_ / "ball.obj", "-p", "z450",
                                      "-o",    here_ / "a.bjob",   "-q"};
    words.insert(words.end(), more.begin(), more.end());
    const Ran ran = here_.run(words);
    ASSERT_EQ(ran.status, 0) << ran.err;
  }
  void export_to(const std::vector<std::string>& words) const {
    std::vector<std::string> all = {"export", here_ / "a.bjob", "-q"};
    all.insert(all.end(), words.begin(), words.end());
    const Ran ran = here_.run(all);
    ASSERT_EQ(ran.status, 0) << ran.err;
  }
  // What the browser saw of the page.
  nlohmann::json browse(int layer) const {
    const std::string command = std::string("/usr/bin/python3 ") + BINDERJET_SOURCE_DIR +
                                "/tests/driver/viewer/viewer_browser.py " + (here_ / "a.html") +
                                " " + (here_ / "page.png") + " " + std::to_string(layer) + " > " +
                                (here_ / "browser.json");
    EXPECT_EQ(std::system(command.c_str()), 0);
    return nlohmann::json::parse(here_.text("browser.json"));
  }

  Workplace here_;
};

using Color = std::array<int, 3>;
constexpr Color kPowder = {255, 255, 255};
constexpr Color kMask = {32, 38, 43};
constexpr Color kSolid = {60, 66, 72};
constexpr Color kSame = {176, 182, 187};
constexpr Color kMissing = {196, 48, 42};
constexpr Color kExtra = {42, 98, 196};

// How many samples [i, j, r, g, b] differ from what `expected(i, j)` says.
template <class Expected>
std::size_t wrong_samples(const nlohmann::json& samples, Expected expected) {
  std::size_t wrong = 0;
  for (const auto& sample : samples) {
    const Color seen = {sample[2], sample[3], sample[4]};
    if (seen != expected(sample[0].get<int>(), sample[1].get<int>())) ++wrong;
  }
  return wrong;
}

TEST_F(Viewer, ShowsTheExportedPixelsInABrowserWithoutANetwork) {
  slice({"--enhance", "none"});
  export_to({"-o", here_ / "plain", "--what", "printed"});
  slice({"--enhance", "paper", "--color-enhance"});
  export_to({"--html", here_ / "a.html"});
  export_to({"-o", here_ / "masks"});
  export_to({"-o", here_ / "printed", "--what", "printed"});
  export_to({"-o", here_ / "target", "--what", "target"});
  constexpr int kLayer = 57;
  const nlohmann::json seen = browse(kLayer);

  EXPECT_THAT(seen["faults"], IsEmpty());
  EXPECT_EQ(seen["requests"].size(), 1) << seen["requests"];  // the page itself
  EXPECT_THAT(seen["views"], ElementsAre("target", "plain", "plainDifference", "mask", "printed",
                                         "difference", "color"));
  EXPECT_EQ(seen["layers"], nlohmann::json({0, 1, 11, 10, kLayer}));
  EXPECT_GT(seen["zoom"].get<double>(), 7);
  EXPECT_THAT(seen["where"].get<std::string>(), HasSubstr("layer 57"));

  const nlohmann::json checked = here_.run({"check", here_ / "a.bjob", "--json"}).json();
  ASSERT_FALSE(checked["worst_places"].empty());
  const auto& worst = checked["worst_places"][0];
  ASSERT_GE(seen["places"].size(), checked["worst_places"].size());
  EXPECT_THAT(seen["places"][0].get<std::string>(),
              HasSubstr("layer " + std::to_string(worst["layer"].get<int>())));
  EXPECT_NEAR(seen["flown_to"][0].get<double>(), worst["at_mm"][0].get<double>(), 1e-6);
  EXPECT_NEAR(seen["flown_to"][1].get<double>(), worst["at_mm"][1].get<double>(), 1e-6);
  EXPECT_EQ(seen["flown_to"][2], worst["layer"]);

  const RunLayer mask = StackReader(here_ / "masks").read(kLayer);
  const RunLayer printed = StackReader(here_ / "printed").read(kLayer);
  const RunLayer plain = StackReader(here_ / "plain").read(kLayer);
  const RunLayer wanted = StackReader(here_ / "target").read(2 * kLayer);
  const RunLayer above = StackReader(here_ / "target").read(2 * kLayer + 1);
  const auto difference = [](bool is_wanted, bool is_printed) {
    return is_wanted ? (is_printed ? kSame : kMissing) : (is_printed ? kExtra : kPowder);
  };
  for (const char* zoom : {"whole", "near"}) {
    SCOPED_TRACE(zoom);
    const auto& views = seen[zoom];
    // Pixels far from an edge look the same however small they are drawn.
    const bool whole = std::string(zoom) == "whole";
    const auto flat = [&](int i, int j) {
      for (int y = j - 2; y <= j + 2; ++y) {
        for (int x = i - 2; x <= i + 2; ++x) {
          if (mask.at(x, y) != mask.at(i, j)) return false;
          for (const RunLayer* layer : {&printed, &plain, &wanted}) {
            if (layer->at(2 * x, 2 * y) != layer->at(2 * i, 2 * j)) return false;
          }
        }
      }
      return true;
    };
    const auto judge = [&](const char* view, auto expected) {
      nlohmann::json samples = nlohmann::json::array();
      for (const auto& sample : views[view]) {
        // Where only one of the layer's two slices is wanted a difference is of two colors.
        if (wanted.at(2 * sample[0].get<int>(), 2 * sample[1].get<int>()) !=
            above.at(2 * sample[0].get<int>(), 2 * sample[1].get<int>()))
          continue;
        if (!whole || flat(sample[0], sample[1])) samples.push_back(sample);
      }
      EXPECT_GT(samples.size(), 30);
      EXPECT_LT(wrong_samples(samples, [](int, int) { return kPowder; }), samples.size());
      EXPECT_EQ(wrong_samples(samples, expected), 0) << view;
    };
    judge("mask", [&](int i, int j) { return mask.at(i, j) ? kMask : kPowder; });
    judge("plainDifference", [&](int i, int j) {
      return difference(wanted.at(2 * i, 2 * j), plain.at(2 * i, 2 * j));
    });
    judge("difference", [&](int i, int j) {
      return difference(wanted.at(2 * i, 2 * j), printed.at(2 * i, 2 * j));
    });
    judge("printed", [&](int i, int j) { return printed.at(2 * i, 2 * j) ? kSolid : kPowder; });
  }
}

TEST_F(Viewer, GoesWithoutATargetWhoseModelIsGone) {
  slice({"--enhance", "none"});
  std::filesystem::remove(here_ / "ball.obj");
  const Ran ran = here_.run({"export", here_ / "a.bjob", "--html", here_ / "a.html"});
  ASSERT_EQ(ran.status, 0);
  EXPECT_THAT(ran.err, HasSubstr("without the target"));
  const nlohmann::json seen = browse(50);
  EXPECT_THAT(seen["views"], ElementsAre("mask", "printed"));
  EXPECT_THAT(seen["places"], IsEmpty());
  EXPECT_THAT(seen["faults"], IsEmpty());
}

TEST_F(Viewer, KeepsAThousandLayersUnder30Megabytes) {
  slice({"--enhance", "paper", "--color-enhance", "--scale", "8.5", "--layers", "480:512"});
  export_to({"--html", here_ / "a.html"});
  const double bytes = static_cast<double>(std::filesystem::file_size(here_ / "a.html"));
  EXPECT_LT(bytes / 32 * 1000, 30e6);
}

TEST(RunCodec, SpendsAByteOnARowThatStaysAsItIs) {
  RunLayer layer(100);
  layer.append_row(std::vector<int>{3, 97});
  layer.append_row(std::vector<int>{});
  std::string same;
  encode_runs(layer, layer, same);
  EXPECT_EQ(same, std::string(4, '\0'));
  std::string first;
  encode_runs(layer, RunLayer::powder(100, 2), first);
  EXPECT_EQ(first, std::string("\3\3\136\0", 4));  // two flips; 3; 94 on; the empty row
}

TEST(RunCodec, SpendsAsManyBytesOnANumberAsItNeeds) {
  RunLayer layer(40000);
  layer.append_row(std::vector<int>{127, 255, 16638, 33022});
  std::string text;
  encode_runs(layer, RunLayer::powder(40000, 1), text);
  // 127; 128, 16383 and 16384 on: seven bits a byte, the lowest first.
  EXPECT_EQ(text, std::string("\5\177\x80\1\xff\177\x80\x80\1", 9));
  RunLayer moved(40000);
  moved.append_row(std::vector<int>{126, 256, 16638 - 64, 33022 + 64});
  text.clear();
  encode_runs(moved, layer, text);
  EXPECT_EQ(text, std::string("\0\1\2\177\x80\1", 6)) << "-1, 1, -64 and 64";
}

}  // namespace
}  // namespace binderjet
