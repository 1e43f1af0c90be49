// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/held_job.h"

#include <fmt/core.h>

#include <optional>
#include <utility>

#include "transport/file.h"

namespace binderjet {

Fault unknown_job(const std::string& where, const std::string& id) {
  return {FaultKind::kBadInput, where,
          fmt::format("no job {} is here; `binderjet status` lists the jobs", id)};
}

Fault cannot_resume(const std::string& where, const std::string& id, const std::string& what) {
  return {FaultKind::kBadInput, where, fmt::format("job {} {}", id, what)};
}

Result<std::string> held_header(const Spool& spool, const std::string& id,
                                const std::string& where) {
  if (!is_job_id(id) || !path_exists(spool.held(id))) {
    return tl::unexpected(unknown_job(where, id));
  }
  const Result<JobReader> job = JobReader::open(spool.held(id) + "/job.part");
  if (!job) return tl::unexpected(job.error());
  return job->header();
}

Result<HeldJob> open_held_job(const Spool& spool, const std::string& id, const JobTicket& ticket,
                              const std::string& where) {
  if (!is_job_id(id)) return tl::unexpected(unknown_job(where, id));
  const auto refuse = [&](const char* what) {
    return tl::unexpected(cannot_resume(where, id, what));
  };
  if (path_exists(spool.done_job(id))) return refuse("is done: there is nothing to resume");
  if (path_exists(spool.incoming(id))) return refuse("is being sent by another process");
  const std::string folder = spool.held(id);
  if (!path_exists(folder)) return tl::unexpected(unknown_job(where, id));
  Result<std::optional<Journal>> opened = Journal::open(folder + "/journal");
  if (!opened) return tl::unexpected(opened.error());
  std::optional<Journal> journal = *std::move(opened);
  if (!journal) return refuse("is being looked at by another process; try again");
  const JournalState& state = journal->state();
  if (!state.started) return refuse("has a damaged journal: cancel it and print again");
  // Looked at before anything is changed: a wrong ticket leaves the job as it is.
  const std::string part = folder + "/job.part";
  const Result<JobReader> stored = JobReader::open(part);
  if (!stored) return tl::unexpected(stored.error());
  if (stored->header() != ticket.header || state.layer_count != ticket.layer_count) {
    return refuse("was started from another job file: give that one");
  }
  return HeldJob{id, part, *std::move(journal)};
}

Result<void> take_up(const Spool& spool, HeldJob& job, JobWriter& writer) {
  if (auto done = job.journal.resumed(); !done) return done;
  if (auto done = spool.unhold(job.id); !done) return done;
  writer.move_part(spool.incoming(job.id) + "/job.part");
  return {};
}

}  // namespace binderjet
