// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/emulator/printer_socket.h"

#include <fmt/core.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace binderjet {
namespace {

constexpr const char* kName = "printer.socket";
constexpr int kBacklog = 4;

// The socket's name by way of an open folder.
sockaddr_un address_in(const File& folder) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = fmt::format("/proc/self/fd/{}/{}", folder.fd(), kName);
  std::copy(path.begin(), path.end(), address.sun_path);
  return address;
}

Result<File> open_folder(const std::string& folder) {
  return open_file(folder, O_RDONLY | O_DIRECTORY);
}

Result<File> open_socket(const std::string& folder) {
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return tl::unexpected(system_failure(errno, folder, "cannot make a socket"));
  return File(fd);
}

}  // namespace

PrinterSocket::PrinterSocket(std::string folder, File lock, File listener)
    : folder_(std::move(folder)), lock_(std::move(lock)), listener_(std::move(listener)) {}

PrinterSocket::~PrinterSocket() {
  if (lock_) unlinkat(lock_.fd(), kName, 0);
}

Result<PrinterSocket> PrinterSocket::listen(const std::string& folder) {
  if (auto made = make_folder(folder); !made) return tl::unexpected(made.error());
  Result<File> lock = open_folder(folder);
  if (!lock) return tl::unexpected(lock.error());
  if (flock(lock->fd(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) {
      return tl::unexpected(system_failure(errno, folder, "cannot lock it"));
    }
    return tl::unexpected(
        Failure{FailureKind::kDevice, folder,
                "another emulated printer has this folder; stop that one or name another folder"});
  }
  Result<File> listener = open_socket(folder);
  if (!listener) return tl::unexpected(listener.error());
  unlinkat(lock->fd(), kName, 0);  // a killed one's
  const sockaddr_un address = address_in(*lock);
  // Nobody can connect before listen(), so nobody does before the rights are right.
  if (bind(listener->fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      fchmodat(lock->fd(), kName, 0600, 0) != 0 || ::listen(listener->fd(), kBacklog) != 0) {
    return tl::unexpected(system_failure(errno, folder, "cannot listen in it"));
  }
  return PrinterSocket(folder, std::move(*lock), std::move(*listener));
}

Result<File> connect_to_printer(const std::string& folder) {
  const auto nobody = [&folder] {
    return tl::unexpected(
        Failure{FailureKind::kDevice, folder,
                fmt::format("no emulated printer is running here; start one: binderjet emulator -o "
                            "{}",
                            folder)});
  };
  const Result<File> way = open_folder(folder);
  if (!way) return nobody();
  Result<File> connection = open_socket(folder);
  if (!connection) return connection;
  const sockaddr_un address = address_in(*way);
  if (connect(connection->fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    return connection;
  }
  if (errno == ENOENT || errno == ECONNREFUSED) return nobody();
  return tl::unexpected(system_failure(errno, folder, "cannot reach the emulated printer"));
}

}  // namespace binderjet
