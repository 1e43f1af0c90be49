// SPDX-License-Identifier: GPL-3.0-or-later
// file:PATH takes one job and is then a job file. An unfinished job leaves nothing, so nothing can
// be resumed, and of a queue there is nothing to ask.
#include <fmt/core.h>

#include <optional>
#include <utility>

#include "transport/job/job_file.h"
#include "transport/open/open_backend.h"

namespace binderjet {
namespace {

class FileBackend : public Backend {
 public:
  explicit FileBackend(std::string path) : path_(std::move(path)) {}

  Result<std::string> start(const JobTicket& ticket) override {
    Result<JobWriter> writer = JobWriter::create(path_, ticket.header);
    if (!writer) return tl::unexpected(writer.error());
    writer_ = std::move(*writer);
    layer_count_ = ticket.layer_count;
    return path_;
  }

  Result<int> resume(const std::string&, const JobTicket&) override {
    return fault("keeps nothing of an unfinished job: print it again");
  }

  // Nothing is acknowledged before the end, since nothing would be left before it.
  Result<int> send(int layer, std::span<const std::byte> records) override {
    if (!writer_) return fault("no job was started");
    const int due = writer_->last_layer() + 1;
    if (layer == due && layer < layer_count_) {
      if (auto done = writer_->append(records); !done) {
        writer_.reset();
        return tl::unexpected(done.error());
      }
    }
    if (writer_->last_layer() != layer || layer != due) {
      writer_.reset();
      return fault(
          fmt::format("layer {} came where layer {} of {} was due", layer, due, layer_count_));
    }
    return 0;
  }

  Result<void> end() override {
    if (!writer_) return fault("no job was started");
    const int due = writer_->last_layer() + 1;
    if (due != layer_count_) {
      writer_.reset();
      return fault(fmt::format("the job ended before layer {} of {}", due, layer_count_));
    }
    auto done = writer_->finish();
    writer_.reset();
    return done;
  }

  Result<std::vector<JobStatus>> status() override { return std::vector<JobStatus>(); }

  Result<void> cancel(const std::string& id) override {
    return fault(fmt::format("has no job {}: it keeps whole jobs only", id));
  }

  Result<DeviceStatus> device() override {
    return DeviceStatus{"file:" + path_, "one job file", writer_ ? "processing" : "idle"};
  }

  Result<std::string> header(const std::string&) override {
    return fault("keeps nothing of an unfinished job: print it again");
  }

 private:
  tl::unexpected<Failure> fault(std::string what) const {
    return tl::unexpected(Failure{FailureKind::kBadInput, "file:" + path_, std::move(what)});
  }

  std::string path_;
  std::optional<JobWriter> writer_;
  int layer_count_ = 0;
};

}  // namespace

std::unique_ptr<Backend> make_file_backend(const std::string& path, const BackendOptions&) {
  return std::make_unique<FileBackend>(path);
}

}  // namespace binderjet
