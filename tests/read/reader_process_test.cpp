// SPDX-License-Identifier: GPL-3.0-or-later
// A reader that crashes, says nonsense or is not there: the program goes on, or says what is wrong.
#include "slicer/images/reader_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>

#include "slicer/base/error.h"
#include "slicer/images/read_image.h"
#include "tests/slicer/color/colored_layers.h"

namespace binderjet {
namespace {

using ::testing::HasSubstr;

// binderjet-read, for as long as this lives, is another program.
class Instead {
 public:
  explicit Instead(const std::string& path) { ::setenv("BINDERJET_READ", path.c_str(), 1); }
  ~Instead() { ::unsetenv("BINDERJET_READ"); }
  Instead(const Instead&) = delete;
  Instead& operator=(const Instead&) = delete;
};

// What is said of a reader that is this shell script, when it was asked for an image of one pixel.
std::string end_of(const std::string& script) {
  const colored::Folder folder;
  const std::string path = folder.file("reader");
  std::ofstream(path) << "#!/bin/sh\nhead -c " << sizeof(ImageRequest) << " > /dev/null\n"
                      << script << "\n";
  ::chmod(path.c_str(), 0755);
  const Instead instead(path);
  ReaderProcess reader;
  ImageRequest request;
  request.wish = ImageWish::kGray;
  return reader.ask(request, {}) ? "an answer" : reader.end();
}

// The reply that message.h describes, by printf: BJR1, good, 1 x 1 pixels, `size` in octal.
std::string reply(const std::string& size) {
  const std::string one = R"(\001\000\000\000)";
  return "printf 'BJR1" + one + one + one + size + R"(\000\000\000x' >&0)";
}

TEST(ReaderProcess, SaysHowItEnded) {
  EXPECT_THAT(end_of("kill -SEGV $$"), HasSubstr("end by signal 11"));
  EXPECT_THAT(end_of("kill -XCPU $$"), HasSubstr("takes too long"));
  EXPECT_THAT(end_of("exit 7"), HasSubstr("ended with status 7"));
}

TEST(ReaderProcess, IsBelievedNoNonsense) {
  EXPECT_EQ(end_of(reply(R"(\001\000\000\000\000)")), "an answer");
  EXPECT_THAT(end_of(reply(R"(\001\000\000\000\001)")), HasSubstr("cannot be decoded"));
  EXPECT_THAT(end_of(reply(R"(\002\000\000\000\000)")), HasSubstr("cannot be decoded"));
  EXPECT_THAT(end_of("head -c 1000 /dev/zero >&0"), HasSubstr("cannot be decoded"));
  EXPECT_THAT(end_of("head -c 10 /dev/zero >&0"), HasSubstr("cannot be decoded"));
}

TEST(ReaderProcess, ThatIsMissingIsNamed) {
  const Instead instead("/nowhere/binderjet-read");
  try {
    const ReaderProcess reader;
    FAIL() << "it was started";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/binderjet-read: cannot be started"));
  }
}

TEST(ReadImage, NamesWhatIsNoImageAndReadsTheNext) {
  const colored::Folder folder;
  const std::string text = folder.file("text.png");
  std::ofstream(text) << "no image at all";
  for (const std::string& path : {text, folder.file("none.png")}) {
    try {
      read_gray_image({path, {}, "image of that part"});
      FAIL() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_THAT(error.what(), HasSubstr("image of that part: "));
    }
  }
  const std::string portable_pixmap = folder.file("two.ppm");
  std::ofstream(portable_pixmap) << "P6 2 1 255\n\x10\x20\x30\x40\x50\x60";
  const ImageSource source{portable_pixmap, {}, "two"};
  EXPECT_EQ(read_image_size(source).width, 2);
  EXPECT_EQ(read_color_image(source).samples,
            (std::vector<std::uint8_t>{0x10, 0x20, 0x30, 0x40, 0x50, 0x60}));
  EXPECT_EQ(read_color_image(source, 2).samples, (std::vector<std::uint8_t>{0x28, 0x38, 0x48}));
}

// OpenImageIO knows a hundred formats; a few decoders are enough to trust.
TEST(ReadImage, RefusesAFormatThatIsNotNamed) {
  const colored::Folder folder;
  const std::string path = folder.file("one.png");
  std::ofstream(path) << std::string(
      "GIF89a\1\0\1\0\x80\0\0\xff\xff\xff\0\0\0,\0\0\0\0\1\0\1\0\0"
      "\2\2D\1\0;",
      35);
  try {
    read_gray_image({path, {}, path});
    FAIL() << "it was read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("is none of PNG, TIFF"));
  }
}

// A header alone must not make anybody allocate.
TEST(ReadImage, RefusesWhatPromisesMorePixelsThanAreRead) {
  const colored::Folder folder;
  const std::string path = folder.file("large.ppm");
  std::ofstream(path) << "P6 900000 900000 255\nx";
  EXPECT_THROW(read_image_size({path, {}, path}), Error);
  EXPECT_THROW(read_gray_image({path, {}, path}), Error);
}

}  // namespace
}  // namespace binderjet
