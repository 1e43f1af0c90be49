// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/base/plain_file.h"

#include <filesystem>

#include "slicer/base/error.h"

namespace binderjet {

void demand_plain_file(const std::string& path) {
  std::error_code unknown;
  const std::filesystem::file_status status = std::filesystem::status(path, unknown);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
  throw Error(ErrorKind::kBadInput, path,
              std::filesystem::is_directory(status)
                  ? "is a folder; name a file"
                  : "is not a plain file; save what comes from it to a file first");
}

}  // namespace binderjet
