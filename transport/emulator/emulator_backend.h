// SPDX-License-Identifier: GPL-3.0-or-later
// emulator:DIR, a printer that another program plays in a folder.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "transport/base/backend.h"
#include "transport/base/result.h"

namespace binderjet {

// emulator:DIR, or with ?patience_s=SECONDS behind it. A URI that is none is kBadInput.
Result<std::unique_ptr<Backend>> make_emulator_backend(const std::string& uri,
                                                       const BackendOptions& options);

// The folder that such a URI names; nothing for another one.
std::optional<std::string> emulator_folder(const std::string& uri);
// Below it: the journals of the jobs that were sent there.
std::string emulator_journals(const std::string& folder);

}  // namespace binderjet
