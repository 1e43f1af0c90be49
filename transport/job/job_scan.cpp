// SPDX-License-Identifier: GPL-3.0-or-later
// The walk from record to record, each checked before the next is believed.
#include "transport/job/job_scan.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "transport/base/bytes.h"

namespace binderjet {

using namespace job_format;

Result<JobFront> read_job_front(const File& file, std::uint64_t size, const std::string& path) {
  const auto bad = [&path](std::string what) {
    return tl::unexpected(Failure{FailureKind::kBadInput, path, std::move(what)});
  };
  if (size > kMaxFileBytes) return bad("longer than any job can be");
  if (size < kPreambleBytes) return bad("not a job, or cut in its header: slice again");
  std::vector<std::byte> bytes(kPreambleBytes);
  if (auto read = read_at(file, 0, bytes, path); !read) return tl::unexpected(read.error());
  const std::optional<Preamble> preamble = decode_preamble(bytes);
  if (!preamble) return bad("not a job; `binderjet slice` makes one");
  if (preamble->header_bytes > kMaxHeaderBytes) return bad("damaged in its header: slice again");
  if (preamble->header_bytes > size - kPreambleBytes) return bad("cut in its header: slice again");
  bytes.resize(kPreambleBytes + static_cast<std::size_t>(preamble->header_bytes));
  const std::span<std::byte> header = std::span(bytes).subspan(kPreambleBytes);
  if (auto read = read_at(file, kPreambleBytes, header, path); !read) {
    return tl::unexpected(read.error());
  }
  // The checksum stands at the same place in every version, so that damage is not taken for
  // novelty.
  if (preamble_checksum(bytes) != preamble->checksum) {
    return bad("damaged in its header: slice again");
  }
  if (preamble->version != kVersion) {
    return bad(fmt::format("has version {} of the job file, this program reads {}: slice again",
                           preamble->version, kVersion));
  }
  return JobFront{{reinterpret_cast<const char*>(header.data()), header.size()},
                  preamble->checksum,
                  bytes.size()};
}

Result<JobScan> scan_records(const File& file, std::uint64_t offset, std::uint64_t end,
                             const std::string& path) {
  JobScan scan;
  std::array<std::byte, kRecordHeadBytes> head_bytes;
  std::vector<std::byte> frame;
  while (offset < end) {
    const std::size_t head_size =
        static_cast<std::size_t>(std::min<std::uint64_t>(kRecordHeadBytes, end - offset));
    const std::span<std::byte> some = std::span(head_bytes).first(head_size);
    if (auto read = read_at(file, offset, some, path); !read) return tl::unexpected(read.error());
    if (is_index_sync(some)) {
      scan.stop = JobScan::Stop::kIndex;
      return scan;
    }
    if (head_size < kRecordHeadBytes) return scan;
    const std::optional<RecordHead> head = decode_record_head(some);
    if (!head) {
      scan.stop = JobScan::Stop::kDamaged;
      return scan;
    }
    const IndexEntry entry{head->kind, head->layer, offset, kRecordHeadBytes + head->frame_bytes,
                           head->frame_checksum};
    const bool in_order = scan.entries.empty() || scan.entries.back().before(entry);
    if (in_order && entry.bytes > end - offset) {
      scan.torn_layer = head->layer;
      return scan;
    }
    bool right = in_order;
    if (right) {
      frame.resize(head->frame_bytes);
      if (auto read = read_at(file, offset + kRecordHeadBytes, frame, path); !read) {
        return tl::unexpected(read.error());
      }
      right = checksum(frame) == head->frame_checksum;
    }
    if (!right) {
      scan.torn_layer = head->layer;
      scan.stop = JobScan::Stop::kDamaged;
      return scan;
    }
    scan.entries.push_back(entry);
    offset = entry.end();
  }
  return scan;
}

}  // namespace binderjet
