// SPDX-License-Identifier: GPL-3.0-or-later
// devices, status, cancel and resume: what became of the jobs, and what to do with them.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "driver/base/console.h"
#include "driver/base/interrupt.h"
#include "driver/base/transport_errors.h"
#include "driver/send/send.h"
#include "driver/verbs/verbs.h"
#include "slicer/base/byte_text.h"
#include "slicer/base/error.h"
#include "transport/open/open_backend.h"

namespace binderjet {
namespace {

struct Options {
  std::string id;
  std::string to;
  std::string job;
  double wait_s = 0;
};

nlohmann::ordered_json to_json(const JobStatus& job) {
  nlohmann::ordered_json object;
  object["job"] = job.id;
  object["state"] = job_state_word(job.state);
  object["layers"] = job.layer_count;
  object["acknowledged"] = job.acknowledged;
  object["name"] = job.name;
  object["source"] = job.source;
  object["reason"] = job.reason;
  return object;
}

std::string to_line(const JobStatus& job) {
  return fmt::format("{:>6}  {:8}  {:>6} of {:<6}  {}{}{}", job.id, job_state_word(job.state),
                     job.acknowledged, job.layer_count, visible_line(job.name),
                     job.reason.empty() ? "" : "  ", visible_line(job.reason));
}

std::string lines(const std::vector<std::string>& all) {
  std::string text;
  for (const std::string& line : all) text += (text.empty() ? "" : "\n") + line;
  return text;
}

JobStatus find_job(const Options& options) {
  const auto backend = backend_at(options.to);
  for (JobStatus& job : value_or_throw(backend->status())) {
    if (job.id == options.id) return std::move(job);
  }
  throw Error(ErrorKind::kBadInput, options.to,
              fmt::format("no job {} is here; `binderjet status --to {}` lists the jobs",
                          options.id, options.to));
}

void status(const Console& console, const Options& options) {
  if (!options.id.empty()) {
    const JobStatus job = find_job(options);
    console.result(to_json(job), to_line(job));
    return;
  }
  const auto backend = backend_at(options.to);
  nlohmann::ordered_json result;
  result["jobs"] = nlohmann::ordered_json::array();
  std::vector<std::string> text;
  for (const JobStatus& job : value_or_throw(backend->status())) {
    result["jobs"].push_back(to_json(job));
    text.push_back(to_line(job));
  }
  console.result(result, text.empty() ? "no jobs" : lines(text));
}

void cancel(const Console& console, const Options& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto backend = backend_at(options.to);
  value_or_throw(backend->cancel(options.id));
  nlohmann::ordered_json result;
  result["job"] = options.id;
  result["cancelled"] = true;
  result["seconds"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  console.result(result, fmt::format("job {} is cancelled", options.id));
}

void resume(const Console& console, const Options& options) {
  std::string source = options.job;
  if (source.empty()) source = find_job(options).source;
  if (source.empty()) {
    throw Error(
        ErrorKind::kBadInput, options.to,
        fmt::format("job {} does not say which file it came from: name it with --job", options.id));
  }
  const Scheme* scheme = find_scheme(options.to);
  if (options.wait_s > 0 && scheme != nullptr && scheme->wait != nullptr) {
    const Stage stage(console.work(), "waiting for the printer");
    if (!scheme->wait(options.to, backend_options(scheme->needs_state), options.wait_s)) {
      check_interrupt();
      throw Error(ErrorKind::kDevice, options.to,
                  fmt::format("no such printer was plugged in within {} s", options.wait_s));
    }
  }
  resume_job(console, options.id, source, options.to);
}

void devices(const Console& console, const Options& options) {
  std::vector<DeviceStatus> found;
  if (options.to.empty()) {
    for (const Scheme& scheme : schemes()) {
      if (scheme.list == nullptr) continue;
      for (DeviceStatus& device :
           value_or_throw(scheme.list(backend_options(scheme.needs_state)))) {
        found.push_back(std::move(device));
      }
    }
  } else {
    found.push_back(value_or_throw(backend_at(options.to)->device()));
  }
  nlohmann::ordered_json result;
  result["devices"] = nlohmann::ordered_json::array();
  std::vector<std::string> text;
  for (const DeviceStatus& device : found) {
    nlohmann::ordered_json object;
    object["uri"] = device.uri;
    object["description"] = device.description;
    object["state"] = device.state;
    result["devices"].push_back(std::move(object));
    text.push_back(fmt::format("{}  {}  {}", device.uri, device.state, device.description));
  }
  console.result(
      result, text.empty() ? "no USB printer is connected; --to looks at one place" : lines(text));
}

using Run = void (*)(const Console&, const Options&);

CLI::App* add_verb(CLI::App& program, const char* name, const char* help, Run run,
                   const std::shared_ptr<Options>& options) {
  CLI::App* verb = program.add_subcommand(name, help);
  const auto console = add_console_options(*verb);
  verb->callback([run, console, options] { run(*console, *options); });
  return verb;
}

}  // namespace

void add_queue_verbs(CLI::App& program) {
  const std::string to_help = "where: " + scheme_forms(true);
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(program, "status", "list the jobs, or say how one is", status, options);
  verb->add_option("JOBID", options->id, "the job; without it: all");
  verb->add_option("--to", options->to, to_help)->required();

  options = std::make_shared<Options>();
  verb = add_verb(program, "cancel", "stop a job and remove it", cancel, options);
  verb->add_option("JOBID", options->id, "the job")->required();
  verb->add_option("--to", options->to, to_help)->required();

  options = std::make_shared<Options>();
  verb = add_verb(program, "resume", "go on with a held job from its last acknowledged layer",
                  resume, options);
  verb->add_option("JOBID", options->id, "the job")->required();
  verb->add_option("--to", options->to, to_help)->required();
  verb->add_option("--job", options->job, "its job file or part, if that has moved");
  verb->add_option("--wait", options->wait_s,
                   "wait so many seconds for the printer to be plugged in")
      ->check(CLI::NonNegativeNumber);

  options = std::make_shared<Options>();
  verb = add_verb(program, "devices", "list what can print", devices, options);
  verb->add_option("--to", options->to, to_help);
}

}  // namespace binderjet
