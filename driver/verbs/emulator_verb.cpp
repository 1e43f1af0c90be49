// SPDX-License-Identifier: GPL-3.0-or-later
// emulator -o DIR: a printer for people without one. It takes jobs as a real one does and leaves
// what came out of its powder, as a scan would show it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/base/interrupt.h"
#include "driver/emulator/folder_printer.h"
#include "driver/verbs/verbs.h"
#include "slicer/base/error.h"
#include "slicer/base/work.h"

namespace binderjet {
namespace {

struct EmulatorWords {
  std::string out;
  int layer_ms = 0;
  std::string serial = EmulatorOptions().serial;
  std::vector<std::string> faults;
};

FaultPlan parse_plan(const std::vector<std::string>& faults) {
  FaultPlan plan;
  for (const std::string& text : faults) {
    const auto fault = parse_fault(text);
    if (!fault) {
      std::string words;
      for (const PrinterFault one : all_printer_faults()) {
        words += fmt::format(" {}", fault_word(one));
      }
      throw Error(ErrorKind::kUsage, "--fault " + text,
                  "is not FAULT@LAYERxTIMES:MS; the faults are:" + words);
    }
    plan.push_back(*fault);
  }
  return plan;
}

// What became of the jobs: a line for each beginning and end, and a bar between.
class Log {
 public:
  explicit Log(const Console& console) : console_(console) {}

  void say(MeasuredPrints::News news, const PrintedJob& job) {
    using News = MeasuredPrints::News;
    switch (news) {
      case News::kBegins:
        console_.note(fmt::format("job {}: begins, {} layers", job.id, job.layer_count));
        bar_.emplace(console_.work(), "printing job " + job.id, job.layer_count, "layers");
        return;
      case News::kLayer:
        if (bar_) bar_->reach(job.layers);
        return;
      case News::kDone:
      case News::kGone:
        break;
    }
    bar_.reset();
    console_.note(last_line(job));
    nlohmann::ordered_json object;
    object["job"] = job.id;
    object["done"] = job.done;
    object["layers"] = job.layers;
    object["printed"] = nullptr;
    if (job.done && !job.folder.empty()) object["printed"] = job.folder;
    jobs_.push_back(std::move(object));
  }
  const nlohmann::ordered_json& jobs() const { return jobs_; }

 private:
  static std::string last_line(const PrintedJob& job) {
    if (!job.done) {
      return fmt::format("job {}: gone at layer {} of {}", job.id, job.layers, job.layer_count);
    }
    if (job.folder.empty()) {
      return fmt::format("job {}: done, but nothing is written: {}", job.id, job.why_not);
    }
    return fmt::format("job {}: done, {} layers: {}", job.id, job.layers, job.folder);
  }

  const Console& console_;
  std::optional<Stage> bar_;
  nlohmann::ordered_json jobs_ = nlohmann::ordered_json::array();
};

void emulator(const EmulatorWords& words, const Console& console) {
  EmulatorOptions options;
  options.serial = words.serial;
  options.layer_time = std::chrono::milliseconds(words.layer_ms);
  options.plan = parse_plan(words.faults);
  Log log(console);
  try {
    FolderPrinter printer(
        words.out, std::move(options),
        [&log](MeasuredPrints::News news, const PrintedJob& job) { log.say(news, job); });
    console.note(fmt::format("{0}: ready; binderjet print JOB --to emulator:{0}", words.out));
    printer.serve([] { return interrupted(); });
  } catch (const Error& error) {
    // That it is stopped is how it ends.
    if (error.kind() != ErrorKind::kInterrupted) throw;
  }
  console.result({{"out", words.out}, {"jobs", log.jobs()}}, "");
}

}  // namespace

void add_emulator_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand(
      "emulator", "play a printer until Ctrl-C, for print --to emulator:DIR and no printer at all");
  auto words = std::make_shared<EmulatorWords>();
  verb->add_option("-o,--output", words->out,
                   "the folder that it is in; DIR/JOBID is then what it printed, as a stack that "
                   "calibrate --measured takes")
      ->required();
  verb->add_option("--layer-ms", words->layer_ms, "how long it prints at one layer")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--serial", words->serial, "its serial number")->capture_default_str();
  verb->add_option("--fault", words->faults,
                   "what goes wrong: FAULT@LAYERxTIMES:MS, such as gone@12 or silent@5x1:500; may "
                   "be repeated; a wrong word lists the faults. What takes a hand, as plugging it "
                   "in, is mended when the next program comes");
  const auto console = add_console_options(*verb);
  verb->callback([words, console] { emulator(*words, *console); });
}

}  // namespace binderjet
