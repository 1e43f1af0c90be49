// SPDX-License-Identifier: GPL-3.0-or-later
// Sending a job to a backend, from a file or while it is computed, from its first layer or from
// where an earlier sender stopped.
#pragma once

#include <memory>
#include <string>

#include "driver/base/console.h"
#include "driver/job/slice_options.h"
#include "transport/base/backend.h"

namespace binderjet {

// Ctrl-C; and with state where jobs for devices keep their journals, and which models usb: may
// mean.
BackendOptions backend_options(bool with_state);
// Throws Error{kUsage} for a URI that names no backend.
std::unique_ptr<Backend> backend_at(const std::string& uri);

// All below say the result, and throw Error; one that ends a job that can be resumed says how.
// Where a new job is for an emulator that is not running, this program plays it for the job.
void send_job(const Console& console, const std::string& job_path, const std::string& uri);
// Slices the parts and sends their layers as they come; a slow printer slows down the slicing.
void send_parts(const Console& console, const SliceOptions& options, const std::string& uri);
// Goes on with a held job. `source` is its job file, or else its first part: what is still to come
// is then computed again.
void resume_job(const Console& console, const std::string& id, const std::string& source,
                const std::string& uri);

// Whether the file begins as a job does.
bool is_job_file(const std::string& path);

}  // namespace binderjet
