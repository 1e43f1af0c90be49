// SPDX-License-Identifier: GPL-3.0-or-later
// Layers go to a backend one after the other, whether they are read from a job or computed.
#include "driver/send/send.h"

#include <fmt/core.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "driver/base/interrupt.h"
#include "driver/base/said.h"
#include "driver/base/transport_errors.h"
#include "driver/emulator/folder_printer.h"
#include "driver/job/encoded_layers.h"
#include "driver/job/job_masks.h"
#include "driver/job/layer_queue.h"
#include "driver/job/parts.h"
#include "driver/job/slice_plan.h"
#include "driver/send/whole_job_file.h"
#include "slicer/base/error.h"
#include "slicer/base/plain_file.h"
#include "transport/emulator/emulator_backend.h"
#include "transport/open/open_backend.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

// All records of a layer, as send() takes them.
std::vector<std::byte> records_of_layer(const JobReader& job, int layer) {
  std::vector<std::byte> records;
  for (const RecordKind kind : {RecordKind::kMask, RecordKind::kColor}) {
    if (!job.contains(kind, layer)) continue;
    const std::vector<std::byte> record = value_or_throw(job.read_record(kind, layer));
    records.insert(records.end(), record.begin(), record.end());
  }
  return records;
}

std::string how_to_resume(Backend& backend, const std::string& id, const std::string& uri) {
  if (id.empty()) return "";
  const auto jobs = backend.status();
  if (!jobs) return "";
  for (const JobStatus& job : *jobs) {
    if (job.id != id || job.state != JobState::kHeld) continue;
    return fmt::format("; job {} is held at layer {} of {}: binderjet resume {} --to {}", id,
                       job.acknowledged, job.layer_count, id, uri);
  }
  return "";
}

// How a job ends that this program has also played the printer for: with it.
std::string lose_job(Backend& backend, const std::string& id, PlayedPrinter& played) {
  if (id.empty()) return "";
  static_cast<void>(backend.cancel(id));
  played.stop();
  return fmt::format("; this program played the printer, so job {} is lost: print it again", id);
}

// The layers of a job in order; each is asked for once.
class LayerSource {
 public:
  virtual ~LayerSource() = default;
  virtual std::vector<std::byte> next(int layer) = 0;
  // What a person should know of the layers; asked for after the last one.
  virtual std::string warning() { return ""; }
};
// Opens the source at the first layer to send.
using OpenSource = std::function<std::unique_ptr<LayerSource>(int first)>;

class FileLayers : public LayerSource {
 public:
  explicit FileLayers(const JobReader& job) : job_(job) {}
  std::vector<std::byte> next(int layer) override { return records_of_layer(job_, layer); }

 private:
  const JobReader& job_;
};

// At most four layers are computed and not yet taken: two in the queue, and a block of two.
constexpr int kStreamBlock = 2;
constexpr std::size_t kQueuedLayers = 2;

class ComputedLayers : public LayerSource {
 public:
  ComputedLayers(const JobHeader& header, std::shared_ptr<const Mesh> mesh,
                 std::shared_ptr<const ColorField> color, int first, const Work& work)
      : queue_(kQueuedLayers),
        mask_rules_(header.profile.mask),
        thread_([this, header, mesh = std::move(mesh), color = std::move(color), first, work] {
          compute(header, mesh, color, first, work);
        }) {}
  ~ComputedLayers() override {
    queue_.close();
    thread_.join();
  }
  std::vector<std::byte> next(int) override { return queue_.pop(); }
  // All is added before the last layer is pushed, and then nothing more.
  std::string warning() override { return rule_warning(rules_, mask_rules_); }

 private:
  void compute(const JobHeader& header, const std::shared_ptr<const Mesh>& mesh,
               const std::shared_ptr<const ColorField>& color, int first, const Work& work) {
    try {
      const auto stream =
          encoded_layers(header, mesh, color, work).layers({first, header.layers()});
      while (stream->rest().size() > 0) {
        for (const Shared<EncodedLayer>& layer : stream->next(kStreamBlock)) {
          rules_.add(layer->rule_changes);
          if (!queue_.push(layer->record)) return;
        }
      }
    } catch (...) {
      queue_.fail(std::current_exception());
    }
  }

  LayerQueue queue_;
  MaskRules mask_rules_;
  RuleTally rules_;
  std::thread thread_;
};

void send_layers(const Console& console, const std::string& uri, const JobTicket& ticket,
                 const std::string& resumed, const OpenSource& open) {
  const auto start_time = std::chrono::steady_clock::now();
  std::unique_ptr<Backend> backend = backend_at(uri);
  const auto played = resumed.empty() ? play_printer(uri) : nullptr;
  if (played) {
    console.note(
        fmt::format("no emulator is running at {}: this program plays the printer for "
                    "this job",
                    *emulator_folder(uri)));
  }
  std::string id = resumed;
  std::uint64_t bytes = 0;
  int first = 0;
  std::string warning;
  bool begun = false;
  try {
    {
      const Stage stage(console.work(), "opening printer");
      if (resumed.empty()) {
        id = value_or_throw(backend->start(ticket));
      } else {
        first = value_or_throw(backend->resume(id, ticket));
      }
    }
    begun = true;
    Stage stage(console.work(), "printing", ticket.layer_count, "layers", first);
    // Nothing is computed where nothing is left to send.
    const auto source = first < ticket.layer_count ? open(first) : nullptr;
    for (int layer = first; layer < ticket.layer_count; ++layer) {
      stage.reach(layer);
      const std::vector<std::byte> records = source->next(layer);
      value_or_throw(backend->send(layer, records));
      bytes += records.size();
    }
    if (source) warning = source->warning();
    value_or_throw(backend->end());
  } catch (const Error& error) {
    // Who waited for the spool's lock no longer must not wait for it again to be told.
    if (!begun && interrupted()) throw;
    backend.reset();  // holds the job
    backend = backend_at(uri);
    throw Error(error.kind(), "",
                error.what() +
                    (played ? lose_job(*backend, id, *played) : how_to_resume(*backend, id, uri)));
  }
  const auto emulated_in = emulator_folder(uri);

  if (!warning.empty()) console.warning(warning);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_time).count();
  nlohmann::ordered_json result;
  result["job"] = id;
  result["to"] = uri;
  result["layers"] = ticket.layer_count;
  result["first_layer_sent"] = first;
  result["bytes_sent"] = bytes;
  result["seconds"] = seconds;
  std::string text = fmt::format("job {}: layers {} to {} of {} sent to {} in {:.1f} s", id, first,
                                 ticket.layer_count - 1, ticket.layer_count, uri, seconds);
  if (emulated_in) {
    const std::string printed = *emulated_in + "/" + id;
    std::error_code error;
    const bool written = fs::exists(printed + "/stack.json", error);  // since before the job's end
    result["printed"] = written ? nlohmann::ordered_json(printed) : nullptr;
    if (written) text += ", printed as " + printed;
    if (!written) {
      console.warning("nothing is written of what it printed: " +
                      (played ? played->why_not() : "the emulator says why"));
    }
  }
  console.result(result, text);
}

std::string absolute_path(const std::string& path) {
  return fs::absolute(path).lexically_normal().string();
}

void send_file(const Console& console, const std::string& job_path, const std::string& uri,
               const std::string& resumed) {
  const JobReader job = [&] {
    const Stage stage(console.work(), "reading job");
    return open_whole_job(job_path);
  }();
  const JobTicket ticket{job.header(), job_layer_count(job), fs::path(job_path).filename().string(),
                         absolute_path(job_path)};
  send_layers(console, uri, ticket, resumed,
              [&job](int) { return std::make_unique<FileLayers>(job); });
}

std::string state_folder() {
  // BINDERJET_STATE is for tests and for systems that keep such things elsewhere.
  for (const auto& [variable, behind] :
       {std::pair("BINDERJET_STATE", ""), std::pair("XDG_STATE_HOME", "/binderjet"),
        std::pair("HOME", "/.local/state/binderjet")}) {
    const char* value = std::getenv(variable);
    if (value == nullptr || *value == '\0') continue;
    const std::string folder = value + std::string(behind);
    std::error_code error;
    fs::create_directories(folder, error);
    return folder + "/usb";
  }
  throw Error(ErrorKind::kUsage, "HOME", "is not set; set it, or BINDERJET_STATE to a folder");
}

// A profile that is wrong is not for this verb to complain about.
std::vector<std::string> usb_models() {
  std::vector<std::string> models;
  for (const std::string& folder : profile_folders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() != ".toml") continue;
      try {
        const std::vector<std::string> usb = load_profile(entry.path().string()).usb;
        models.insert(models.end(), usb.begin(), usb.end());
      } catch (const Error&) {
      }
    }
  }
  return models;
}

}  // namespace

BackendOptions backend_options(bool with_state) {
  BackendOptions options;
  options.stop_asked = [] { return interrupted(); };
  options.say_wait = say_aside;
  if (with_state) {
    options.state_folder = state_folder();
    options.usb_models = usb_models();
  }
  return options;
}

std::unique_ptr<Backend> backend_at(const std::string& uri) {
  const Scheme* scheme = find_scheme(uri);
  Result<std::unique_ptr<Backend>> backend =
      open_backend(uri, backend_options(scheme != nullptr && scheme->needs_state));
  if (!backend) throw Error(ErrorKind::kUsage, backend.error().where, backend.error().what);
  return std::move(*backend);
}

bool is_job_file(const std::string& path) {
  demand_plain_file(path);
  std::array<char, 4> magic{};
  std::ifstream(path, std::ios::binary).read(magic.data(), magic.size());
  return std::string_view(magic.data(), magic.size()) == "BJOB" ||
         fs::path(path).extension() == ".bjob";
}

void send_job(const Console& console, const std::string& job_path, const std::string& uri) {
  send_file(console, job_path, uri, "");
}

void send_parts(const Console& console, const SliceOptions& options, const std::string& uri) {
  const SlicePlan plan = plan_slices(options, console);
  const std::string& part = options.parts.front();
  const JobTicket ticket{to_text(plan.header), plan.header.layers(),
                         fs::path(part).filename().string(), absolute_path(part)};
  send_layers(console, uri, ticket, "", [&](int first) {
    return std::make_unique<ComputedLayers>(plan.header, plan.mesh, plan.color, first,
                                            console.work());
  });
}

void resume_job(const Console& console, const std::string& id, const std::string& source,
                const std::string& uri) {
  if (is_job_file(source)) return send_file(console, source, uri, id);
  const std::string text = value_or_throw(backend_at(uri)->header(id));
  const JobHeader header = parse_job_header(text, "job " + id);
  if (header.color) {
    throw Error(
        ErrorKind::kUsage, source,
        "a job with color cannot be resumed from its model; slice it into a job, cancel this "
        "one and print that");
  }
  const JobTicket ticket{text, header.layers(), fs::path(source).filename().string(), source};
  send_layers(console, uri, ticket, id, [&](int first) {
    return std::make_unique<ComputedLayers>(
        header, reload_parts(header, fs::path(source).parent_path().string(), console.work()),
        nullptr, first, console.work());
  });
}

}  // namespace binderjet
