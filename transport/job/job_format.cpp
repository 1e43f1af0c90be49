// SPDX-License-Identifier: GPL-3.0-or-later
// Encoding and decoding of the parts of a .bjob file, without any file.
#include "transport/job/job_format.h"

#include <algorithm>
#include <array>

#include "transport/base/bytes.h"

namespace binderjet::job_format {
namespace {

constexpr std::array<unsigned char, 8> kMagic = {'B', 'J', 'O', 'B', '\r', '\n', 0x1a, '\n'};
constexpr std::uint32_t kRecordSync = 0x524c4a42;   // "BJLR"
constexpr std::uint32_t kIndexSync = 0x58494a42;    // "BJIX"
constexpr std::uint32_t kTrailerSync = 0x4e454a42;  // "BJEN"

void put_kind(std::vector<std::byte>& out, RecordKind kind) {
  put_le<std::uint32_t>(out, static_cast<std::uint8_t>(kind));
}

// Kinds this version does not know are kept and checked all the same; only 0 is nobody's.
std::optional<RecordKind> get_kind(std::span<const std::byte> in, std::size_t at) {
  const auto value = get_le<std::uint32_t>(in, at);
  if (value == 0 || value > 0xff) return std::nullopt;
  return static_cast<RecordKind>(value);
}

}  // namespace

std::vector<std::byte> encode_preamble(std::string_view header) {
  std::vector<std::byte> out;
  out.reserve(kPreambleBytes + header.size());
  for (const unsigned char c : kMagic) out.push_back(static_cast<std::byte>(c));
  put_le<std::uint32_t>(out, kVersion);
  put_le<std::uint32_t>(out, 0);
  put_le<std::uint64_t>(out, header.size());
  put_le<std::uint64_t>(out, 0);
  const std::span<const std::byte> text = as_bytes(header);
  out.insert(out.end(), text.begin(), text.end());
  std::vector<std::byte> sum;
  put_le<std::uint64_t>(sum, preamble_checksum(out));
  std::copy(sum.begin(), sum.end(), out.begin() + 24);
  return out;
}

std::optional<Preamble> decode_preamble(std::span<const std::byte> bytes) {
  if (bytes.size() < kPreambleBytes) return std::nullopt;
  for (std::size_t i = 0; i < kMagic.size(); ++i) {
    if (bytes[i] != static_cast<std::byte>(kMagic[i])) return std::nullopt;
  }
  return Preamble{get_le<std::uint32_t>(bytes, 8), get_le<std::uint64_t>(bytes, 16),
                  get_le<std::uint64_t>(bytes, 24)};
}

std::uint64_t preamble_checksum(std::span<const std::byte> bytes) {
  return checksum(bytes.subspan(kPreambleBytes), checksum(bytes.first(24)));
}

std::vector<std::byte> encode_record_head(const RecordHead& head) {
  std::vector<std::byte> out;
  put_le<std::uint32_t>(out, kRecordSync);
  put_kind(out, head.kind);
  put_le<std::uint32_t>(out, head.layer);
  put_le<std::uint32_t>(out, head.payload_bytes);
  put_le<std::uint32_t>(out, head.frame_bytes);
  put_le<std::uint32_t>(out, 0);
  put_le<std::uint64_t>(out, head.frame_checksum);
  put_le<std::uint64_t>(out, checksum(out));
  return out;
}

std::optional<RecordHead> decode_record_head(std::span<const std::byte> bytes) {
  if (bytes.size() < kRecordHeadBytes || get_le<std::uint32_t>(bytes, 0) != kRecordSync ||
      get_le<std::uint32_t>(bytes, 20) != 0 ||
      get_le<std::uint64_t>(bytes, 32) != checksum(bytes.first(32))) {
    return std::nullopt;
  }
  const std::optional<RecordKind> kind = get_kind(bytes, 4);
  const RecordHead head{kind.value_or(RecordKind::kMask), get_le<std::uint32_t>(bytes, 8),
                        get_le<std::uint32_t>(bytes, 12), get_le<std::uint32_t>(bytes, 16),
                        get_le<std::uint64_t>(bytes, 24)};
  if (!kind || head.layer > kMaxLayer || head.payload_bytes > kMaxPayloadBytes ||
      head.frame_bytes > kMaxFrameBytes) {
    return std::nullopt;
  }
  return head;
}

std::vector<std::byte> encode_index(std::span<const IndexEntry> entries, std::uint64_t index_offset,
                                    std::uint64_t preamble_checksum) {
  std::vector<std::byte> out;
  out.reserve(kIndexHeadBytes + entries.size() * kIndexEntryBytes + kTrailerBytes);
  put_le<std::uint32_t>(out, kIndexSync);
  put_le<std::uint32_t>(out, 0);
  for (const IndexEntry& entry : entries) {
    put_kind(out, entry.kind);
    put_le<std::uint32_t>(out, entry.layer);
    put_le<std::uint64_t>(out, entry.offset);
    put_le<std::uint64_t>(out, entry.bytes);
    put_le<std::uint64_t>(out, entry.frame_checksum);
  }
  const std::uint64_t index_checksum = checksum(out, preamble_checksum);
  const std::size_t trailer_at = out.size();
  put_le<std::uint32_t>(out, kTrailerSync);
  put_le<std::uint32_t>(out, 0);
  put_le<std::uint64_t>(out, index_offset);
  put_le<std::uint64_t>(out, entries.size());
  put_le<std::uint64_t>(out, index_checksum);
  put_le<std::uint64_t>(out, checksum(std::span<const std::byte>(out).subspan(trailer_at)));
  return out;
}

std::optional<Trailer> decode_trailer(std::span<const std::byte> bytes) {
  if (bytes.size() < kTrailerBytes || get_le<std::uint32_t>(bytes, 0) != kTrailerSync ||
      get_le<std::uint32_t>(bytes, 4) != 0 ||
      get_le<std::uint64_t>(bytes, 32) != checksum(bytes.first(32))) {
    return std::nullopt;
  }
  return Trailer{get_le<std::uint64_t>(bytes, 8), get_le<std::uint64_t>(bytes, 16),
                 get_le<std::uint64_t>(bytes, 24)};
}

std::optional<std::vector<IndexEntry>> decode_index(std::span<const std::byte> bytes,
                                                    const Trailer& trailer,
                                                    std::uint64_t first_offset,
                                                    std::uint64_t preamble_checksum) {
  if (!is_index_sync(bytes) || get_le<std::uint32_t>(bytes, 4) != 0 ||
      (bytes.size() - kIndexHeadBytes) / kIndexEntryBytes != trailer.record_count ||
      (bytes.size() - kIndexHeadBytes) % kIndexEntryBytes != 0 ||
      checksum(bytes, preamble_checksum) != trailer.index_checksum) {
    return std::nullopt;
  }
  std::vector<IndexEntry> entries;
  entries.reserve(static_cast<std::size_t>(trailer.record_count));
  std::uint64_t offset = first_offset;
  for (std::size_t at = kIndexHeadBytes; at < bytes.size(); at += kIndexEntryBytes) {
    const std::optional<RecordKind> kind = get_kind(bytes, at);
    const IndexEntry entry{kind.value_or(RecordKind::kMask), get_le<std::uint32_t>(bytes, at + 4),
                           get_le<std::uint64_t>(bytes, at + 8),
                           get_le<std::uint64_t>(bytes, at + 16),
                           get_le<std::uint64_t>(bytes, at + 24)};
    if (!kind || entry.layer > kMaxLayer || entry.offset != offset ||
        entry.bytes < kRecordHeadBytes || entry.bytes > kRecordHeadBytes + kMaxFrameBytes ||
        (!entries.empty() && !entries.back().before(entry))) {
      return std::nullopt;
    }
    offset = entry.end();
    entries.push_back(entry);
  }
  if (offset != trailer.index_offset) return std::nullopt;
  return entries;
}

bool is_index_sync(std::span<const std::byte> bytes) {
  return bytes.size() >= kIndexHeadBytes && get_le<std::uint32_t>(bytes, 0) == kIndexSync;
}

}  // namespace binderjet::job_format
