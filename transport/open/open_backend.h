// SPDX-License-Identifier: GPL-3.0-or-later
// The backend that a URI means: its scheme, the word before the colon, chooses. All that the
// program says of schemes, in help and in errors, comes from the table here.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "transport/base/backend.h"
#include "transport/base/result.h"

namespace binderjet {

struct Scheme {
  const char* name;
  std::vector<std::string> forms;  // of its URIs, as help shows them
  bool keeps_jobs;                 // status, cancel and resume find its jobs
  bool needs_state;                // reads BackendOptions::state_folder and usb_models
  // Touches nothing yet. A URI that is none is kBadInput.
  Result<std::unique_ptr<Backend>> (*open)(const std::string& uri, const BackendOptions& options);
  // What there is to print to; null where only a URI can tell.
  Result<std::vector<DeviceStatus>> (*list)(const BackendOptions& options) = nullptr;
  // Waits until the printer of a URI is there; false when the time is over or a stop is asked for.
  // Null where nothing can come by itself.
  bool (*wait)(const std::string& uri, const BackendOptions& options, double seconds) = nullptr;
};

// A further backend is a further line of it.
const std::vector<Scheme>& schemes();

// Null for a URI that names none.
const Scheme* find_scheme(const std::string& uri);

// "usb:, usb://VID:PID/SERIAL, emulator:DIR, spool:DIR or file:PATH"; `with_jobs`: only those that
// keep jobs.
std::string scheme_forms(bool with_jobs = false);

// An unknown scheme is kBadInput.
Result<std::unique_ptr<Backend>> open_backend(const std::string& uri,
                                              const BackendOptions& options = {});

// One job file, written as it comes; it has no queue and cannot resume.
std::unique_ptr<Backend> make_file_backend(const std::string& path, const BackendOptions& options);

}  // namespace binderjet
