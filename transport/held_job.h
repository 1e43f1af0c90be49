// SPDX-License-Identifier: GPL-3.0-or-later
// A job that waits in a spool until somebody goes on with it: what all backends with a spool ask
// before they do. `where` is the backend's URI, for messages.
#pragma once

#include <string>

#include "transport/backend.h"
#include "transport/job_file.h"
#include "transport/journal.h"
#include "transport/result.h"
#include "transport/spool.h"

namespace binderjet {

Fault unknown_job(const std::string& where, const std::string& id);
// kBadInput: "job 3 is done: ...".
Fault cannot_resume(const std::string& where, const std::string& id, const std::string& what);

// The header of a held job; kBadInput if there is none.
Result<std::string> held_header(const Spool& spool, const std::string& id,
                                const std::string& where);

struct HeldJob {
  std::string id;
  std::string part;  // its layers so far: a job file without its end
  Journal journal;   // locked: nobody else sends it
};

// Both with the spool's lock. The first changes nothing, and is kBadInput if the job is not held,
// is somebody else's at the moment, has a damaged journal or was started with another ticket.
Result<HeldJob> open_held_job(const Spool& spool, const std::string& id, const JobTicket& ticket,
                              const std::string& where);
// From held to incoming; `writer` writes on there.
Result<void> take_up(const Spool& spool, HeldJob& job, JobWriter& writer);

}  // namespace binderjet
