// SPDX-License-Identifier: GPL-3.0-or-later
// Writing a job: records are compressed anywhere and appended in order by one writer.
#include <fmt/core.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "transport/base/bytes.h"
#include "transport/job/job_file.h"
#include "transport/job/job_scan.h"

namespace binderjet {

using namespace job_format;

namespace {

// A name nobody else uses, also when two processes write the same job at once.
std::string unfinished_name(const std::string& path) {
  std::uint32_t random = 0;
  if (getrandom(&random, sizeof random, 0) != sizeof random) {
    random = static_cast<std::uint32_t>(getpid());
  }
  return fmt::format("{}.{:08x}.part", path, random);
}

// The name will be taken over by a rename; that must not replace a device or a folder.
Result<void> check_replaceable(const std::string& path) {
  struct stat info = {};
  if (stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode)) {
    return tl::unexpected(
        Failure{FailureKind::kDevice, path, "not a plain file; choose another name"});
  }
  std::array<std::byte, kPreambleBytes> head{};
  // A plain file or none, by the line above.
  std::FILE* there = std::fopen(path.c_str(), "rb");
  if (there == nullptr && errno == ENOENT) return {};
  const std::size_t size = there == nullptr ? 0 : std::fread(head.data(), 1, head.size(), there);
  const bool read = there != nullptr && std::ferror(there) == 0;
  if (there != nullptr) std::fclose(there);
  if (!read || (size > 0 && !decode_preamble(std::span(head).first(size)))) {
    return tl::unexpected(
        Failure{FailureKind::kBadInput, path,
                "is there and is no job, but somebody's file; choose another name"});
  }
  return {};
}

}  // namespace

std::vector<std::byte> encode_record(RecordKind kind, int layer,
                                     std::span<const std::byte> payload) {
  assert(layer >= 0 && payload.size() <= kMaxPayloadBytes);
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> zstd(ZSTD_createCCtx(), ZSTD_freeCCtx);
  if (!zstd) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(zstd.get(), ZSTD_c_compressionLevel, 1);
  ZSTD_CCtx_setParameter(zstd.get(), ZSTD_c_checksumFlag, 1);
  std::vector<std::byte> record(kRecordHeadBytes + ZSTD_compressBound(payload.size()));
  const std::span<std::byte> room = std::span(record).subspan(kRecordHeadBytes);
  const std::size_t size =
      ZSTD_compress2(zstd.get(), room.data(), room.size(), payload.data(), payload.size());
  // With room for the worst case there is no other way to fail.
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();
  record.resize(kRecordHeadBytes + size);
  const std::vector<std::byte> head = encode_record_head(
      {kind, static_cast<std::uint32_t>(layer), static_cast<std::uint32_t>(payload.size()),
       static_cast<std::uint32_t>(size), checksum(room.first(size))});
  std::copy(head.begin(), head.end(), record.begin());
  record.shrink_to_fit();
  return record;
}

Result<JobWriter> JobWriter::create_kept(const std::string& part, const std::string& path,
                                         std::string_view header) {
  if (header.size() > kMaxHeaderBytes) {
    return tl::unexpected(Failure{FailureKind::kBadInput, path, "the job's header is too long"});
  }
  if (auto free = check_replaceable(path); !free) return tl::unexpected(free.error());
  Result<File> file = open_file(part, O_RDWR | O_CREAT | O_EXCL);
  if (!file) return tl::unexpected(file.error());
  JobWriter writer;
  writer.file_ = std::move(*file);
  writer.part_ = part;
  writer.path_ = path;
  writer.header_ = header;
  const std::vector<std::byte> preamble = encode_preamble(header);
  writer.preamble_checksum_ = preamble_checksum(preamble);
  writer.size_ = preamble.size();
  // Not kept until the preamble is there: a file without one is of no use to anybody.
  if (auto done = write_all(writer.file_, preamble, part); !done) {
    return tl::unexpected(done.error());
  }
  writer.keep_part_ = true;
  return writer;
}

Result<JobWriter> JobWriter::create(const std::string& path, std::string_view header) {
  Result<JobWriter> writer = create_kept(unfinished_name(path), path, header);
  if (writer) writer->keep_part_ = false;
  return writer;
}

Result<JobWriter> JobWriter::reopen_kept(const std::string& part, const std::string& path,
                                         std::uint64_t bytes) {
  if (auto free = check_replaceable(path); !free) return tl::unexpected(free.error());
  Result<File> file = open_file(part, O_RDWR);
  if (!file) return tl::unexpected(file.error());
  const Result<std::uint64_t> size = file_bytes(*file, part);
  if (!size) return tl::unexpected(size.error());
  const Result<JobFront> front = read_job_front(*file, *size, part);
  if (!front) return tl::unexpected(front.error());
  JobWriter writer;
  writer.keep_part_ = true;
  writer.part_ = part;
  writer.path_ = path;
  writer.header_ = front->header;
  writer.preamble_checksum_ = front->checksum;
  writer.size_ = front->end;
  if (*size >= bytes) {
    Result<JobScan> scan = scan_records(*file, front->end, bytes, part);
    if (!scan) return tl::unexpected(scan.error());
    writer.entries_ = std::move(scan->entries);
    if (!writer.entries_.empty()) writer.size_ = writer.entries_.back().end();
  }
  if (writer.size_ != bytes) {
    return tl::unexpected(Failure{
        FailureKind::kBadInput, part,
        fmt::format("damaged after layer {}: cancel it and print again", writer.last_layer())});
  }
  if (ftruncate(file->fd(), static_cast<off_t>(bytes)) != 0 ||
      lseek(file->fd(), static_cast<off_t>(bytes), SEEK_SET) < 0) {
    return tl::unexpected(system_failure(errno, part, "cannot cut it to its whole layers"));
  }
  writer.file_ = std::move(*file);
  return writer;
}

JobWriter& JobWriter::operator=(JobWriter&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(part_, other.part_);
  std::swap(path_, other.path_);
  std::swap(keep_part_, other.keep_part_);
  std::swap(failed_, other.failed_);
  std::swap(header_, other.header_);
  std::swap(preamble_checksum_, other.preamble_checksum_);
  std::swap(size_, other.size_);
  std::swap(entries_, other.entries_);
  return *this;
}

JobWriter::~JobWriter() { remove_unfinished(); }

void JobWriter::remove_unfinished() {
  if (file_ && !keep_part_) unlink(part_.c_str());
}

int JobWriter::last_layer() const {
  return entries_.empty() ? -1 : static_cast<int>(entries_.back().layer);
}

Result<void> JobWriter::append(std::span<const std::byte> records) {
  assert(file_ && !failed_);
  const auto bad = [this](std::string what) {
    return tl::unexpected(Failure{FailureKind::kBadInput, path_, std::move(what)});
  };
  const std::size_t known = entries_.size();
  std::uint64_t offset = size_;
  std::span<const std::byte> rest = records;
  std::string wrong;
  while (!rest.empty() && wrong.empty()) {
    const std::optional<RecordHead> head = decode_record_head(rest);
    if (!head || rest.size() - kRecordHeadBytes < head->frame_bytes ||
        checksum(rest.subspan(kRecordHeadBytes, head->frame_bytes)) != head->frame_checksum) {
      wrong = fmt::format("the record after layer {} is damaged", last_layer());
      break;
    }
    const IndexEntry entry{head->kind, head->layer, offset, kRecordHeadBytes + head->frame_bytes,
                           head->frame_checksum};
    if (!entries_.empty() && !entries_.back().before(entry)) {
      wrong = fmt::format("layer {} comes after layer {}", entry.layer, last_layer());
    } else if (entry.end() > kMaxFileBytes) {
      wrong = "the job is longer than any job can be";
    } else {
      entries_.push_back(entry);
      offset = entry.end();
      rest = rest.subspan(static_cast<std::size_t>(entry.bytes));
    }
  }
  if (!wrong.empty()) {
    entries_.resize(known);
    return bad(std::move(wrong));
  }
  auto done = write_all(file_, records, part_);
  if (done) {
    size_ = offset;
  } else {
    failed_ = true;
  }
  return done;
}

Result<void> JobWriter::sync() {
  assert(file_ && !failed_);
  auto done = sync_file(file_, part_);
  failed_ = !done;
  return done;
}

Result<void> JobWriter::finish() {
  assert(file_ && !failed_);
  failed_ = true;  // until all steps are done
  const std::vector<std::byte> tail = encode_index(entries_, size_, preamble_checksum_);
  if (auto done = write_all(file_, tail, part_); !done) return done;
  if (auto done = sync_file(file_, part_); !done) return done;
  if (auto done = rename_path(part_, path_); !done) return done;
  file_ = File();
  failed_ = false;
  auto synced = sync_folder(folder_of(path_));
  if (!synced) synced.error().what += "; the job is whole, but a loss of power may undo its name";
  return synced;
}

}  // namespace binderjet
