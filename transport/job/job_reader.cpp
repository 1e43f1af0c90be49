// SPDX-License-Identifier: GPL-3.0-or-later
// Reading a job: by its index if it is whole, from the front if it is not.
#include <fmt/core.h>
#include <zstd.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "transport/base/bytes.h"
#include "transport/job/job_file.h"
#include "transport/job/job_scan.h"

namespace binderjet {

using namespace job_format;

namespace {

Failure bad_record(const std::string& path, const IndexEntry& entry, const std::string& what) {
  return {FailureKind::kBadInput, path, fmt::format("layer {} {}: slice again", entry.layer, what)};
}

// In a cut file nobody knows whether the last layer had more records to come. It had, if the layer
// before has a kind that it lacks, or if one of them is there in part.
void drop_torn_layer(JobScan& scan) {
  std::vector<IndexEntry>& entries = scan.entries;
  if (entries.empty()) return;
  const std::uint32_t last = entries.back().layer;
  const auto begins = [&entries](std::uint32_t layer) {
    return std::find_if(entries.begin(), entries.end(),
                        [layer](const IndexEntry& e) { return e.layer >= layer; });
  };
  const auto last_begin = begins(last);
  bool torn = scan.torn_layer == static_cast<std::int64_t>(last);
  if (scan.torn_layer < 0 && last_begin != entries.begin()) {
    const auto before = begins(std::prev(last_begin)->layer);
    torn = std::any_of(before, last_begin, [&](const IndexEntry& a) {
      return std::none_of(last_begin, entries.end(),
                          [&a](const IndexEntry& b) { return a.kind == b.kind; });
    });
  }
  if (torn) entries.erase(last_begin, entries.end());
}

std::string describe_damage(const JobScan& scan) {
  const char* how = scan.stop == JobScan::Stop::kDamaged ? "damaged" : "cut";
  if (scan.entries.empty()) return fmt::format("{} before its first whole layer: slice again", how);
  const std::uint32_t last = scan.entries.back().layer;
  if (scan.stop == JobScan::Stop::kIndex) {
    return fmt::format(
        "its index is cut or damaged; the layers up to {} are whole: slice again to be sure of all",
        last);
  }
  return fmt::format("{} after layer {}; layers {} on are missing: slice again or resume", how,
                     last, last + 1);
}

}  // namespace

Result<JobReader> JobReader::open(const std::string& path) {
  Result<File> file = open_file(path, O_RDONLY, FailureKind::kBadInput);
  if (!file) return tl::unexpected(file.error());
  const Result<std::uint64_t> size = file_bytes(*file, path);
  if (!size) return tl::unexpected(size.error());
  Result<JobFront> front = read_job_front(*file, *size, path);
  if (!front) return tl::unexpected(front.error());
  JobReader reader;
  reader.file_ = std::move(*file);
  reader.path_ = path;
  reader.header_ = std::move(front->header);
  reader.preamble_checksum_ = front->checksum;
  reader.first_offset_ = front->end;
  if (reader.read_index(*size)) return reader;
  if (auto scanned = reader.scan(*size); !scanned) return tl::unexpected(scanned.error());
  return reader;
}

bool JobReader::read_index(std::uint64_t size) {
  if (size < first_offset_ + kIndexHeadBytes + kTrailerBytes) return false;
  std::vector<std::byte> bytes(kTrailerBytes);
  const std::uint64_t trailer_offset = size - kTrailerBytes;
  if (!read_at(file_, trailer_offset, bytes, path_)) return false;
  const std::optional<Trailer> trailer = decode_trailer(bytes);
  if (!trailer || trailer->index_offset < first_offset_ ||
      trailer->index_offset + kIndexHeadBytes > trailer_offset) {
    return false;
  }
  // A file with holes can promise an index of gigabytes; its own count must agree.
  const std::uint64_t index_bytes = trailer_offset - trailer->index_offset;
  if ((index_bytes - kIndexHeadBytes) / kIndexEntryBytes != trailer->record_count) return false;
  bytes.resize(static_cast<std::size_t>(index_bytes));
  if (!read_at(file_, trailer->index_offset, bytes, path_)) return false;
  std::optional<std::vector<IndexEntry>> entries =
      decode_index(bytes, *trailer, first_offset_, preamble_checksum_);
  if (!entries) return false;
  entries_ = std::move(*entries);
  return true;
}

Result<void> JobReader::scan(std::uint64_t size) {
  Result<JobScan> scan = scan_records(file_, first_offset_, size, path_);
  if (!scan) return tl::unexpected(scan.error());
  if (scan->stop != JobScan::Stop::kIndex) drop_torn_layer(*scan);
  damage_ = describe_damage(*scan);
  entries_ = std::move(scan->entries);
  return {};
}

std::vector<int> JobReader::layers(RecordKind kind) const {
  std::vector<int> layers;
  for (const IndexEntry& entry : entries_) {
    if (entry.kind == kind) layers.push_back(static_cast<int>(entry.layer));
  }
  return layers;
}

const IndexEntry* JobReader::find(RecordKind kind, int layer) const {
  if (layer < 0) return nullptr;
  const IndexEntry wanted{kind, static_cast<std::uint32_t>(layer), 0, 0, 0};
  const auto found =
      std::lower_bound(entries_.begin(), entries_.end(), wanted,
                       [](const IndexEntry& a, const IndexEntry& b) { return a.before(b); });
  return found == entries_.end() || wanted.before(*found) ? nullptr : &*found;
}

bool JobReader::contains(RecordKind kind, int layer) const { return find(kind, layer) != nullptr; }

Result<std::vector<std::byte>> JobReader::read_record(RecordKind kind, int layer) const {
  const IndexEntry* entry = find(kind, layer);
  if (entry == nullptr) {
    const std::string why = whole() ? "the job does not have it" : damage_;
    return tl::unexpected(
        Failure{FailureKind::kBadInput, path_, fmt::format("layer {}: {}", layer, why)});
  }
  std::vector<std::byte> record(static_cast<std::size_t>(entry->bytes));
  if (auto done = read_at(file_, entry->offset, record, path_); !done) {
    return tl::unexpected(done.error());
  }
  const std::optional<RecordHead> head = decode_record_head(record);
  if (!head || head->kind != entry->kind || head->layer != entry->layer ||
      kRecordHeadBytes + head->frame_bytes != entry->bytes ||
      head->frame_checksum != entry->frame_checksum ||
      checksum(std::span(record).subspan(kRecordHeadBytes)) != head->frame_checksum) {
    return tl::unexpected(bad_record(path_, *entry, "is damaged"));
  }
  return record;
}

Result<std::vector<std::byte>> JobReader::read(RecordKind kind, int layer,
                                               std::optional<std::size_t> size) const {
  Result<std::vector<std::byte>> record = read_record(kind, layer);
  if (!record) return record;
  const IndexEntry& entry = *find(kind, layer);
  const std::optional<RecordHead> head = decode_record_head(*record);
  const std::span<const std::byte> frame = std::span(*record).subspan(kRecordHeadBytes);
  if (size && head->payload_bytes != *size) {
    return tl::unexpected(bad_record(path_, entry, "is not of the size that the job declares"));
  }
  // Nothing is allocated on the word of a length alone: head and frame must agree about it.
  if (ZSTD_getFrameContentSize(frame.data(), frame.size()) != head->payload_bytes ||
      ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size()) {
    return tl::unexpected(bad_record(path_, entry, "has a wrong length"));
  }
  std::vector<std::byte> payload(head->payload_bytes);
  if (ZSTD_decompress(payload.data(), payload.size(), frame.data(), frame.size()) !=
      payload.size()) {
    return tl::unexpected(bad_record(path_, entry, "cannot be decompressed"));
  }
  return payload;
}

Result<void> verify_job(const std::string& path) {
  const Result<JobReader> reader = JobReader::open(path);
  if (!reader) return tl::unexpected(reader.error());
  if (!reader->whole()) {
    return tl::unexpected(Failure{FailureKind::kBadInput, path, reader->damage()});
  }
  for (const IndexEntry& entry : reader->entries()) {
    const auto payload = reader->read(entry.kind, static_cast<int>(entry.layer));
    if (!payload) return tl::unexpected(payload.error());
  }
  return {};
}

}  // namespace binderjet
