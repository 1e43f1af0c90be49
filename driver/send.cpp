// SPDX-License-Identifier: GPL-3.0-or-later
// A job file's layers, read and checked one after the other, go to a backend.
#include "driver/send.h"

#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <utility>
#include <vector>

#include "driver/result.h"
#include "driver/sent_job.h"
#include "slicer/error.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

// All records of a layer, as send() takes them.
std::vector<std::byte> records_of_layer(const JobReader& job, int layer) {
  std::vector<std::byte> records;
  for (const RecordKind kind : {RecordKind::kMask, RecordKind::kColor}) {
    if (!job.contains(kind, layer)) continue;
    const std::vector<std::byte> record = value_or_throw(job.read_record(kind, layer));
    records.insert(records.end(), record.begin(), record.end());
  }
  return records;
}

std::string how_to_resume(Backend& backend, const std::string& id, const std::string& uri) {
  const auto jobs = backend.status();
  if (!jobs) return "";
  for (const JobStatus& job : *jobs) {
    if (job.id != id || job.state != JobState::kHeld) continue;
    return fmt::format("; job {} is held at layer {} of {}: binderjet resume {} --to {}", id,
                       job.acknowledged, job.layer_count, id, uri);
  }
  return "";
}

}  // namespace

std::unique_ptr<Backend> backend_at(const std::string& uri) {
  Result<std::unique_ptr<Backend>> backend = open_backend(uri);
  if (!backend) throw Error(ErrorKind::kUsage, backend.error().where, backend.error().what);
  return std::move(*backend);
}

void send_job(const Console& console, const std::string& job_path, const std::string& uri,
              const std::optional<std::string>& resumed) {
  const auto start_time = std::chrono::steady_clock::now();
  const JobReader job = open_whole_job(job_path);
  JobTicket ticket;
  ticket.header = job.header();
  ticket.layer_count = job_layer_count(job);
  ticket.name = fs::path(job_path).filename().string();
  ticket.source = fs::absolute(job_path).lexically_normal().string();

  std::unique_ptr<Backend> backend = backend_at(uri);
  std::string id;
  std::uint64_t bytes = 0;
  int first = 0;
  try {
    if (resumed) {
      id = *resumed;
      first = value_or_throw(backend->resume(id, ticket));
    } else {
      id = value_or_throw(backend->start(ticket));
    }
    Progress progress(console, "printing", ticket.layer_count);
    for (int layer = first; layer < ticket.layer_count; ++layer) {
      progress.advance(layer);
      const std::vector<std::byte> records = records_of_layer(job, layer);
      value_or_throw(backend->send(layer, records));
      bytes += records.size();
    }
    value_or_throw(backend->end());
  } catch (const Error& error) {
    backend.reset();  // holds the job
    backend = backend_at(uri);
    throw Error(error.kind(), "", error.what() + how_to_resume(*backend, id, uri));
  }

  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_time).count();
  nlohmann::ordered_json result;
  result["job"] = id;
  result["to"] = uri;
  result["layers"] = ticket.layer_count;
  result["first_layer_sent"] = first;
  result["bytes_sent"] = bytes;
  result["seconds"] = seconds;
  console.result(result,
                 fmt::format("job {}: layers {} to {} of {} sent to {} in {:.1f} s", id, first,
                             ticket.layer_count - 1, ticket.layer_count, uri, seconds));
}

}  // namespace binderjet
