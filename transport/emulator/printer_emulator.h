// SPDX-License-Identifier: GPL-3.0-or-later
// A printer that speaks binderjet-1 (transport/PROTOCOL.md), with faults on order, and that
// remembers what it was sent. Front ends put it on a bus or a socket (emulated_usb_device.h).
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "transport/emulator/emulated_usb_device.h"
#include "transport/emulator/fault_plan.h"
#include "transport/printer/frame.h"
#include "transport/printer/protocol.h"

namespace binderjet {

struct EmulatedJob;

// Sees the printer work: called from the thread that moves its bytes, with the printer locked, so
// that it must not call the printer back. What it throws comes out of bulk_out or bulk_in.
class PrintWatcher {
 public:
  virtual ~PrintWatcher() = default;
  virtual void begins(const EmulatedJob& job) = 0;
  // Layer job.layers.size() - 1, before its acknowledgement is said.
  virtual void prints(const EmulatedJob& job, std::span<const std::byte> records) = 0;
  // The whole job, before the host hears that it is done.
  virtual void ends(const EmulatedJob& job) = 0;
  virtual void forgets(const EmulatedJob& job) = 0;  // it was cancelled
};

struct EmulatorOptions {
  std::string serial = "EMU0001";
  int credits = 4;
  std::chrono::milliseconds layer_time{0};
  std::uint64_t max_layer_bytes = std::uint64_t{256} << 20;
  FaultPlan plan;
  std::function<void(std::span<const std::byte>)> on_bytes;  // every byte of the OUT pipe taken
  PrintWatcher* watcher = nullptr;                           // outlives the printer
  bool keep_layers =
      true;  // false: EmulatedJob::layers are empty, for a printer that runs for long
};

// What a job has become inside the printer; survives everything.
struct EmulatedJob {
  std::uint64_t number = 0;
  int layer_count = 0;
  std::string header;
  std::vector<std::vector<std::byte>> layers;  // the records of each acknowledged layer
  std::vector<std::uint64_t> digests;          // [n]: of the first n layers
  bool done = false;
};

class PrinterEmulator : public EmulatedUsbDevice {
 public:
  explicit PrinterEmulator(EmulatorOptions options = {});

  std::vector<std::byte> device_descriptor() const override;
  std::vector<std::byte> configuration_descriptor() const override;
  std::vector<std::byte> string_descriptor(int index) const override;
  UsbReply control(const ControlSetup& setup, std::span<const std::byte> out) override;
  UsbTaken bulk_out(std::span<const std::byte> data) override;
  UsbReply bulk_in(std::size_t most) override;
  void clear_halt(std::uint8_t endpoint) override;

  // What a person at the printer does.
  bool gone() const;
  void plug();  // in again, or switched on again
  void unplug();
  void refill();  // powder, binder, the cover closed
  void mend();    // both; the plan goes on
  void heal();    // all of it, and the rest of the plan is dropped
  void set_plan(FaultPlan plan);
  void add_fault(PlannedFault fault);

  // Waits until job number `job` (the first is 1) has so many acknowledged layers; false after 20
  // s.
  bool wait_for_layers(int layers, std::size_t job = 1);

  // The evidence.
  std::vector<EmulatedJob> jobs() const;  // done ones and the held one, oldest first
  int acknowledged() const;               // layers of the newest job
  std::vector<int> record() const;        // layers in the order they were acknowledged, newest job
  int sent_again() const;                 // layers that came once more behind their acknowledgement
  int max_waiting() const;                // layers that were here and not printed, at most
  int resets() const;
  std::uint64_t bytes_taken() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    std::uint64_t job;
    std::vector<std::byte> records;
  };

  PlannedFault* planned(PrinterFault what, int layer);
  bool fire(PrinterFault what, int layer, int* ms = nullptr);
  bool fire_now(PrinterFault what);
  Clock::time_point after(int ms) const;

  UsbTaken take_bytes(std::span<const std::byte> data);
  std::optional<UsbTaken> data_fault(std::span<const std::byte> data, std::size_t taken);
  void take_frame(const protocol::Frame& frame);
  void take_hello(const protocol::Frame& frame);
  void take_job(const protocol::Frame& frame);
  void take_resume(const protocol::Frame& frame);
  void take_layer(const protocol::Frame& frame);
  void take_end(const protocol::Frame& frame);
  void take_cancel(const protocol::Frame& frame);
  void refuse(const protocol::Frame& frame, protocol::Refusal why, const std::string& text,
              std::uint64_t job = 0);
  void say(protocol::Type type, std::span<const std::byte> payload);
  void say_raw(std::span<const std::byte> bytes);
  void say_status();
  void say_progress(protocol::Type type);
  void say_ack();
  void print_layers();
  bool may_print(int layer);
  void store_layer();
  void end_session();
  void lose_power(bool keep_waiting);
  int next_layer() const;  // that would come next on the wire
  EmulatedJob* find(std::uint64_t number);
  std::vector<std::byte> device_id();

  mutable std::mutex mutex_;
  std::condition_variable printed_;
  EmulatorOptions options_;
  FaultPlan plan_;

  // Survives everything.
  std::vector<EmulatedJob> jobs_;  // the last may be unfinished
  std::map<std::uint64_t, std::vector<int>> record_;
  int sent_again_ = 0;
  int max_waiting_ = 0;
  int resets_ = 0;
  std::uint64_t bytes_taken_ = 0;

  // Is gone with the power.
  bool gone_ = false;
  bool session_ = false;
  bool deaf_ = false;  // behind a damaged frame, until a reset
  bool open_ = false;  // the session has opened the held job
  protocol::FrameDecoder decoder_;
  std::size_t frame_bytes_ = 0;  // of the frame that is being taken
  bool faulty_frame_ = false;    // this frame has had its fault
  bool flip_next_ = false;       // a bit of the next byte arrives wrong
  std::uint32_t next_in_ = 0;
  std::uint32_t next_out_ = 0;
  std::deque<Waiting> waiting_;
  std::deque<std::byte> answers_;
  bool halted_out_ = false;
  bool halted_in_ = false;
  bool byte_by_byte_ = false;
  int empty_answers_ = 0;
  Clock::time_point nak_until_{};
  Clock::time_point silent_until_{};
  Clock::time_point paused_until_{};
  Clock::time_point no_credit_until_{};
  bool credit_withheld_ = false;
  Clock::time_point late_until_{};
  bool ack_is_late_ = false;
  std::string stopped_;  // IPP's reason, or empty
  std::chrono::milliseconds layer_time_{};
  std::optional<Clock::time_point> layer_began_;
};

}  // namespace binderjet
