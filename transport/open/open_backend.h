// SPDX-License-Identifier: GPL-3.0-or-later
// The backend that a URI means: its scheme chooses.
#pragma once

#include <memory>
#include <string>

#include "transport/base/backend.h"
#include "transport/base/result.h"

namespace binderjet {

// file:PATH, spool:DIR or usb:... Touches nothing yet. An unknown scheme is kBadInput.
Result<std::unique_ptr<Backend>> open_backend(const std::string& uri,
                                              const BackendOptions& options = {});

// One job file, written as it comes; it has no queue and cannot resume.
std::unique_ptr<Backend> make_file_backend(const std::string& path);

}  // namespace binderjet
