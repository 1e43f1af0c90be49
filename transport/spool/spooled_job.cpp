// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/spool/spooled_job.h"

#include <fmt/core.h>

#include <utility>

#include "transport/base/file.h"

namespace binderjet {
namespace {

std::string cancel_mark(const Spool& spool, const std::string& id) {
  return spool.incoming(id) + "/cancel";
}

// The job's folder with its header and its journal's first line, all of it on the disk.
Result<SpooledJob> create_job(const Spool& spool, const std::string& id, const JobTicket& ticket,
                              const JobDevice& device) {
  const std::string folder = spool.incoming(id);
  if (auto done = make_folder(folder); !done) return tl::unexpected(done.error());
  Result<JobWriter> writer =
      JobWriter::create_kept(folder + "/job.part", spool.done_job(id), ticket.header);
  if (!writer) return tl::unexpected(writer.error());
  if (auto done = writer->sync(); !done) return tl::unexpected(done.error());
  JournalState state;
  state.layer_count = ticket.layer_count;
  state.name = ticket.name;
  state.source = ticket.source;
  state.to = device.uri;
  state.key = device.number;
  Result<Journal> journal = Journal::create(folder + "/journal", state);
  if (!journal) return tl::unexpected(journal.error());
  if (auto done = sync_folder(folder); !done) return tl::unexpected(done.error());
  if (auto done = sync_folder(folder_of(folder)); !done) return tl::unexpected(done.error());
  return SpooledJob{id, 0, *std::move(writer), *std::move(journal)};
}

}  // namespace

Result<SpooledJob> start_job(const Spool& spool, const File& lock, const JobTicket& ticket,
                             const JobDevice& device) {
  const Result<std::string> id = spool.new_id(lock);
  if (!id) return tl::unexpected(id.error());
  Result<SpooledJob> job = create_job(spool, *id, ticket, device);
  if (!job) static_cast<void>(spool.remove(spool.incoming(*id)));
  return job;
}

Result<SpooledJob> resume_job(const Spool& spool, const std::string& id, const JobTicket& ticket,
                              LayersAre layers, const std::string& where) {
  if (!is_job_id(id)) return tl::unexpected(unknown_job(where, id));
  const auto refuse = [&](const std::string& what) {
    return tl::unexpected(
        Failure{FailureKind::kBadInput, where, fmt::format("job {} {}", id, what)});
  };
  const char* const damaged = "has a damaged journal: cancel it and print again";
  if (path_exists(spool.done_job(id))) return refuse("is done: there is nothing to resume");
  if (path_exists(spool.incoming(id))) return refuse("is being sent by another process");
  const std::string folder = spool.held(id);
  if (!path_exists(folder)) return tl::unexpected(unknown_job(where, id));
  Result<std::optional<Journal>> opened = Journal::open(folder + "/journal");
  if (!opened) return tl::unexpected(opened.error());
  std::optional<Journal> journal = *std::move(opened);
  if (!journal) return refuse("is being looked at by another process; try again");
  const JournalState& state = journal->state();
  if (!state.started) return refuse(damaged);
  if (state.to.empty() != (layers == LayersAre::kInSpool)) {
    return refuse(state.to.empty() ? "lies in this spool alone: resume it with --to spool:"
                                   : "is at " + state.to + ": resume it with --to " + state.to);
  }
  // Looked at before anything is changed: a wrong ticket leaves the job as it is.
  const std::string part = folder + "/job.part";
  {
    const Result<JobReader> stored = JobReader::open(part);
    if (!stored) return tl::unexpected(stored.error());
    if (stored->header() != ticket.header || state.layer_count != ticket.layer_count) {
      return refuse("was started from another job file: give that one");
    }
  }
  // The header alone is there before the first acknowledgement, and always where a device has the
  // layers.
  const bool header_alone = state.bytes == 0;
  if (header_alone && state.acknowledged > 0 && state.to.empty()) return refuse(damaged);
  Result<JobWriter> writer = JobWriter::reopen_kept(
      part, spool.done_job(id),
      header_alone ? job_format::kPreambleBytes + ticket.header.size() : state.bytes);
  if (!writer) return tl::unexpected(writer.error());
  if (!header_alone && writer->last_layer() != state.acknowledged - 1) {
    return refuse("has lost acknowledged layers: cancel it and print again");
  }
  if (auto done = journal->resumed(); !done) return tl::unexpected(done.error());
  if (auto done = spool.unhold(id); !done) return tl::unexpected(done.error());
  writer->move_part(spool.incoming(id) + "/job.part");
  const int next = state.acknowledged;
  return SpooledJob{id, next, *std::move(writer), *std::move(journal)};
}

Result<void> check_next(const SpooledJob& job, int layer, const std::string& where) {
  if (layer == job.next && layer < job.layer_count()) return {};
  return tl::unexpected(Failure{FailureKind::kBadInput, where,
                                fmt::format("layer {} came where layer {} of {} was due", layer,
                                            job.next, job.layer_count())});
}

Result<void> check_all_came(const SpooledJob& job, const std::string& where) {
  if (job.next == job.layer_count()) return {};
  return tl::unexpected(
      Failure{FailureKind::kBadInput, where,
              fmt::format("the job ended before layer {} of {}", job.next, job.layer_count())});
}

Result<void> finish_job(const Spool& spool, SpooledJob job) {
  const Result<File> lock = spool.lock();
  if (!lock) return tl::unexpected(lock.error());
  Result<void> done = job.writer.finish();
  if (done) {
    // The job is there; what is left of its folder the next process can put in order as well.
    static_cast<void>(spool.file_away(job.id));
  } else if (!path_exists(spool.done_job(job.id))) {
    static_cast<void>(job.journal.held(done.error().what));
    static_cast<void>(spool.hold(job.id));
  }  // else the job has its name, its folder could not be synced: the next process does the rest
  return done;
}

void hold_job(const Spool& spool, SpooledJob sent, const std::string& reason) {
  const Result<File> lock = spool.lock();
  SpooledJob job = std::move(sent);  // closed before the lock: whoever resumes it finds it free
  // A full disk may refuse the line; the folder's place says the same.
  static_cast<void>(job.journal.held(reason));
  // Should this fail too, the next process that looks finds a job without a sender and holds it.
  if (lock) static_cast<void>(spool.hold(job.id));
}

bool cancel_asked(const Spool& spool, const SpooledJob& job) {
  return path_exists(cancel_mark(spool, job.id));
}

Result<bool> ask_cancel(const Spool& spool, const std::string& id, const std::string& where) {
  if (!is_job_id(id)) return tl::unexpected(unknown_job(where, id));
  if (path_exists(spool.held(id))) return false;
  if (path_exists(spool.incoming(id))) {
    const Result<File> mark = open_file(cancel_mark(spool, id), O_WRONLY | O_CREAT);
    if (!mark) return tl::unexpected(mark.error());
    return true;
  }
  if (!path_exists(spool.done_job(id))) return tl::unexpected(unknown_job(where, id));
  return tl::unexpected(Failure{FailureKind::kBadInput, where,
                                fmt::format("job {} is done: too late to cancel it", id)});
}

Failure unknown_job(const std::string& where, const std::string& id) {
  return {FailureKind::kBadInput, where,
          fmt::format("no job {} is here; `binderjet status` lists the jobs", id)};
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

}  // namespace binderjet
