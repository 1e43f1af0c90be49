// SPDX-License-Identifier: GPL-3.0-or-later
// binderjet-read: decodes images for binderjet, which starts it (slicer/images/read_image.h). The
// socket is its standard input.
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <string_view>
#include <vector>

#include "driver/read/decode_image.h"

namespace {

using binderjet::ImageReply;
using binderjet::ImageRequest;

constexpr int kSocket = 0;
// For one image. A decoder that wants all rows at once may take 16,000 x 16,000 pixels of color.
constexpr rlim_t kMostSeconds = 10;                      // of CPU
constexpr rlim_t kMostMemory = rlim_t{1} << 30;          // bytes
constexpr std::uint64_t kMostContent = kMostMemory / 2;  // bytes

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // its shadow wants terabytes, and it speaks on stderr
#else
constexpr bool kSanitized = false;
#endif

void limit(decltype(RLIMIT_DATA) what, rlim_t most) {
  rlimit now{};
  getrlimit(what, &now);
  now.rlim_cur = std::min(most, now.rlim_max);
  setrlimit(what, &now);
}

// From now on.
void limit_cpu() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  limit(RLIMIT_CPU,
        static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1 + kMostSeconds);
}

bool answer(ImageReply reply, std::span<const std::byte> content) {
  reply.size = content.size();
  return binderjet::send_all(kSocket, std::as_bytes(std::span(&reply, 1))) &&
         binderjet::send_all(kSocket, content);
}

bool refuse(std::string_view why) {
  constexpr std::size_t kMostWords = 1000;
  return answer({}, std::as_bytes(std::span(why.substr(0, kMostWords))));
}

bool serve(const ImageRequest& request, std::span<const std::byte> content) {
  try {
    const binderjet::DecodedImage image = binderjet::decode_image(request, content);
    return answer({.good = 1, .width = image.width, .height = image.height}, image.samples);
  } catch (const std::bad_alloc&) {
    return refuse("takes more memory than an image may");
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
}

int serve_all() {
  ImageRequest request;
  while (binderjet::receive_all(kSocket, std::as_writable_bytes(std::span(&request, 1)))) {
    if (request.magic != ImageRequest::kMagic || request.size > kMostContent) return 2;
    std::vector<std::byte> content(request.size);
    if (!binderjet::receive_all(kSocket, content)) return 2;
    if (!kSanitized) limit_cpu();
    if (!serve(request, content)) return 0;
  }
  return 0;
}

}  // namespace

int main() {
  // Who started it hears these, which a terminal or a queue sends to both, and closes the socket.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CORE, 0);
  if (!kSanitized) {
    limit(RLIMIT_DATA, kMostMemory);  // without the libraries' own half a gigabyte
    // What libraries say of an image names neither the model nor what to do. A root may lack it.
    if (const int nowhere = ::open("/dev/null", O_WRONLY); nowhere >= 0) {
      ::dup2(nowhere, STDOUT_FILENO);
      ::dup2(nowhere, STDERR_FILENO);
    }
  }
  ::_exit(serve_all());  // 250 libraries have nothing to tidy up
}
