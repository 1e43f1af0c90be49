// SPDX-License-Identifier: GPL-3.0-or-later
// The table of schemes.
#include "transport/open/open_backend.h"

#include <fmt/core.h>

#include "transport/emulator/emulator_backend.h"
#include "transport/spool/spool.h"
#include "transport/usb/usb_backend.h"

namespace binderjet {
namespace {

using Opened = Result<std::unique_ptr<Backend>>;

// A backend whose URI is a path.
template <std::unique_ptr<Backend> (*make)(const std::string& path, const BackendOptions& options)>
Opened open_at_path(const std::string& uri, const BackendOptions& options) {
  std::string path = uri.substr(uri.find(':') + 1);
  // file:///tmp/a.bjob is the long form of file:/tmp/a.bjob.
  if (path.starts_with("///")) path.erase(0, 2);
  // A slash at the end would make the folder's own folder the folder itself.
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  if (path.empty()) {
    return tl::unexpected(
        Failure{FailureKind::kBadInput, uri, "no path behind the colon; use " + scheme_forms()});
  }
  return make(path, options);
}

}  // namespace

const std::vector<Scheme>& schemes() {
  static const std::vector<Scheme> kSchemes = {
      // name, forms, keeps jobs, needs state, open, list, wait
      {"usb",
       {"usb:", "usb://VID:PID/SERIAL"},
       true,
       true,
       make_usb_backend,
       list_usb_devices,
       wait_for_usb_device},
      {"emulator", {"emulator:DIR"}, true, false, make_emulator_backend},
      {"spool", {"spool:DIR"}, true, false, open_at_path<make_spool_backend>},
      {"file", {"file:PATH"}, false, false, open_at_path<make_file_backend>},
  };
  return kSchemes;
}

const Scheme* find_scheme(const std::string& uri) {
  for (const Scheme& scheme : schemes()) {
    if (uri.starts_with(fmt::format("{}:", scheme.name))) return &scheme;
  }
  return nullptr;
}

std::string scheme_forms(bool with_jobs) {
  std::vector<std::string> forms;
  for (const Scheme& scheme : schemes()) {
    if (with_jobs && !scheme.keeps_jobs) continue;
    forms.insert(forms.end(), scheme.forms.begin(), scheme.forms.end());
  }
  std::string text;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    text += i == 0 ? "" : i + 1 < forms.size() ? ", " : " or ";
    text += forms[i];
  }
  return text;
}

Result<std::unique_ptr<Backend>> open_backend(const std::string& uri,
                                              const BackendOptions& options) {
  const Scheme* scheme = find_scheme(uri);
  if (scheme == nullptr) {
    return tl::unexpected(
        Failure{FailureKind::kBadInput, uri, "not a place to print to; use " + scheme_forms()});
  }
  return scheme->open(uri, options);
}

}  // namespace binderjet
