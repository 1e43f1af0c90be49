// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/emulator/measured_prints.h"

#include <fmt/core.h>

#include <utility>

#include "slicer/base/error.h"
#include "transport/emulator/emulator_backend.h"
#include "transport/spool/spool.h"

namespace binderjet {

MeasuredPrints::MeasuredPrints(std::string folder, Say say)
    : folder_(std::move(folder)), say_(std::move(say)) {}

MeasuredPrints::~MeasuredPrints() {
  if (printing_) say_(News::kGone, job_);
}

// What is wrong with one job is no reason for the printer to end; a full disk is.
void MeasuredPrints::write(const std::function<void()>& step) {
  try {
    step();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kNoRoom) throw;
    stack_.reset();
    bed_.reset();
    job_.folder.clear();
    job_.why_not = error.what();
  }
}

void MeasuredPrints::begins(const EmulatedJob& job) {
  // The sender's journal is there before the printer hears of the job.
  std::string id = Spool(emulator_journals(folder_)).id_at_device(job.number);
  if (id.empty()) id = fmt::format("{:016x}", job.number);
  job_ = {id, folder_ + "/" + id, 0, job.layer_count, false, ""};
  printing_ = true;
  written_ = 0;
  write([&] {
    bed_ = std::make_unique<PowderBed>(job.header, job.layer_count);
    stack_ = std::make_unique<StackWriter>(job_.folder, bed_->info());
  });
  say_(News::kBegins, job_);
}

void MeasuredPrints::prints(const EmulatedJob& job, std::span<const std::byte> records) {
  ++job_.layers;
  write([&] {
    if (!stack_) return;
    if (static_cast<int>(job.layers.size()) != job_.layers) {
      throw Error(ErrorKind::kBadInput, "", "the printer forgot layers that it had printed");
    }
    if (const auto layer = bed_->take(records)) stack_->write_packed(written_++, *layer);
  });
  say_(News::kLayer, job_);
}

void MeasuredPrints::ends(const EmulatedJob&) {
  write([&] {
    if (!stack_) return;
    if (const auto layer = bed_->top()) stack_->write_packed(written_++, *layer);
    stack_->finish();
  });
  job_.done = true;
  printing_ = false;
  stack_.reset();
  bed_.reset();
  say_(News::kDone, job_);
}

void MeasuredPrints::forgets(const EmulatedJob&) {
  printing_ = false;
  stack_.reset();
  bed_.reset();
  say_(News::kGone, job_);
}

}  // namespace binderjet
