// SPDX-License-Identifier: GPL-3.0-or-later
// What takes a job, whatever it is: a device, a folder or a file. open/ chooses one by its URI.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "transport/base/result.h"

namespace binderjet {

struct JobTicket {
  std::string header;  // as in the job file, not looked into
  int layer_count = 0;
  std::string name;    // for people
  std::string source;  // what a resume goes on from, a job file or the first model; may be empty
};

enum class JobState {
  kIncoming,  // is being sent
  kHeld,      // stopped before its end; waits for resume or cancel
  kDone,      // all of it is there
};
const char* job_state_word(JobState state);

struct JobStatus {
  std::string id;
  JobState state = JobState::kIncoming;
  int layer_count = 0;
  int acknowledged = 0;  // layers 0 to acknowledged - 1 survive anything
  std::string name;
  std::string source;
  std::string reason;  // why it is held
};

struct DeviceStatus {
  std::string uri;
  std::string description;
  std::string state;  // IPP's word: idle, processing, stopped
};

// One job at a time goes through a backend: start or resume, send each layer in order, end.
// Destroyed before the end, or after a Failure of send or end, it holds the job where it can be
// resumed and removes it where it cannot.
class Backend {
 public:
  virtual ~Backend() = default;

  // Opens a job and returns its id, unique at this backend.
  virtual Result<std::string> start(const JobTicket& ticket) = 0;
  // Goes on with a held job; returns the first layer to send. A ticket with another header or
  // layer count is kBadInput.
  virtual Result<int> resume(const std::string& id, const JobTicket& ticket) = 0;
  // Takes all records of one layer, ascending by kind. Returns how many layers are acknowledged:
  // they survive anything. The backend may lag behind what was sent, and decides how far.
  virtual Result<int> send(int layer, std::span<const std::byte> records) = 0;
  // On return the whole job is there and survives anything.
  virtual Result<void> end() = 0;

  // All jobs, oldest first; from any process.
  virtual Result<std::vector<JobStatus>> status() = 0;
  // Removes a held job, and makes the sender of an incoming one stop with kInterrupted.
  virtual Result<void> cancel(const std::string& id) = 0;
  virtual Result<DeviceStatus> device() = 0;
  // The header that an unfinished job was started with.
  virtual Result<std::string> header(const std::string& id) = 0;
};

// Told what is waited for where that takes longer than usual; once per wait.
using SayWait = std::function<void(const std::string& what)>;

// What a backend may be given; open/ says which of it a scheme reads.
struct BackendOptions {
  std::string state_folder;  // where jobs for devices keep their journals; its parent exists
  std::vector<std::string> usb_models;  // "vid:pid word..." that usb: may mean, with their quirks
  std::function<bool()> stop_asked;     // asked during waits; true ends them with kInterrupted
  SayWait say_wait;
};

}  // namespace binderjet
