// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/images/read_image.h"

#include <memory>
#include <mutex>
#include <utility>

#include "slicer/base/error.h"
#include "slicer/images/reader_process.h"

namespace binderjet {
namespace {

// The processes that wait for work: as many as threads once read at the same time.
class Readers {
 public:
  std::unique_ptr<ReaderProcess> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        auto reader = std::move(idle_.back());
        idle_.pop_back();
        return reader;
      }
    }
    return std::make_unique<ReaderProcess>();
  }

  void give_back(std::unique_ptr<ReaderProcess> reader) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(reader));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<ReaderProcess>> idle_;
};

Image ask(const ImageSource& source, ImageWish wish, int channels, int factor = 1) {
  static Readers readers;
  ImageRequest request;
  request.wish = wish;
  request.factor = static_cast<std::uint32_t>(factor);
  request.is_path = source.path.empty() ? 0 : 1;
  const std::span<const std::byte> content =
      source.path.empty() ? source.bytes : std::as_bytes(std::span(source.path));
  request.size = content.size();

  auto reader = readers.take();
  const auto answer = reader->ask(request, content);
  if (!answer) throw Error(ErrorKind::kBadInput, source.name, reader->end());
  readers.give_back(std::move(reader));
  const auto* samples = reinterpret_cast<const std::uint8_t*>(answer->content.data());
  const std::size_t count = answer->content.size();
  if (answer->reply.good == 0) {
    throw Error(ErrorKind::kBadInput, source.name, {samples, samples + count});
  }
  return {answer->reply.width, answer->reply.height, channels, {samples, samples + count}};
}

}  // namespace

Image read_image_size(const ImageSource& source) { return ask(source, ImageWish::kSize, 0); }

Image read_gray_image(const ImageSource& source) { return ask(source, ImageWish::kGray, 1); }

Image read_color_image(const ImageSource& source, int factor) {
  return ask(source, ImageWish::kColor, 3, factor);
}

}  // namespace binderjet
