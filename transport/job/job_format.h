// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of a .bjob file: where every field stands and what guards it.
//
// All integers are unsigned and little-endian; checksums are XXH3-64 with the seed 0 unless said.
//
//   preamble, 32 bytes      magic 8 "BJOB\r\n\x1a\n" | version 4 | 0 4 | header length 8 |
//                           checksum 8 of the header, seeded with that of the 24 bytes before
//   header                  opaque here: the driver's JSON
//   record, 40 + n bytes    sync 4 "BJLR" | kind 1 | 0 3 | layer 4 | payload length 4 |
//                           frame length n 4 | 0 4 | checksum 8 of the frame |
//                           checksum 8 of the 32 bytes before | one zstd frame, n bytes
//   ...                     records ascend by layer, then by kind, and touch each other
//   index, 8 + 32 m bytes   sync 4 "BJIX" | 0 4 | for each record: kind 1 | 0 3 | layer 4 |
//                           offset 8 | length 8 (record and frame) | checksum 8 of the frame
//   trailer, 40 bytes       sync 4 "BJEN" | 0 4 | index offset 8 | record count m 8 |
//                           checksum 8 of the index, seeded with the preamble's checksum |
//                           checksum 8 of the 32 bytes before
//
// The frame has a checksum beside zstd's own, because zstd ignores some bits of its frames. The
// trailer's checksum of the index covers every other checksum: it names the job as a whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace binderjet {

enum class RecordKind : std::uint8_t { kMask = 1, kColor = 2 };

namespace job_format {

inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::size_t kPreambleBytes = 32;
inline constexpr std::size_t kRecordHeadBytes = 40;
inline constexpr std::size_t kIndexHeadBytes = 8;
inline constexpr std::size_t kIndexEntryBytes = 32;
inline constexpr std::size_t kTrailerBytes = 40;

// A length in a file is a claim; these bound what a wrong one can cost.
inline constexpr std::uint64_t kMaxHeaderBytes = std::uint64_t{64} << 20;
inline constexpr std::uint64_t kMaxPayloadBytes = std::uint64_t{1} << 30;
inline constexpr std::uint64_t kMaxFrameBytes = kMaxPayloadBytes + (kMaxPayloadBytes >> 7);
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 42;
inline constexpr std::uint32_t kMaxLayer = 0x7fffffff;

struct Preamble {
  std::uint32_t version = 0;
  std::uint64_t header_bytes = 0;
  std::uint64_t checksum = 0;
};

struct RecordHead {
  RecordKind kind = RecordKind::kMask;
  std::uint32_t layer = 0;
  std::uint32_t payload_bytes = 0;
  std::uint32_t frame_bytes = 0;
  std::uint64_t frame_checksum = 0;
};

struct IndexEntry {
  RecordKind kind = RecordKind::kMask;
  std::uint32_t layer = 0;
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;  // record head and frame
  std::uint64_t frame_checksum = 0;

  std::uint64_t end() const { return offset + bytes; }
  // Records stand in this order.
  bool before(const IndexEntry& other) const {
    return layer != other.layer ? layer < other.layer : kind < other.kind;
  }
};

struct Trailer {
  std::uint64_t index_offset = 0;
  std::uint64_t record_count = 0;
  std::uint64_t index_checksum = 0;
};

// Preamble and header, ready to write.
std::vector<std::byte> encode_preamble(std::string_view header);
// Nothing if the magic is wrong. The checksum is checked by preamble_checksum once the header is
// read.
std::optional<Preamble> decode_preamble(std::span<const std::byte> bytes);
// `bytes` is the preamble and the header.
std::uint64_t preamble_checksum(std::span<const std::byte> bytes);

std::vector<std::byte> encode_record_head(const RecordHead& head);
// Nothing if sync, checksum or a bound is wrong.
std::optional<RecordHead> decode_record_head(std::span<const std::byte> bytes);

// Index and trailer, ready to write.
std::vector<std::byte> encode_index(std::span<const IndexEntry> entries, std::uint64_t index_offset,
                                    std::uint64_t preamble_checksum);
std::optional<Trailer> decode_trailer(std::span<const std::byte> bytes);
// Nothing unless the records touch each other from `first_offset` to the index and are in order.
std::optional<std::vector<IndexEntry>> decode_index(std::span<const std::byte> bytes,
                                                    const Trailer& trailer,
                                                    std::uint64_t first_offset,
                                                    std::uint64_t preamble_checksum);
bool is_index_sync(std::span<const std::byte> bytes);

}  // namespace job_format
}  // namespace binderjet
