// SPDX-License-Identifier: GPL-3.0-or-later
// The few words of a job's header that sending and joining need.
#include "driver/send/whole_job_file.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "driver/base/transport_errors.h"
#include "slicer/base/error.h"

namespace binderjet {

int job_layer_count(const JobReader& job) {
  const auto header = nlohmann::json::parse(job.header(), nullptr, false);
  if (header.is_object()) {
    const auto size = header.find("size_px");
    if (size != header.end() && size->is_array() && size->size() == 3 &&
        (*size)[2].is_number_integer()) {
      const auto layers = (*size)[2].get<std::int64_t>();
      if (layers > 0 && layers <= job_format::kMaxLayer) return static_cast<int>(layers);
    }
  }
  throw Error(ErrorKind::kBadInput, job.path(),
              "its header does not say how many layers it has: slice again");
}

JobReader open_whole_job(const std::string& path) {
  JobReader job = value_or_throw(JobReader::open(path));
  if (!job.whole()) throw Error(ErrorKind::kBadInput, path, job.damage());
  const int layer_count = job_layer_count(job);
  const std::vector<int> layers = job.layers(RecordKind::kMask);
  // Layers ascend, so the first that is not its own number has a gap before it.
  int missing = 0;
  while (missing < static_cast<int>(layers.size()) &&
         layers[static_cast<std::size_t>(missing)] == missing) {
    ++missing;
  }
  if (missing < layer_count) {
    throw Error(ErrorKind::kBadInput, path,
                fmt::format("layer {} of {} is missing, so it is a share of a job: join its shares "
                            "with `binderjet join`",
                            missing, layer_count));
  }
  if (job.entries().back().layer >= static_cast<std::uint32_t>(layer_count)) {
    throw Error(ErrorKind::kBadInput, path,
                fmt::format("has more layers than the {} of its header: slice again", layer_count));
  }
  const auto header = nlohmann::json::parse(job.header(), nullptr, false);
  if (header.contains("color") &&
      static_cast<int>(job.layers(RecordKind::kColor).size()) != layer_count) {
    throw Error(ErrorKind::kBadInput, path,
                "lacks color in layers, which its header promises: slice again");
  }
  return job;
}

}  // namespace binderjet
