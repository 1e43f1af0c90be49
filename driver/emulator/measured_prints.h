// SPDX-License-Identifier: GPL-3.0-or-later
// What an emulated printer printed, as a scan of it: a folder of measured slice stacks, one for
// each job, written layer by layer while it prints.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "driver/emulator/printed_volume.h"
#include "slicer/stack/slice_stack.h"
#include "transport/emulator/printer_emulator.h"

namespace binderjet {

struct PrintedJob {
  std::string id;      // the host's number of it
  std::string folder;  // the stack, which is there once the job is done; empty if it has none
  int layers = 0;      // printed
  int layer_count = 0;
  bool done = false;
  std::string why_not;  // why there is no stack
};

// Throws Error{kNoRoom} out of the printer when the disk is full; a job that makes no stack (its
// header is nobody's) is printed all the same.
class MeasuredPrints : public PrintWatcher {
 public:
  // The stacks are FOLDER/ID. `say` hears of a job when it begins, with each layer, and when it is
  // done; an unfinished one that goes away says `gone`.
  enum class News { kBegins, kLayer, kDone, kGone };
  using Say = std::function<void(News news, const PrintedJob& job)>;
  MeasuredPrints(std::string folder, Say say);
  // Says of an unfinished job that it goes.
  ~MeasuredPrints() override;

  void begins(const EmulatedJob& job) override;
  void prints(const EmulatedJob& job, std::span<const std::byte> records) override;
  void ends(const EmulatedJob& job) override;
  void forgets(const EmulatedJob& job) override;

 private:
  void write(const std::function<void()>& step);

  std::string folder_;
  Say say_;
  PrintedJob job_;
  bool printing_ = false;
  std::unique_ptr<PowderBed> bed_;  // of the job that is being printed; null if it has no stack
  std::unique_ptr<StackWriter> stack_;
  int written_ = 0;  // layers
};

}  // namespace binderjet
