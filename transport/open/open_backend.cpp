// SPDX-License-Identifier: GPL-3.0-or-later
// The URI's scheme chooses the backend.
#include "transport/open/open_backend.h"

#include <string_view>

#include "transport/spool/spool.h"
#include "transport/usb/usb_backend.h"

namespace binderjet {

Result<std::unique_ptr<Backend>> open_backend(const std::string& uri,
                                              const BackendOptions& options) {
  const std::size_t colon = uri.find(':');
  const std::string scheme = colon == std::string::npos ? "" : uri.substr(0, colon);
  std::string rest = colon == std::string::npos ? "" : uri.substr(colon + 1);
  if (scheme == "usb") return make_usb_backend(uri, options);
  // file:///tmp/a.bjob is the long form of file:/tmp/a.bjob.
  if (rest.starts_with("///")) rest.erase(0, 2);
  // A slash at the end would make the folder's own folder the folder itself.
  while (rest.size() > 1 && rest.back() == '/') rest.pop_back();
  if (scheme != "file" && scheme != "spool") {
    return tl::unexpected(Failure{FailureKind::kBadInput, uri,
                                  "not a place to print to; use usb:, spool:DIR or file:PATH"});
  }
  if (rest.empty()) {
    return tl::unexpected(Failure{FailureKind::kBadInput, uri,
                                  "no path behind the colon; use file:PATH or spool:DIR"});
  }
  return scheme == "file" ? make_file_backend(rest) : make_spool_backend(rest);
}

}  // namespace binderjet
