// SPDX-License-Identifier: GPL-3.0-or-later
// What print and join must know of a job file: that it is whole, and how many layers it has.
#pragma once

#include <string>

#include "transport/job/job_file.h"

namespace binderjet {

// The layers of the whole job, from its header's size_px, also where the file is a share of it.
int job_layer_count(const JobReader& job);

// A job with a mask for each of its layers; throws Error with what is missing and what to do.
JobReader open_whole_job(const std::string& path);

}  // namespace binderjet
