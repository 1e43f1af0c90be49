// SPDX-License-Identifier: GPL-3.0-or-later
// The journal of a spooled job: what was acknowledged, in lines that are only ever appended.
//
// clang-format off
//   start VERSION LAYERS NAME SOURCE [TO KEY] CHECKSUM
//   ack LAYERS BYTES [DIGEST] CHECKSUM    layers 0 to LAYERS - 1 are the job file up to byte BYTES
//   held REASON CHECKSUM
//   resumed CHECKSUM
// clang-format on
//
// TO, KEY and DIGEST are there where the job went to a device: TO is the device's URI, KEY the
// job's number there, DIGEST that of the acknowledged layers; KEY and DIGEST are in hex.
//
// Words are separated by one blank; what could break a word is written as %XX. A checksum is 16 hex
// digits of the XXH3-64 of the words before it, seeded with the checksum of the line before. So a
// line that is torn, changed, lost or out of place ends what is believed, and all lines before it
// stand.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "transport/base/file.h"
#include "transport/base/result.h"

namespace binderjet {

struct JournalState {
  bool started = false;
  int layer_count = 0;
  std::string name;
  std::string source;
  int acknowledged = 0;
  std::uint64_t bytes = 0;   // of the job file, that the acknowledged layers take
  std::string held;          // why, or empty
  std::string to;            // the device, or empty
  std::uint64_t key = 0;     // the job's number at the device
  std::uint64_t digest = 0;  // of the acknowledged layers
};

// A journal that this process writes. While it is open nobody else can open it: its lock, which
// the system drops when the process ends in any way, tells whether a job's sender lives.
class Journal {
 public:
  // On return the start line survives a loss of power. The path must not exist.
  static Result<Journal> create(const std::string& path, const JournalState& start);
  // Nothing if another process has it. What follows the last right line is cut off on the first
  // write.
  static Result<std::optional<Journal>> open(const std::string& path);
  // What a journal says at this moment, whoever writes it.
  static Result<JournalState> peek(const std::string& path);

  const JournalState& state() const { return state_; }

  // On return the line survives a loss of power; call it only after the job file's own sync.
  Result<void> acknowledge(int layers, std::uint64_t bytes);
  // The same for a job that went to a device, which says what is acknowledged.
  Result<void> acknowledge(int layers, std::uint64_t bytes, std::uint64_t digest);
  Result<void> held(const std::string& reason);
  Result<void> resumed();

 private:
  Journal() = default;
  Result<void> append(const std::string& words);

  File file_;
  std::string path_;
  JournalState state_;
  std::uint64_t end_ = 0;       // behind the last right line
  std::uint64_t checksum_ = 0;  // of the last right line
};

}  // namespace binderjet
