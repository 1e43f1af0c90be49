// SPDX-License-Identifier: GPL-3.0-or-later
// The job container, a .bjob file: header, one record per layer and kind, index. Any flipped bit is
// found, and a file cut anywhere is read up to its last whole layer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "transport/base/file.h"
#include "transport/base/result.h"
#include "transport/job/job_format.h"

namespace binderjet {

// The longest payload a record takes; a driver that may exceed it checks first.
inline constexpr std::uint64_t kMaxRecordPayload = job_format::kMaxPayloadBytes;

// Encodes one record. The same payload always gives the same bytes. Pure and thread-safe, so that
// threads compress while one writes. 0 <= layer, payload <= kMaxRecordPayload.
std::vector<std::byte> encode_record(RecordKind kind, int layer,
                                     std::span<const std::byte> payload);

// Writes a job under a temporary name in the same folder and gives it its own name when it is
// whole. The destructor removes an unfinished file. After a Failure only the destructor is left.
class JobWriter {
 public:
  static Result<JobWriter> create(const std::string& path, std::string_view header);

  // For work that is gone on with: the unfinished file has the name `part` and outlives the writer.
  static Result<JobWriter> create_kept(const std::string& part, const std::string& path,
                                       std::string_view header);
  // Goes on with such a file after its first `bytes` bytes, which must be whole records, and
  // forgets the rest.
  static Result<JobWriter> reopen_kept(const std::string& part, const std::string& path,
                                       std::uint64_t bytes);

  // The unfinished file got another name.
  void move_part(const std::string& part) { part_ = part; }

  JobWriter(JobWriter&& other) noexcept = default;
  JobWriter& operator=(JobWriter&& other) noexcept;
  ~JobWriter();

  // One or more whole records as encode_record gives them, ascending by layer, then by kind.
  // A wrong record is kBadInput and nothing of it is written.
  Result<void> append(std::span<const std::byte> records);
  // On return everything appended survives a loss of power.
  Result<void> sync();
  // Index, trailer, sync, rename, sync of the folder.
  Result<void> finish();

  const std::string& header() const { return header_; }
  std::uint64_t bytes() const { return size_; }
  int last_layer() const;  // -1 before the first record

 private:
  JobWriter() = default;
  void remove_unfinished();

  File file_;  // closed once the job is finished
  std::string part_;
  std::string path_;
  bool keep_part_ = false;
  bool failed_ = false;
  std::string header_;
  std::uint64_t preamble_checksum_ = 0;
  std::uint64_t size_ = 0;
  std::vector<job_format::IndexEntry> entries_;
};

// Reads a job. All reading is const and may run in several threads at once.
class JobReader {
 public:
  // Damage in the header is a Failure; a file cut or damaged behind it opens, see damage().
  static Result<JobReader> open(const std::string& path);

  const std::string& path() const { return path_; }
  const std::string& header() const { return header_; }
  // Index and trailer are there and right. A record may still be damaged: reading it finds out.
  bool whole() const { return damage_.empty(); }
  // Empty, or what is missing and what to do.
  const std::string& damage() const { return damage_; }

  std::vector<int> layers(RecordKind kind) const;  // ascending
  bool contains(RecordKind kind, int layer) const;
  // The payload as it was given to encode_record. Where its size is known, give it: 32 KB of a
  // stranger's file can unpack to a gigabyte.
  Result<std::vector<std::byte>> read(RecordKind kind, int layer,
                                      std::optional<std::size_t> size = {}) const;
  // The record as encode_record gave it, for sending and joining.
  Result<std::vector<std::byte>> read_record(RecordKind kind, int layer) const;
  // Every record there is, in the order of the file.
  const std::vector<job_format::IndexEntry>& entries() const { return entries_; }

 private:
  JobReader() = default;
  bool read_index(std::uint64_t size);
  Result<void> scan(std::uint64_t size);
  const job_format::IndexEntry* find(RecordKind kind, int layer) const;

  File file_;
  std::string path_;
  std::string header_;
  std::uint64_t preamble_checksum_ = 0;
  std::uint64_t first_offset_ = 0;
  std::string damage_;
  std::vector<job_format::IndexEntry> entries_;
};

// Checks every byte: header, records and their payloads, index, trailer.
Result<void> verify_job(const std::string& path);

// Puts the shares of one job together, byte for byte the job sliced as a whole. All shares are
// whole and have the same header; each of the layers 0 to layer_count - 1 has a mask in exactly
// one of them. `on_layer`, if given, is told each layer before it is written; it may throw to end
// the work, and then nothing is left.
Result<void> join_jobs(const std::vector<std::string>& shares, const std::string& out,
                       int layer_count, const std::function<void(int layer)>& on_layer = {});

}  // namespace binderjet
