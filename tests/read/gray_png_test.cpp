// SPDX-License-Identifier: GPL-3.0-or-later
// Gray PNGs of every depth are read in this process as binderjet-read reads them.
#include "slicer/stack/gray_png.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>
#include <memory>
#include <numeric>

#include "slicer/images/read_image.h"
#include "tests/slicer/color/colored_layers.h"

namespace binderjet {
namespace {

constexpr int kWidth = 21;  // not whole bytes at any depth
constexpr int kHeight = 13;

struct Form {
  int color_type;
  int bit_depth;
  int interlace = PNG_INTERLACE_NONE;
  bool transparent = false;  // one gray value is
};

void write_png(const std::string& path, const Form& form) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"),
                                                             std::fclose);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file.get());
  png_set_IHDR(png, info, kWidth, kHeight, form.bit_depth, form.color_type, form.interlace,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (form.transparent) {
    png_color_16 gray{};
    gray.gray = 1;
    png_set_tRNS(png, info, nullptr, 0, &gray);
  }
  png_write_info(png, info);
  std::vector<std::vector<png_byte>> rows(kHeight);
  std::vector<png_bytep> places;
  unsigned next = 77;
  for (std::vector<png_byte>& row : rows) {
    row.resize(8 * kWidth);
    for (png_byte& byte : row)
      byte = static_cast<png_byte>((next = next * 1103515245 + 12345) >> 16);
    places.push_back(row.data());
  }
  png_write_image(png, places.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
}

TEST(GrayPng, HasTheValuesThatTheReaderFinds) {
  const colored::Folder folder;
  for (const int depth : {1, 2, 4, 8}) {
    for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
      const std::string path = folder.file("gray.png");
      write_png(path, {PNG_COLOR_TYPE_GRAY, depth, interlace});
      const auto here = read_gray_png(path, kWidth, kHeight);
      ASSERT_TRUE(here.has_value()) << depth << " bits";
      EXPECT_EQ(*here, read_gray_image({path, {}, path}).samples) << depth << " bits";
      EXPECT_GT(std::accumulate(here->begin(), here->end(), 0), 0);
      EXPECT_FALSE(read_gray_png(path, kWidth + 1, kHeight).has_value()) << "another size";
    }
  }
}

TEST(GrayPng, LeavesToTheReaderWhatIsNotPlainGray) {
  const colored::Folder folder;
  const std::string path = folder.file("other.png");
  for (const Form& form :
       {Form{PNG_COLOR_TYPE_GRAY, 16}, Form{PNG_COLOR_TYPE_GRAY_ALPHA, 8},
        Form{PNG_COLOR_TYPE_RGB, 8}, Form{PNG_COLOR_TYPE_GRAY, 8, PNG_INTERLACE_NONE, true}}) {
    write_png(path, form);
    EXPECT_FALSE(read_gray_png(path, kWidth, kHeight).has_value());
    EXPECT_EQ(read_gray_image({path, {}, path}).samples.size(), std::size_t{kWidth} * kHeight);
  }
}

TEST(GrayPng, IsNoneWhereTheFileEndsEarly) {
  const colored::Folder folder;
  const std::string path = folder.file("short.png");
  write_png(path, {PNG_COLOR_TYPE_GRAY, 8});
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_FALSE(read_gray_png(path, kWidth, kHeight).has_value());
  EXPECT_FALSE(read_gray_png(folder.file("none.png"), kWidth, kHeight).has_value());
}

}  // namespace
}  // namespace binderjet
