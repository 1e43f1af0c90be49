// SPDX-License-Identifier: GPL-3.0-or-later
// A folder that takes jobs as a printer does, from several processes at once.
//
//   last-id          the highest job id given out; its lock orders all changes of the folders below
//   incoming/ID/     a job on its way: job.part (a job file without its end), journal, and an empty
//                    file `cancel` once somebody wants it stopped
//   held/ID/         a job whose sender stopped or died: the same; resume takes it back to incoming
//   done/ID.bjob     a whole job, which got this name by one rename of a synced file
//   done/ID.journal  its journal
//
// Who sends a job holds its journal's lock. Nothing under incoming/ that is unlocked has a sender.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "transport/base/backend.h"
#include "transport/base/file.h"
#include "transport/base/result.h"
#include "transport/spool/journal.h"

namespace binderjet {

class Spool {
 public:
  explicit Spool(std::string folder, SayWait say_wait = {})
      : folder_(std::move(folder)), say_wait_(std::move(say_wait)) {}

  const std::string& folder() const { return folder_; }
  std::string incoming(const std::string& id) const { return folder_ + "/incoming/" + id; }
  std::string held(const std::string& id) const { return folder_ + "/held/" + id; }
  std::string done_job(const std::string& id) const { return folder_ + "/done/" + id + ".bjob"; }
  std::string done_journal(const std::string& id) const {
    return folder_ + "/done/" + id + ".journal";
  }

  // Makes the folders; the spool's own folder may be new, its parent may not: a mistyped path or
  // a disk that is not mounted shall not become a spool.
  Result<void> create() const;
  // Waits for the lock, says so if that takes a second, and puts in order what dead senders left;
  // the lock lasts as long as the File. A signal ends the wait with a Failure.
  Result<File> lock() const;

  // All below: only with the lock.
  // An id that was never given out here before.
  Result<std::string> new_id(const File& lock) const;
  // From incoming to held.
  Result<void> hold(const std::string& id) const;
  // From held to incoming.
  Result<void> unhold(const std::string& id) const;
  // Behind the rename of the job to its final name: the journal follows, the folder goes.
  Result<void> file_away(const std::string& id) const;
  // Of a job in incoming or held; its journal goes first, so that what a death in between leaves
  // is known to be rubbish.
  Result<void> remove(const std::string& job_folder) const;
  Result<std::vector<JobStatus>> jobs() const;

  // The unfinished job that went to a device under this number, or "". Also without the lock, for
  // who knows that the job's sender waits.
  std::string id_at_device(std::uint64_t number) const;

 private:
  Result<void> wait_for(const File& counter) const;
  void recover() const;
  std::vector<std::string> ids(const std::string& place) const;  // ascending by number

  std::string folder_;
  SayWait say_wait_;
};

// Ids are decimal numbers without leading zeros; anything else could be a path.
bool is_job_id(const std::string& text);

// What spool:FOLDER means.
std::unique_ptr<Backend> make_spool_backend(const std::string& folder,
                                            const BackendOptions& options);

}  // namespace binderjet
