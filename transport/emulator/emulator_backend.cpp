// SPDX-License-Identifier: GPL-3.0-or-later
// The journals are in the printer's folder, so that each folder counts its own jobs. The printer
// forgets all it holds when it ends; then nothing is said of its jobs.
#include "transport/emulator/emulator_backend.h"

#include <string_view>
#include <utility>

#include "transport/emulator/printer_socket.h"
#include "transport/emulator/socket_link.h"
#include "transport/printer/printer_backend.h"

namespace binderjet {
namespace {

constexpr std::string_view kScheme = "emulator:";

}  // namespace

std::optional<std::string> emulator_folder(const std::string& uri) {
  if (!uri.starts_with(kScheme)) return std::nullopt;
  std::string plain = uri;
  if (!take_patience(plain)) return std::nullopt;
  std::string folder = plain.substr(kScheme.size());
  // emulator:///tmp/a is the long form of emulator:/tmp/a.
  if (folder.starts_with("///")) folder.erase(0, 2);
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  if (folder.empty()) return std::nullopt;
  return folder;
}

std::string emulator_journals(const std::string& folder) { return folder + "/jobs"; }

Result<std::unique_ptr<Backend>> make_emulator_backend(const std::string& uri,
                                                       const BackendOptions& options) {
  std::string plain = uri;
  const auto patience = take_patience(plain);
  if (!patience) return tl::unexpected(patience.error());
  const auto folder = emulator_folder(uri);
  if (!folder) {
    return tl::unexpected(
        Failure{FailureKind::kBadInput, uri, "no folder behind the colon; use emulator:DIR"});
  }
  PrinterAccess access;
  access.uri = uri;
  access.patience = *patience;
  access.journals = emulator_journals(*folder);
  access.stop_asked = options.stop_asked;
  access.say_wait = options.say_wait;
  access.open = [folder = *folder, plain](const std::string&) {
    return SocketLink::open(folder, plain);
  };
  access.must_be_there = [folder = *folder]() -> Result<void> {
    if (const auto there = connect_to_printer(folder); !there) {
      return tl::unexpected(there.error());
    }
    return {};
  };
  return make_printer_backend(std::move(access));
}

}  // namespace binderjet
