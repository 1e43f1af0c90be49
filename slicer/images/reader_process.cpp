// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/images/reader_process.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "slicer/base/error.h"

namespace binderjet {
namespace {

// Beside this program, or where a package that starts both through a loader of its own says it is.
std::string reader_path() {
  if (const char* path = std::getenv("BINDERJET_READ")) return path;
  std::error_code unknown;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", unknown);
  return self.parent_path() / "binderjet-read";
}

constexpr std::uint64_t kMostWords = 4096;  // of an error

// What the reader may say to that request.
bool plausible(const ImageReply& reply, const ImageRequest& request) {
  if (reply.magic != ImageRequest::kMagic) return false;
  if (reply.good == 0) return reply.size <= kMostWords;
  if (reply.width < 1 || reply.height < 1) return false;
  const std::int64_t pixels = std::int64_t{reply.width} * reply.height;
  const int channels = request.wish == ImageWish::kColor ? 3 : request.wish == ImageWish::kGray;
  return pixels <= kMostPixels && reply.size == static_cast<std::uint64_t>(pixels * channels);
}

}  // namespace

ReaderProcess::ReaderProcess() {
  const std::string path = reader_path();
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw Error(ErrorKind::kBadInput, path,
                fmt::format("cannot be talked to: {}", std::strerror(errno)));
  }
  socket_ = ends[0];
  // The socket is its standard input. Nothing else of ours is open to it, and nothing that it
  // prints comes between the lines of --json.
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[1], 0);
  posix_spawn_file_actions_adddup2(&files, 2, 1);
  posix_spawn_file_actions_addclosefrom_np(&files, 3);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  std::string name = "binderjet-read";
  const std::array<char*, 2> arguments = {name.data(), nullptr};
  const int failed =
      ::posix_spawn(&process_, path.c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  ::close(ends[1]);
  if (failed != 0) {
    ::close(socket_);
    throw Error(
        ErrorKind::kUsage, path,
        fmt::format("cannot be started ({}); images are read by it, install binderjet again",
                    std::strerror(failed)));
  }
}

ReaderProcess::~ReaderProcess() {
  ::close(socket_);
  if (process_ > 0) ::waitpid(process_, nullptr, 0);
}

std::optional<ReaderAnswer> ReaderProcess::ask(const ImageRequest& request,
                                               std::span<const std::byte> content) {
  ReaderAnswer answer;
  if (!send_all(socket_, std::as_bytes(std::span(&request, 1))) || !send_all(socket_, content) ||
      !receive_all(socket_, std::as_writable_bytes(std::span(&answer.reply, 1)))) {
    return std::nullopt;
  }
  if (!plausible(answer.reply, request)) {
    said_nonsense_ = true;
    return std::nullopt;
  }
  answer.content.resize(answer.reply.size);
  if (!receive_all(socket_, answer.content)) return std::nullopt;
  return answer;
}

std::string ReaderProcess::end() {
  int status = 0;
  // For who closed the socket and goes on; who is ending has its status already.
  ::kill(process_, SIGKILL);
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
  process_ = -1;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return "takes too long to decode";
  if (said_nonsense_) return "cannot be decoded: binderjet-read answered what is no image";
  if (WIFSIGNALED(status)) {
    return fmt::format("makes its reader end by signal {} ({}); it is damaged", WTERMSIG(status),
                       ::strsignal(WTERMSIG(status)));
  }
  return fmt::format("cannot be decoded: binderjet-read ended with status {}", WEXITSTATUS(status));
}

}  // namespace binderjet
