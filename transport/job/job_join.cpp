// SPDX-License-Identifier: GPL-3.0-or-later
// The shares of a job put together: their records in the order of the whole job.
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "transport/job/job_file.h"

namespace binderjet {
namespace {

struct Piece {
  job_format::IndexEntry entry;
  std::size_t share;
};

Failure bad_share(const std::string& where, std::string what) {
  return {FailureKind::kBadInput, where, std::move(what)};
}

std::string layer_range(std::int64_t first, std::int64_t last) {
  return first == last ? fmt::format("layer {}", first)
                       : fmt::format("layers {} to {}", first, last);
}

// Each layer from 0 to layer_count - 1 has a mask, and all its records are in one share.
Result<void> check_layers(const std::vector<Piece>& pieces, const std::vector<JobReader>& readers,
                          const std::string& out, int layer_count) {
  std::int64_t next = 0;  // the lowest layer whose mask has not come yet
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const job_format::IndexEntry& entry = pieces[i].entry;
    const std::int64_t layer = entry.layer;
    const std::string& share = readers[pieces[i].share].path();
    if (layer >= layer_count) {
      return tl::unexpected(bad_share(
          share, fmt::format("layer {} is above the job's {} layers", layer, layer_count)));
    }
    if (i > 0 && pieces[i - 1].entry.layer == layer && pieces[i - 1].share != pieces[i].share) {
      return tl::unexpected(
          bad_share(share, fmt::format("layer {} is in {} too: give each layer once", layer,
                                       readers[pieces[i - 1].share].path())));
    }
    if (entry.kind != RecordKind::kMask) continue;
    if (layer != next) {
      return tl::unexpected(bad_share(out, fmt::format("{} of {} missing: slice that share too",
                                                       layer_range(next, layer - 1), layer_count)));
    }
    ++next;
  }
  if (next != layer_count) {
    return tl::unexpected(
        bad_share(out, fmt::format("{} of {} missing: slice that share too",
                                   layer_range(next, layer_count - 1), layer_count)));
  }
  return {};
}

}  // namespace

Result<void> join_jobs(const std::vector<std::string>& shares, const std::string& out,
                       int layer_count, const std::function<void(int layer)>& on_layer) {
  if (shares.empty()) return tl::unexpected(bad_share(out, "no shares to join"));
  std::vector<JobReader> readers;
  std::vector<Piece> pieces;
  for (const std::string& share : shares) {
    Result<JobReader> reader = JobReader::open(share);
    if (!reader) return tl::unexpected(reader.error());
    if (!reader->whole()) return tl::unexpected(bad_share(share, reader->damage()));
    if (!readers.empty() && reader->header() != readers.front().header()) {
      return tl::unexpected(bad_share(
          share, fmt::format("not of the same job as {}: slice both with the same part, profile "
                             "and options",
                             shares.front())));
    }
    for (const job_format::IndexEntry& entry : reader->entries()) {
      pieces.push_back({entry, readers.size()});
    }
    readers.push_back(std::move(*reader));
  }
  // Stable, so that what two shares both hold is always reported for the later one.
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.entry.before(b.entry); });
  if (auto right = check_layers(pieces, readers, out, layer_count); !right) return right;

  Result<JobWriter> writer = JobWriter::create(out, readers.front().header());
  if (!writer) return tl::unexpected(writer.error());
  for (const Piece& piece : pieces) {
    if (on_layer) on_layer(static_cast<int>(piece.entry.layer));
    const auto record =
        readers[piece.share].read_record(piece.entry.kind, static_cast<int>(piece.entry.layer));
    if (!record) return tl::unexpected(record.error());
    if (auto done = writer->append(*record); !done) return done;
  }
  return writer->finish();
}

}  // namespace binderjet
