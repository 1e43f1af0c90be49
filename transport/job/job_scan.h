// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a .bjob file from the front, trusting nothing: what a cut file still holds.
//
// A record is believed once its head's checksum is right, its frame fits the file and the frame's
// checksum is right; the next record begins where it ends. The walk stops at the first that is not
// believed, and does not look for later ones: a job with a hole cannot be printed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "transport/base/file.h"
#include "transport/base/result.h"
#include "transport/job/job_format.h"

namespace binderjet {

struct JobFront {
  std::string header;
  std::uint64_t checksum = 0;  // the preamble's
  std::uint64_t end = 0;       // where the first record stands
};

// Preamble and header, checked. `size` is the file's length.
Result<JobFront> read_job_front(const File& file, std::uint64_t size, const std::string& path);

struct JobScan {
  enum class Stop { kIndex, kCut, kDamaged };
  std::vector<job_format::IndexEntry> entries;  // whole and checked
  Stop stop = Stop::kCut;                       // why there are no more
  std::int64_t torn_layer = -1;  // the layer of a record whose head is right and whose frame is not
};

// The records from `offset` up to `end`, up to the first that is not whole.
Result<JobScan> scan_records(const File& file, std::uint64_t offset, std::uint64_t end,
                             const std::string& path);

}  // namespace binderjet
