// SPDX-License-Identifier: GPL-3.0-or-later
// The messages of binderjet-1 (PROTOCOL.md) as structs, and their bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace binderjet::protocol {

inline constexpr std::uint16_t kVersion = 1;
inline constexpr int kMaxCredits = 4;  // layers under way, whatever the device offers

enum class Type : std::uint8_t {
  // From the host.
  kHello = 0x01,
  kJob = 0x02,
  kResume = 0x03,
  kLayer = 0x04,
  kEnd = 0x05,
  kAskStatus = 0x06,
  kPause = 0x07,
  kContinue = 0x08,
  kCancel = 0x09,
  // From the device.
  kWelcome = 0x81,
  kReady = 0x82,
  kAck = 0x83,
  kDone = 0x84,
  kStatus = 0x85,
  kCancelled = 0x86,
  kRefused = 0x87,
};

enum class Capability : std::uint32_t { kPause = 1, kSupplies = 2, kColor = 4 };

enum class Refusal : std::uint16_t {
  kDamaged = 1,       // a frame is not right; the session is over
  kOutOfOrder = 2,    // a right frame at the wrong moment; the session is over
  kNoVersion = 3,     // no common version
  kHoldsAnother = 4,  // the device holds another unfinished job
  kUnknownJob = 5,    // nothing is known of this job
  kOtherJob = 6,      // the job of this key has another header, length or digest
  kTooBig = 7,        // header or layer beyond what WELCOME promises
};

// IPP's printer-state.
enum class State : std::uint8_t { kIdle = 3, kProcessing = 4, kStopped = 5 };
const char* state_word(State state);

struct Hello {
  std::uint16_t lowest = kVersion;
  std::uint16_t highest = kVersion;
  std::uint64_t session = 0;
};

struct Welcome {
  std::uint16_t version = kVersion;
  std::uint16_t credits = kMaxCredits;
  std::uint32_t capabilities = 0;
  std::uint64_t session = 0;
  std::uint64_t max_layer_bytes = 0;
  std::uint32_t max_header_bytes = 0;
  std::uint32_t held_layers = 0;  // acknowledged layers of the held job
  std::uint64_t held_job = 0;     // key of the unfinished job, or 0
  std::string name;
};

struct Job {
  std::uint64_t job = 0;
  std::uint32_t layers = 0;
  std::string header;
};

struct Resume {
  std::uint64_t job = 0;
  std::uint32_t layers = 0;
  std::uint32_t acknowledged = 0;  // as the host knows
  std::uint64_t digest = 0;        // of these
};

// READY and ACK: layers 0 to `acknowledged` - 1 survive anything; those below `limit` may be sent.
struct Progress {
  std::uint64_t job = 0;
  std::uint32_t acknowledged = 0;
  std::uint32_t limit = 0;
  std::uint64_t digest = 0;  // of the acknowledged layers
};

struct LayerHead {
  std::uint64_t job = 0;
  std::uint32_t layer = 0;
};
inline constexpr std::size_t kLayerHeadBytes = 16;

// END and DONE.
struct Totals {
  std::uint64_t job = 0;
  std::uint32_t layers = 0;
  std::uint64_t digest = 0;
};

struct Supply {
  std::string name;        // "binder", "powder"
  int level_percent = -1;  // -1: not known
};

struct Status {
  State state = State::kIdle;
  std::uint64_t job = 0;
  std::uint32_t acknowledged = 0;
  std::vector<std::string> reasons;  // IPP's printer-state-reasons
  std::vector<Supply> supplies;
};

struct Refused {
  std::uint32_t sequence = 0;  // of the frame that was refused
  Refusal reason = Refusal::kDamaged;
  std::uint64_t job = 0;  // the job that stands in the way, or 0
  std::string text;       // for people
};

std::vector<std::byte> encode(const Hello& message);
std::vector<std::byte> encode(const Welcome& message);
std::vector<std::byte> encode(const Job& message);
std::vector<std::byte> encode(const Resume& message);
std::vector<std::byte> encode(const Progress& message);
std::vector<std::byte> encode(const LayerHead& message);
std::vector<std::byte> encode(const Totals& message);
std::vector<std::byte> encode(const Status& message);
std::vector<std::byte> encode(const Refused& message);
// PAUSE, CONTINUE, CANCEL, CANCELLED: a job's key alone.
std::vector<std::byte> encode_key(std::uint64_t job);

// Nothing if a length, a reserved field or a value is not as PROTOCOL.md has it.
std::optional<Hello> decode_hello(std::span<const std::byte> payload);
std::optional<Welcome> decode_welcome(std::span<const std::byte> payload);
std::optional<Job> decode_job(std::span<const std::byte> payload);
std::optional<Resume> decode_resume(std::span<const std::byte> payload);
std::optional<Progress> decode_progress(std::span<const std::byte> payload);
// The records follow the head.
std::optional<LayerHead> decode_layer_head(std::span<const std::byte> payload);
std::optional<Totals> decode_totals(std::span<const std::byte> payload);
std::optional<Status> decode_status(std::span<const std::byte> payload);
std::optional<Refused> decode_refused(std::span<const std::byte> payload);
std::optional<std::uint64_t> decode_key(std::span<const std::byte> payload);

// The digest of no layers, and of one more layer.
std::uint64_t first_digest(std::string_view header, std::uint32_t layers);
std::uint64_t next_digest(std::uint64_t digest, std::span<const std::byte> records);

}  // namespace binderjet::protocol
