// SPDX-License-Identifier: GPL-3.0-or-later
// Keeping the OUT pipe full without ever losing the order of its bytes.
//
// Several transfers are in flight. If the first came back short while the second went on, the
// device would see a hole. So transfers have no time-out of their own, which would end the first
// one first; who waits decides when to give up, and the newest is always cancelled first. Where a
// hole is there all the same (a short transfer that counts as success, a stall), the link is broken
// and the session goes on from the last acknowledged layer.
#include "transport/usb/usb_link.h"

#include <algorithm>
#include <utility>

namespace binderjet {
namespace {

constexpr std::size_t kPieceBytes = 64 << 10;
constexpr std::size_t kSmallestPiece = 4 << 10;
constexpr std::size_t kDepth = 4;
constexpr std::size_t kInBytes = 16 << 10;
constexpr std::size_t kMaxInput = 1 << 20;  // a device that says more unasked is out of its mind
constexpr int kMaxEmpty = 16;               // transfers in a row that succeed and move nothing
constexpr auto kMemoryPause = std::chrono::milliseconds(50);
constexpr auto kReapTime = std::chrono::milliseconds(500);
constexpr unsigned kResetTimeoutMs = 300;

}  // namespace

struct UsbLink::Piece {
  UsbLink* link = nullptr;
  std::shared_ptr<std::vector<std::byte>> chunk;  // keeps the bytes alive
  std::size_t begin = 0;
  std::size_t bytes = 0;
  libusb_transfer* transfer = nullptr;
  bool back = false;
  std::size_t taken = 0;
  int status = 0;

  ~Piece() { libusb_free_transfer(transfer); }
};

UsbLink::UsbLink(UsbContext context, OpenPrinter printer)
    : context_(std::move(context)),
      printer_(std::move(printer)),
      piece_bytes_(kPieceBytes),
      depth_(kDepth),
      in_(libusb_alloc_transfer(0)),
      in_buffer_(kInBytes - kInBytes % static_cast<std::size_t>(printer_.interface.packet_bytes)) {
  if (in_ == nullptr) set_state(LinkState::kGone, "no memory for USB transfers");
  events_ = std::thread([this] { run_events(); });
}

UsbLink::~UsbLink() {
  {
    std::unique_lock lock(mutex_);
    stopping_ = true;
    reap_all(lock);
    quit_ = true;
    // A transfer that the system never gives back must not end in freed memory: it is leaked.
    for (std::unique_ptr<Piece>& piece : flight_) {
      if (!piece->back) static_cast<void>(piece.release());
    }
  }
  libusb_interrupt_event_handler(context_.get());
  events_.join();
  libusb_release_interface(printer_.handle.get(), printer_.interface.number);
  if (!in_flight_) libusb_free_transfer(in_);
}

void UsbLink::run_events() {
  while (true) {
    {
      std::unique_lock lock(mutex_);
      if (quit_) return;
      if (no_memory_ && Clock::now() >= retry_at_) {
        no_memory_ = false;
        submit_out();
      }
    }
    timeval slice{1, 0};
    {
      const std::lock_guard lock(mutex_);
      if (no_memory_) slice = {0, 20'000};
    }
    libusb_handle_events_timeout_completed(context_.get(), &slice, nullptr);
  }
}

void UsbLink::post(std::vector<std::byte> bytes) {
  if (bytes.empty()) return;
  const std::lock_guard lock(mutex_);
  unsent_ += bytes.size();
  chunks_.push_back(std::make_shared<std::vector<std::byte>>(std::move(bytes)));
  submit_out();
}

std::size_t UsbLink::unsent() const {
  const std::lock_guard lock(mutex_);
  return unsent_;
}

std::uint64_t UsbLink::sent() const {
  const std::lock_guard lock(mutex_);
  return sent_;
}

std::vector<std::byte> UsbLink::take_input() {
  const std::lock_guard lock(mutex_);
  return std::exchange(input_, {});
}

LinkState UsbLink::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

std::string UsbLink::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

void UsbLink::set_state(LinkState state, const std::string& why) {
  if (state_ == LinkState::kGone || (state_ == LinkState::kBroken && state != LinkState::kGone)) {
    return;
  }
  state_ = state;
  trouble_ = why;
  changed_.notify_all();
}

void UsbLink::wait(Clock::time_point until) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, until, [&] { return !input_.empty() || state_ != LinkState::kFine; });
}

void UsbLink::submit_out() {
  while (state_ == LinkState::kFine && !stopping_ && !draining_ && !no_memory_ &&
         flight_.size() < depth_ && !chunks_.empty()) {
    const std::shared_ptr<std::vector<std::byte>> chunk = chunks_.front();
    auto piece = std::make_unique<Piece>();
    piece->link = this;
    piece->chunk = chunk;
    piece->begin = front_taken_;
    piece->bytes = std::min(piece_bytes_, chunk->size() - front_taken_);
    piece->transfer = libusb_alloc_transfer(0);
    int error = LIBUSB_ERROR_NO_MEM;
    if (piece->transfer != nullptr) {
      libusb_fill_bulk_transfer(piece->transfer, printer_.handle.get(), printer_.interface.out,
                                reinterpret_cast<unsigned char*>(chunk->data() + piece->begin),
                                static_cast<int>(piece->bytes), out_done, piece.get(), 0);
      error = libusb_submit_transfer(piece->transfer);
    }
    if (error == LIBUSB_ERROR_NO_MEM) {
      // The system lends a process so much memory for USB. Less at a time; and if nothing comes
      // back that would free some, the event thread tries again after a moment.
      piece_bytes_ = std::max(kSmallestPiece, piece_bytes_ / 2);
      depth_ = std::max<std::size_t>(1, flight_.size());
      no_memory_ = true;
      retry_at_ = Clock::now() + kMemoryPause;
      return;
    }
    if (error != 0) {
      set_state(error == LIBUSB_ERROR_NO_DEVICE ? LinkState::kGone : LinkState::kBroken,
                error == LIBUSB_ERROR_NO_DEVICE ? "the printer was unplugged or switched off"
                                                : libusb_strerror(error));
      return;
    }
    front_taken_ += piece->bytes;
    if (front_taken_ == chunk->size()) {
      chunks_.pop_front();
      front_taken_ = 0;
    }
    flight_.push_back(std::move(piece));
  }
}

void UsbLink::out_done(libusb_transfer* transfer) {
  auto* piece = static_cast<Piece*>(transfer->user_data);
  UsbLink& link = *piece->link;
  const std::lock_guard lock(link.mutex_);
  piece->back = true;
  piece->taken = static_cast<std::size_t>(std::max(0, transfer->actual_length));
  piece->status = transfer->status;
  link.sent_ += piece->taken;
  link.unsent_ -= std::min(link.unsent_, piece->taken);
  link.no_memory_ = false;  // something came back
  const bool empty = piece->taken == 0 && transfer->status == LIBUSB_TRANSFER_COMPLETED;
  link.empty_in_a_row_ = empty ? link.empty_in_a_row_ + 1 : 0;
  if (link.empty_in_a_row_ > kMaxEmpty) {
    link.set_state(LinkState::kBroken, "the printer takes no data and says that it does");
  }
  if (transfer->status == LIBUSB_TRANSFER_NO_DEVICE) {
    link.set_state(LinkState::kGone, "the printer was unplugged or switched off");
  } else if (transfer->status == LIBUSB_TRANSFER_STALL) {
    link.set_state(LinkState::kBroken, "the printer stalled its data pipe");
  } else if (transfer->status == LIBUSB_TRANSFER_ERROR ||
             transfer->status == LIBUSB_TRANSFER_OVERFLOW) {
    link.set_state(LinkState::kBroken, "the USB connection failed");
  }
  if (piece->taken < piece->bytes && !link.draining_) {
    link.draining_ = true;
    for (auto one = link.flight_.rbegin(); one != link.flight_.rend(); ++one) {
      if (!(*one)->back) libusb_cancel_transfer((*one)->transfer);
    }
  }
  link.take_back();
  link.submit_out();
  link.changed_.notify_all();
}

// Whole pieces leave at the front. Behind a short one all must be back before it is known whether
// the next bytes are those that it left, or whether there is a hole.
void UsbLink::take_back() {
  while (!flight_.empty() && flight_.front()->back &&
         flight_.front()->taken == flight_.front()->bytes) {
    flight_.pop_front();
  }
  if (!draining_ ||
      std::any_of(flight_.begin(), flight_.end(), [](const auto& piece) { return !piece->back; })) {
    return;
  }
  draining_ = false;
  if (flight_.empty()) return;
  const bool hole = std::any_of(flight_.begin() + 1, flight_.end(),
                                [](const auto& piece) { return piece->taken != 0; });
  // One at a time from here on: a device that shortens transfers then leaves no hole.
  depth_ = 1;
  if (hole) {
    set_state(LinkState::kBroken, "the printer took less than a whole transfer");
    return;
  }
  // What the first did not take comes first again. Pieces are cut anew from their chunks.
  const Piece& first = *flight_.front();
  if (chunks_.empty() || chunks_.front() != flight_.back()->chunk) {
    chunks_.push_front(flight_.back()->chunk);
  }
  for (auto piece = flight_.rbegin() + 1; piece != flight_.rend(); ++piece) {
    if (chunks_.front() != (*piece)->chunk) chunks_.push_front((*piece)->chunk);
  }
  front_taken_ = first.begin + first.taken;
  flight_.clear();
}

void UsbLink::submit_in() {
  if (in_flight_ || stopping_ || state_ != LinkState::kFine || in_ == nullptr) return;
  libusb_fill_bulk_transfer(in_, printer_.handle.get(), printer_.interface.in, in_buffer_.data(),
                            static_cast<int>(in_buffer_.size()), in_done, this, 0);
  const int error = libusb_submit_transfer(in_);
  in_flight_ = error == 0;
  if (error == LIBUSB_ERROR_NO_DEVICE) {
    set_state(LinkState::kGone, "the printer was unplugged or switched off");
  } else if (error != 0) {
    set_state(LinkState::kBroken, libusb_strerror(error));
  }
}

void UsbLink::in_done(libusb_transfer* transfer) {
  UsbLink& link = *static_cast<UsbLink*>(transfer->user_data);
  const std::lock_guard lock(link.mutex_);
  link.in_flight_ = false;
  const std::size_t length = static_cast<std::size_t>(std::max(0, transfer->actual_length));
  const auto* bytes = reinterpret_cast<const std::byte*>(link.in_buffer_.data());
  link.input_.insert(link.input_.end(), bytes, bytes + length);
  if (transfer->status == LIBUSB_TRANSFER_NO_DEVICE) {
    link.set_state(LinkState::kGone, "the printer was unplugged or switched off");
  } else if (transfer->status == LIBUSB_TRANSFER_STALL) {
    link.set_state(LinkState::kBroken, "the printer stalled its answering pipe");
  } else if (transfer->status == LIBUSB_TRANSFER_ERROR ||
             transfer->status == LIBUSB_TRANSFER_OVERFLOW) {
    link.set_state(LinkState::kBroken, "the USB connection failed");
  } else if (link.input_.size() > kMaxInput) {
    link.set_state(LinkState::kBroken, "the printer talks without end");
  } else if (transfer->status != LIBUSB_TRANSFER_CANCELLED) {
    link.submit_in();
  }
  link.changed_.notify_all();
}

void UsbLink::cancel_all() {
  for (auto piece = flight_.rbegin(); piece != flight_.rend(); ++piece) {
    if (!(*piece)->back) libusb_cancel_transfer((*piece)->transfer);
  }
  if (in_flight_) libusb_cancel_transfer(in_);
}

void UsbLink::reap_all(std::unique_lock<std::mutex>& lock) {
  cancel_all();
  changed_.wait_for(lock, kReapTime, [this] {
    return !in_flight_ && std::all_of(flight_.begin(), flight_.end(),
                                      [](const auto& piece) { return piece->back; });
  });
}

bool UsbLink::soft_reset() {
  libusb_device_handle* handle = printer_.handle.get();
  const auto interface = static_cast<std::uint16_t>(printer_.interface.number);
  // The other form is tried as well: a device knows one of them and stalls the other.
  const std::uint8_t first = printer_.quirks.soft_reset_1_0 ? 0x23 : 0x21;
  const std::uint8_t second = printer_.quirks.soft_reset_1_0 ? 0x21 : 0x23;
  for (const std::uint8_t request_type : {first, second}) {
    const int error =
        libusb_control_transfer(handle, request_type, 2, 0, interface, nullptr, 0, kResetTimeoutMs);
    if (error >= 0) return true;
    if (error != LIBUSB_ERROR_PIPE) return false;
  }
  return false;
}

bool UsbLink::restart() {
  {
    std::unique_lock lock(mutex_);
    if (state_ == LinkState::kGone) return false;
    stopping_ = true;
    reap_all(lock);
    const bool all_back = !in_flight_ && std::all_of(flight_.begin(), flight_.end(),
                                                     [](const auto& p) { return p->back; });
    if (!all_back || state_ == LinkState::kGone) return false;
    flight_.clear();
    chunks_.clear();
    front_taken_ = 0;
    unsent_ = 0;
    draining_ = false;
    no_memory_ = false;
    input_.clear();
  }
  // Without the lock: these wait for the event thread.
  static_cast<void>(libusb_clear_halt(printer_.handle.get(), printer_.interface.out));
  static_cast<void>(libusb_clear_halt(printer_.handle.get(), printer_.interface.in));
  const bool reset = soft_reset();
  const std::lock_guard lock(mutex_);
  stopping_ = false;
  if (!reset) return false;
  if (state_ == LinkState::kBroken) {
    state_ = LinkState::kFine;
    trouble_.clear();
  }
  submit_in();
  return state_ == LinkState::kFine;
}

}  // namespace binderjet
