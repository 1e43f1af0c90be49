// SPDX-License-Identifier: GPL-3.0-or-later
// export --zip, opened as UVtools and NanoDLP open it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "slicer/stack/slice_stack.h"
#include "tests/support/archive.h"
#include "tests/support/decoded_png.h"
#include "tests/support/models.h"
#include "tests/support/program.h"
#include "tests/support/xml.h"

namespace binderjet {
namespace {

class ExportZip : public testing::Test {
 protected:
  ExportZip() {
    models::write_obj(models::golf_ball(2, 4), here_ / "ball.obj");
    run({"slice", here_ / "ball.obj", "-p", "z450", "-o", here_ / "a.bjob"});
  }
  void run(std::vector<std::string> words) const {
    words.emplace_back("-q");
    const Ran ran = here_.run(words);
    ASSERT_EQ(ran.status, 0) << ran.err;
  }
  // Exports with the words added, as an archive and as the stack that it must agree with.
  void export_both(const std::vector<std::string>& more) const {
    for (const auto& out : {std::vector{std::string("--zip"), here_ / "a.zip"},
                            std::vector{std::string("-o"), here_ / "masks"}}) {
      std::vector<std::string> words = {"export", here_ / "a.bjob"};
      words.insert(words.end(), out.begin(), out.end());
      words.insert(words.end(), more.begin(), more.end());
      run(words);
    }
  }
  // How many of the layer's pixels are not white where the mask is 1 and black elsewhere.
  static int wrong_pixels(const png::Decoded& png, const RunLayer& mask) {
    int wrong = 0;
    for (int y = 0; y < png.height; ++y) {
      for (int x = 0; x < png.width; ++x) {
        const auto row = static_cast<std::size_t>(png.height - 1 - y);  // the back comes first
        const auto at =
            3 * (row * static_cast<std::size_t>(png.width) + static_cast<std::size_t>(x));
        const std::byte expected{mask.at(x, y) ? std::uint8_t{255} : std::uint8_t{0}};
        for (std::size_t c = 0; c < 3; ++c) wrong += png.bits[at + c] != expected;
      }
    }
    return wrong;
  }

  Workplace here_;
};

TEST_F(ExportZip, HasTheNamesSizesAndManifestThatUvtoolsReads) {
  export_both({});
  const Archive zip(here_ / "a.zip");
  const StackReader masks(here_ / "masks");
  const StackInfo& info = masks.info();
  const Xml manifest(zip.at("manifest.uvtools").bytes);
  EXPECT_EQ(manifest.root().name(), "Manifest");
  const auto number = [&](const char* name) {
    return std::stod(manifest.root().child(name).text());
  };
  EXPECT_EQ(number("ResolutionX"), info.size[0]);
  EXPECT_EQ(number("ResolutionY"), info.size[1]);
  EXPECT_NEAR(number("DisplayWidth"), info.size[0] * 25.4 / 300, 1e-9);
  EXPECT_NEAR(number("DisplayHeight"), info.size[1] * 25.4 / 450, 1e-9);
  EXPECT_NEAR(number("LayerHeight"), 0.102, 1e-9);
  EXPECT_NEAR(number("MachineZ"), info.size[2] * 0.102, 1e-9);

  // UVtools takes the greatest number as the count, and then asks for every one from 1 on.
  EXPECT_EQ(zip.entries.size(), static_cast<std::size_t>(info.size[2]) + 2);
  for (int index = 0; index < info.size[2]; ++index) {
    const ArchiveEntry& entry = zip.at(std::to_string(index + 1) + ".png");
    EXPECT_TRUE(entry.stored);
    const png::Decoded png = png::decode(entry.data());
    ASSERT_EQ(png.width, info.size[0]);
    ASSERT_EQ(png.height, info.size[1]);
    ASSERT_EQ(wrong_pixels(png, masks.read(index)), 0) << "layer " << index;
  }
}

TEST_F(ExportZip, IsWhatNanodlpAsksFor) {
  export_both({});
  const Archive zip(here_ / "a.zip");
  const auto meta = nlohmann::json::parse(zip.at("meta.json").bytes);
  EXPECT_EQ(meta["FormatVersion"], 1);
  EXPECT_EQ(meta["Program"], "binderjet");
  EXPECT_EQ(meta["Profile"], false);
  const png::Decoded png = png::decode(zip.at("20.png").data());
  EXPECT_EQ(png.bit_depth, 8);
  EXPECT_EQ(png.color_type, PNG_COLOR_TYPE_RGB);
}

TEST_F(ExportZip, ShowsTheWholeBedIfAsked) {
  run({"slice", here_ / "ball.obj", "-p", "z450", "--at", "20,30", "--layers", "18:20", "-o",
       here_ / "a.bjob"});
  export_both({"--full-bed"});
  const png::Decoded png = png::decode(Archive(here_ / "a.zip").at("2.png").data());
  const StackReader masks(here_ / "masks");
  EXPECT_EQ(png.width, masks.info().size[0]);
  EXPECT_GT(png.width, 2000);
  const RunLayer mask = masks.read(1);
  EXPECT_GT(mask.count(), 1000);
  EXPECT_EQ(wrong_pixels(png, mask), 0);
}

TEST_F(ExportZip, GivesTheSameBytesAgain) {
  export_both({});
  run({"export", here_ / "a.bjob", "--zip", here_ / "b.zip"});
  EXPECT_EQ(here_.text("a.zip"), here_.text("b.zip"));
}

TEST_F(ExportZip, IsTheSameBesideOthersInOneCall) {
  run({"export", here_ / "a.bjob", "--zip", here_ / "alone.zip"});
  run({"export", here_ / "a.bjob", "--zip", here_ / "a.zip", "--3mf", here_ / "a.3mf"});
  EXPECT_EQ(here_.text("a.zip"), here_.text("alone.zip"));
}

}  // namespace
}  // namespace binderjet
