// SPDX-License-Identifier: GPL-3.0-or-later
// One run of the whole program, measured from outside.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/program.h"
#include "transport/job/job_file.h"

namespace binderjet::bench {

struct SliceRun {
  Ran ran;
  nlohmann::json result;     // what slice --json says
  double first_layer_s = 0;  // from the start of the program until the first layer is in the file
};

// How the unfinished job in an otherwise empty folder grows.
class PartWatch {
 public:
  explicit PartWatch(const std::string& folder)
      : watcher_([this, folder](const std::stop_token& stop) {
          const auto start = std::chrono::steady_clock::now();
          while (!stop.stop_requested()) {
            const std::uintmax_t bytes = part_bytes(folder);
            if (bytes > sizes_.back().bytes) {
              const auto now = std::chrono::steady_clock::now();
              sizes_.push_back({bytes, std::chrono::duration<double>(now - start).count()});
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
        }) {}

  // Ends the watch. When the file was first seen to have `bytes`.
  double seconds_until(std::uintmax_t bytes) {
    watcher_.request_stop();
    if (watcher_.joinable()) watcher_.join();
    for (const Size& size : sizes_) {
      if (size.bytes >= bytes) return size.seconds;
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

 private:
  struct Size {
    std::uintmax_t bytes = 0;
    double seconds = 0;
  };

  static std::uintmax_t part_bytes(const std::string& folder) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
      if (entry.path().extension() != ".part") continue;
      const std::uintmax_t bytes = entry.file_size(error);
      if (!error) return bytes;
    }
    return 0;
  }

  std::vector<Size> sizes_ = {{}};
  std::jthread watcher_;
};

// Slices as `words` say; throws what the program said if it failed.
inline SliceRun slice(std::vector<std::string> words) {
  const Workplace place;
  const std::string folder = place / "job";
  const std::string job = folder + "/a.bjob";
  std::filesystem::create_directory(folder);
  words.insert(words.begin(), "slice");
  words.insert(words.end(), {"-o", job, "--json"});
  PartWatch watch(folder);
  SliceRun run;
  run.ran = place.run(words, 3600);
  if (run.ran.status != 0) throw std::runtime_error(run.ran.err);
  run.result = run.ran.json();
  run.first_layer_s = watch.seconds_until(JobReader::open(job).value().entries().front().end());
  return run;
}

// The excess of a job sliced as `words` say, whose part is their first.
inline double excess(std::vector<std::string> words) {
  const Workplace place;
  const std::string part = words.front();
  words.insert(words.begin(), "slice");
  words.insert(words.end(), {"-o", place / "a.bjob", "-q"});
  const Ran sliced = place.run(words, 3600);
  if (sliced.status != 0) throw std::runtime_error(sliced.err);
  const Ran scored = place.run({"score", place / "a.bjob", "--target", part, "--json"}, 3600);
  if (scored.status != 0) throw std::runtime_error(scored.err);
  return scored.json()["excess"].get<double>();
}

}  // namespace binderjet::bench
