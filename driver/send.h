// SPDX-License-Identifier: GPL-3.0-or-later
// Sending a job file to a backend, from its first layer or from where an earlier sender stopped.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "driver/console.h"
#include "transport/backend.h"

namespace CLI {
class App;
}

namespace binderjet {

// Throws Error{kUsage} for a URI that names no backend.
std::unique_ptr<Backend> backend_at(const std::string& uri);

// Prints `job_path` to `uri`, or goes on with the job `resumed` there; says the result.
// Throws Error; one that ends a job that can be resumed says how.
void send_job(const Console& console, const std::string& job_path, const std::string& uri,
              const std::optional<std::string>& resumed);

// status, cancel, resume and devices.
void add_queue_verbs(CLI::App& program);

}  // namespace binderjet
