// SPDX-License-Identifier: GPL-3.0-or-later
// The usb-redir front end against a guest that is the same library's other side, and a device that
// echoes.
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>
#include <usbredirparser.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <thread>

#include "tests/printer/emulator/usbredir_serve.h"

namespace binderjet {
namespace {

constexpr std::uint8_t kOut = 0x01;
constexpr std::uint8_t kIn = 0x82;

std::vector<std::byte> bytes_of(std::initializer_list<int> values) {
  std::vector<std::byte> out;
  for (const int value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

// What comes on the OUT pipe leaves on the IN pipe. The plan says what befalls the next calls.
class EchoDevice : public EmulatedUsbDevice {
 public:
  std::vector<UsbTaken> out_plan;  // bytes: how many to take at most
  std::vector<UsbOutcome> in_plan;

  std::vector<std::byte> device_descriptor() const override {
    return bytes_of({18, 1, 0, 2, 0, 0, 0, 64, 0x09, 0x12, 1, 0, 0, 1, 1, 2, 3, 1});
  }
  std::vector<std::byte> configuration_descriptor() const override {
    return bytes_of({9, 2, 32, 0, 1,    1, 0, 0xc0, 50, 9, 4, 0,   0, 2, 7, 1,
                     2, 0, 7,  5, kOut, 2, 0, 2,    0,  7, 5, kIn, 2, 0, 2, 0});
  }
  std::vector<std::byte> string_descriptor(int index) const override {
    return index == 0 ? bytes_of({4, 3, 9, 4}) : std::vector<std::byte>{};
  }
  UsbReply control(const ControlSetup& setup, std::span<const std::byte>) override {
    if (setup.request != 0) return {UsbOutcome::kStall, {}};
    return {UsbOutcome::kOk, bytes_of({0, 4, 'i', 'd'})};
  }
  UsbTaken bulk_out(std::span<const std::byte> data) override {
    UsbTaken taken{UsbOutcome::kOk, data.size()};
    if (!out_plan.empty()) {
      taken = {out_plan.front().outcome, std::min(out_plan.front().bytes, data.size())};
      out_plan.erase(out_plan.begin());
    }
    const auto end = data.begin() + static_cast<std::ptrdiff_t>(taken.bytes);
    kept_.insert(kept_.end(), data.begin(), end);
    return taken;
  }
  UsbReply bulk_in(std::size_t most) override {
    if (!in_plan.empty()) {
      const UsbOutcome outcome = in_plan.front();
      in_plan.erase(in_plan.begin());
      if (outcome != UsbOutcome::kOk) return {outcome, {}};
    }
    if (kept_.empty()) return {UsbOutcome::kNak, {}};
    const auto end = kept_.begin() + static_cast<std::ptrdiff_t>(std::min(most, kept_.size()));
    UsbReply reply{UsbOutcome::kOk, {kept_.begin(), end}};
    kept_.erase(kept_.begin(), end);
    return reply;
  }
  void clear_halt(std::uint8_t) override {}

 private:
  std::vector<std::byte> kept_;
};

struct Answer {
  int status = -1;
  std::size_t bytes = 0;
  std::vector<std::byte> data;
};

class Usbredir : public testing::Test {
 protected:
  ~Usbredir() override {
    if (server_.joinable()) stop();
    if (parser_ != nullptr) usbredirparser_destroy(parser_);
    close(socket_);
    close(stop_);
  }

  // The guest: connects, and has seen the device when this returns.
  void plug_in() {
    int pair[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, pair), 0);
    socket_ = pair[0];
    server_ =
        std::thread([this, fd = pair[1]] { result_ = serve_usbredir_on(device_, fd, stop_); });
    parser_ = usbredirparser_create();
    parser_->priv = this;
    set_callbacks();
    std::uint32_t caps[USB_REDIR_CAPS_SIZE] = {};
    for (const int cap : {usb_redir_cap_connect_device_version, usb_redir_cap_device_disconnect_ack,
                          usb_redir_cap_ep_info_max_packet_size, usb_redir_cap_64bits_ids,
                          usb_redir_cap_32bits_bulk_length}) {
      usbredirparser_caps_set_cap(caps, cap);
    }
    usbredirparser_init(parser_, "test", caps, USB_REDIR_CAPS_SIZE, 0);
    run_until([this] { return connected_; });
  }
  void stop() {
    const std::uint64_t one = 1;
    ASSERT_EQ(write(stop_, &one, sizeof(one)), 8);
    server_.join();
  }

  void run_until(const std::function<bool()>& done) {
    while (!done()) {
      flush();
      pollfd wait{socket_, POLLIN, 0};
      ASSERT_EQ(poll(&wait, 1, 20000), 1) << "the front end says nothing";
      ASSERT_EQ(usbredirparser_do_read(parser_), 0);
    }
  }
  void flush() {
    while (usbredirparser_has_data_to_write(parser_) > 0) {
      ASSERT_EQ(usbredirparser_do_write(parser_), 0);
    }
  }
  Answer answer(std::uint64_t id) {
    run_until([&] { return answers_.count(id) > 0; });
    return answers_[id];
  }

  void send_out(std::uint64_t id, std::vector<std::byte> data) {
    usb_redir_bulk_packet_header head{};
    head.endpoint = kOut;
    head.length = static_cast<std::uint16_t>(data.size() & 0xffff);
    head.length_high = static_cast<std::uint16_t>(data.size() >> 16);
    usbredirparser_send_bulk_packet(parser_, id, &head,
                                    reinterpret_cast<std::uint8_t*>(data.data()),
                                    static_cast<int>(data.size()));
  }
  void ask_in(std::uint64_t id, std::uint32_t most) {
    usb_redir_bulk_packet_header head{};
    head.endpoint = kIn;
    head.length = static_cast<std::uint16_t>(most & 0xffff);
    head.length_high = static_cast<std::uint16_t>(most >> 16);
    usbredirparser_send_bulk_packet(parser_, id, &head, nullptr, 0);
  }
  void cancel(std::uint64_t id) { usbredirparser_send_cancel_data_packet(parser_, id); }
  void control(std::uint64_t id, ControlSetup setup) {
    usb_redir_control_packet_header head{};
    head.endpoint = static_cast<std::uint8_t>(setup.request_type & 0x80);
    head.request = setup.request;
    head.requesttype = setup.request_type;
    head.value = setup.value;
    head.index = setup.index;
    head.length = setup.length;
    usbredirparser_send_control_packet(parser_, id, &head, nullptr, 0);
  }

  EchoDevice device_;
  UsbredirResult result_;
  int interface_class_ = 0;
  int vendor_ = 0;
  int in_type_ = 0;
  bool connected_ = false;
  bool left_ = false;
  std::thread server_;

 private:
  void keep(std::uint64_t id, int status, std::size_t length, std::uint8_t* data, int size) {
    const auto* first = reinterpret_cast<const std::byte*>(data);
    answers_[id] = {status, length, {first, first + size}};
    usbredirparser_free_packet_data(parser_, data);
  }
  void set_callbacks();

  int socket_ = -1;
  int stop_ = eventfd(0, EFD_CLOEXEC);
  usbredirparser* parser_ = nullptr;
  std::map<std::uint64_t, Answer> answers_;
};

void Usbredir::set_callbacks() {
  parser_->log_func = [](void*, int level, const char* text) {
    if (level <= usbredirparser_warning) ADD_FAILURE() << text;
  };
  parser_->read_func = [](void* self, std::uint8_t* data, int count) {
    const auto got = recv(static_cast<Usbredir*>(self)->socket_, data,
                          static_cast<std::size_t>(count), MSG_DONTWAIT);
    return got < 0 && errno == EAGAIN ? 0 : static_cast<int>(got > 0 ? got : -1);
  };
  parser_->write_func = [](void* self, std::uint8_t* data, int count) {
    return static_cast<int>(send(static_cast<Usbredir*>(self)->socket_, data,
                                 static_cast<std::size_t>(count), MSG_NOSIGNAL));
  };
  parser_->hello_func = [](void*, usb_redir_hello_header*) {};
  parser_->interface_info_func = [](void* self, usb_redir_interface_info_header* info) {
    static_cast<Usbredir*>(self)->interface_class_ = info->interface_class[0];
  };
  parser_->ep_info_func = [](void* self, usb_redir_ep_info_header* info) {
    static_cast<Usbredir*>(self)->in_type_ = info->type[16 + (kIn & 0x0f)];
  };
  parser_->device_connect_func = [](void* self, usb_redir_device_connect_header* head) {
    static_cast<Usbredir*>(self)->vendor_ = head->vendor_id;
    static_cast<Usbredir*>(self)->connected_ = true;
  };
  parser_->device_disconnect_func = [](void* self) { static_cast<Usbredir*>(self)->left_ = true; };
  parser_->control_packet_func = [](void* self, std::uint64_t id,
                                    usb_redir_control_packet_header* head, std::uint8_t* data,
                                    int size) {
    static_cast<Usbredir*>(self)->keep(id, head->status, head->length, data, size);
  };
  parser_->bulk_packet_func = [](void* self, std::uint64_t id, usb_redir_bulk_packet_header* head,
                                 std::uint8_t* data, int size) {
    const std::size_t length = head->length | static_cast<std::size_t>(head->length_high) << 16;
    static_cast<Usbredir*>(self)->keep(id, head->status, length, data, size);
  };
}

std::vector<std::byte> pattern(std::size_t size) {
  std::vector<std::byte> out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>(i * 7 + i / 251);
  return out;
}

TEST_F(Usbredir, AnnouncesAPrinterAndAnswersItsRequests) {
  plug_in();
  EXPECT_EQ(interface_class_, 7);
  EXPECT_EQ(vendor_, 0x1209);
  EXPECT_EQ(in_type_, usb_redir_type_bulk);
  control(1, {0x80, 6, 0x0100, 0, 8});
  EXPECT_EQ(answer(1).data, bytes_of({18, 1, 0, 2, 0, 0, 0, 64})) << "cut to what was asked for";
  control(2, {0xa1, 0, 0, 0, 1024});
  EXPECT_EQ(answer(2).data, bytes_of({0, 4, 'i', 'd'}));
  control(3, {0xa1, 9, 0, 0, 1024});
  EXPECT_EQ(answer(3).status, usb_redir_stall);
  control(4, {0x80, 6, 0x0600, 0, 10});
  EXPECT_EQ(answer(4).status, usb_redir_stall) << "a high-speed device alone has no qualifier";
  stop();
  EXPECT_EQ(result_.end, UsbredirEnd::kStopped);
}

TEST_F(Usbredir, CarriesBytesBothWaysThroughADeviceThatTakesThemInBites) {
  device_.out_plan = {{UsbOutcome::kNak, 1000}, {UsbOutcome::kNak, 0}, {UsbOutcome::kNak, 70000}};
  plug_in();
  const std::vector<std::byte> sent = pattern(200000);
  ask_in(1, 250000);
  send_out(2, sent);
  EXPECT_EQ(answer(2).bytes, sent.size());
  std::vector<std::byte> back = answer(1).data;
  for (std::uint64_t id = 3; back.size() < sent.size(); ++id) {
    ask_in(id, 250000);
    const std::vector<std::byte> more = answer(id).data;
    back.insert(back.end(), more.begin(), more.end());
  }
  EXPECT_EQ(back, sent);
}

TEST_F(Usbredir, TellsHowMuchWentBeforeAStallAndHoldsTheRest) {
  device_.out_plan = {{UsbOutcome::kNak, 300}, {UsbOutcome::kStall, 84}};
  plug_in();
  send_out(1, pattern(1000));
  send_out(2, pattern(10));
  EXPECT_EQ(answer(1).status, usb_redir_stall);
  EXPECT_EQ(answer(1).bytes, 384U);
  control(3, {0x82, 0, 0, kOut, 2});
  EXPECT_EQ(answer(3).data, bytes_of({1, 0})) << "the endpoint is halted";
  cancel(2);
  EXPECT_EQ(answer(2).status, usb_redir_cancelled);
  EXPECT_EQ(answer(2).bytes, 0U);
  control(4, {0x02, 1, 0, kOut, 0});
  EXPECT_EQ(answer(4).status, usb_redir_success);
  send_out(5, pattern(20));
  EXPECT_EQ(answer(5).bytes, 20U);
}

TEST_F(Usbredir, CancelsWhatWaitsAndGoesOn) {
  plug_in();
  ask_in(1, 512);
  cancel(1);
  EXPECT_EQ(answer(1).status, usb_redir_cancelled);
  cancel(1);  // crossed with its answer
  send_out(2, pattern(3));
  ask_in(3, 512);
  EXPECT_EQ(answer(3).data, pattern(3));
}

TEST_F(Usbredir, TellsTheGuestThatTheDeviceLeftAndThenEnds) {
  device_.out_plan = {{UsbOutcome::kGone, 100}};
  plug_in();
  ask_in(1, 512);
  send_out(2, pattern(1000));
  run_until([this] { return left_; });  // the parser acknowledges it
  flush();
  server_.join();
  EXPECT_EQ(result_.end, UsbredirEnd::kGone);
}

TEST_F(Usbredir, WaitsForADeviceThatNaksWithoutBurningTheProcessor) {
  device_.in_plan.assign(60, UsbOutcome::kNak);
  plug_in();
  send_out(1, pattern(3));
  EXPECT_EQ(answer(1).bytes, 3U);
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t used = std::clock();
  ask_in(2, 512);
  EXPECT_EQ(answer(2).data, pattern(3));
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const double busy = static_cast<double>(std::clock() - used) / CLOCKS_PER_SEC;
  EXPECT_GT(wall.count(), 0.3) << "60 tries at a pace of 10 ms";
  EXPECT_LT(busy, 0.1 * wall.count());
}

TEST_F(Usbredir, SaysWhichSocketIsNotThere) {
  const UsbredirResult result = serve_usbredir(device_, std::string(200, 'x'), -1);
  EXPECT_EQ(result.end, UsbredirEnd::kFailed);
  EXPECT_NE(result.why.find("longer"), std::string::npos);
}

}  // namespace
}  // namespace binderjet
