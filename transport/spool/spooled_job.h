// SPDX-License-Identifier: GPL-3.0-or-later
// A job in a spool, from its start or resume to its end: what all backends with a spool do alike.
// `where` is the backend's URI, for messages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "transport/base/backend.h"
#include "transport/base/result.h"
#include "transport/job/job_file.h"
#include "transport/spool/journal.h"
#include "transport/spool/spool.h"

namespace binderjet {

// A job that this process sends.
struct SpooledJob {
  std::string id;
  int next = 0;      // the layer that comes next
  JobWriter writer;  // of its part file
  Journal journal;   // locked: nobody else sends it

  int layer_count() const { return journal.state().layer_count; }
};

// Where a job goes whose layers the spool does not keep.
struct JobDevice {
  std::string uri;
  std::uint64_t number = 0;  // the job's, there; not 0
};

// A new job in incoming/; after a Failure there is none. With the spool's lock.
Result<SpooledJob> start_job(const Spool& spool, const File& lock, const JobTicket& ticket,
                             const JobDevice& device = {});
// A held job, back in incoming/, at the first layer that its journal does not acknowledge. It is
// kBadInput, and nothing has changed, if the job is not held, is somebody else's at the moment, has
// a damaged journal, was started with another ticket, or has its layers in another place: a
// device's job can only go on at its device, for the spool has none of its layers. With the spool's
// lock.
enum class LayersAre { kInSpool, kAtDevice };
Result<SpooledJob> resume_job(const Spool& spool, const std::string& id, const JobTicket& ticket,
                              LayersAre layers, const std::string& where);

// kBadInput unless `layer` comes next.
Result<void> check_next(const SpooledJob& job, int layer, const std::string& where);
// kBadInput unless all layers have come.
Result<void> check_all_came(const SpooledJob& job, const std::string& where);

// Gives the whole job its name in done/. Takes the spool's lock.
Result<void> finish_job(const Spool& spool, SpooledJob job);
// Moves the job to held/, with the reason in its journal. Takes the spool's lock.
void hold_job(const Spool& spool, SpooledJob sent, const std::string& reason);

// Somebody has asked the job's sender to stop.
bool cancel_asked(const Spool& spool, const SpooledJob& job);
// Asks the sender of an incoming job to stop: true. A held job has none: false. Any other is
// kBadInput. With the spool's lock.
Result<bool> ask_cancel(const Spool& spool, const std::string& id, const std::string& where);

// kBadInput: no such job.
Failure unknown_job(const std::string& where, const std::string& id);
// The header of a held job; kBadInput if there is none.
Result<std::string> held_header(const Spool& spool, const std::string& id,
                                const std::string& where);

}  // namespace binderjet
