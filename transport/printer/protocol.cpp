// SPDX-License-Identifier: GPL-3.0-or-later
// Encoding and decoding of messages; a decoder checks every length before it looks.
#include "transport/printer/protocol.h"

#include "transport/base/bytes.h"

namespace binderjet::protocol {
namespace {

using Bytes = std::vector<std::byte>;
using View = std::span<const std::byte>;

constexpr std::size_t kWelcomeBytes = 40;
constexpr std::size_t kJobBytes = 16;
constexpr std::size_t kStatusBytes = 20;
constexpr std::size_t kRefusedBytes = 16;
constexpr std::size_t kMaxTextBytes = 255;

void put_text(Bytes& out, std::string_view text) {
  const View bytes = as_bytes(text);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

// A device's words reach a terminal: what is not printable ASCII becomes '?'.
std::string get_text(View bytes) {
  std::string text;
  for (const std::byte b : bytes) {
    const auto c = static_cast<unsigned char>(b);
    text += c >= 0x20 && c < 0x7f ? static_cast<char>(c) : '?';
  }
  return text;
}

}  // namespace

const char* state_word(State state) {
  switch (state) {
    case State::kIdle:
      return "idle";
    case State::kProcessing:
      return "processing";
    case State::kStopped:
      break;
  }
  return "stopped";
}

Bytes encode(const Hello& m) {
  Bytes out;
  put_le(out, m.lowest);
  put_le(out, m.highest);
  put_le<std::uint32_t>(out, 0);
  put_le(out, m.session);
  return out;
}

std::optional<Hello> decode_hello(View in) {
  if (in.size() != 16 || get_le<std::uint32_t>(in, 4) != 0) return std::nullopt;
  return Hello{get_le<std::uint16_t>(in, 0), get_le<std::uint16_t>(in, 2),
               get_le<std::uint64_t>(in, 8)};
}

Bytes encode(const Welcome& m) {
  Bytes out;
  put_le(out, m.version);
  put_le(out, m.credits);
  put_le(out, m.capabilities);
  put_le(out, m.session);
  put_le(out, m.max_layer_bytes);
  put_le(out, m.max_header_bytes);
  put_le(out, m.held_layers);
  put_le(out, m.held_job);
  put_text(out, std::string_view(m.name).substr(0, kMaxTextBytes));
  return out;
}

std::optional<Welcome> decode_welcome(View in) {
  if (in.size() < kWelcomeBytes || in.size() > kWelcomeBytes + kMaxTextBytes) return std::nullopt;
  Welcome m{get_le<std::uint16_t>(in, 0),       get_le<std::uint16_t>(in, 2),
            get_le<std::uint32_t>(in, 4),       get_le<std::uint64_t>(in, 8),
            get_le<std::uint64_t>(in, 16),      get_le<std::uint32_t>(in, 24),
            get_le<std::uint32_t>(in, 28),      get_le<std::uint64_t>(in, 32),
            get_text(in.subspan(kWelcomeBytes))};
  if (m.credits == 0) return std::nullopt;
  return m;
}

Bytes encode(const Job& m) {
  Bytes out;
  put_le(out, m.job);
  put_le(out, m.layers);
  put_le<std::uint32_t>(out, 0);
  put_text(out, m.header);
  return out;
}

std::optional<Job> decode_job(View in) {
  if (in.size() < kJobBytes || get_le<std::uint32_t>(in, 12) != 0) return std::nullopt;
  Job m{get_le<std::uint64_t>(in, 0), get_le<std::uint32_t>(in, 8), ""};
  if (m.job == 0) return std::nullopt;
  const View header = in.subspan(kJobBytes);
  m.header.assign(reinterpret_cast<const char*>(header.data()), header.size());
  return m;
}

Bytes encode(const Resume& m) {
  Bytes out;
  put_le(out, m.job);
  put_le(out, m.layers);
  put_le(out, m.acknowledged);
  put_le(out, m.digest);
  return out;
}

std::optional<Resume> decode_resume(View in) {
  if (in.size() != 24) return std::nullopt;
  const Resume m{get_le<std::uint64_t>(in, 0), get_le<std::uint32_t>(in, 8),
                 get_le<std::uint32_t>(in, 12), get_le<std::uint64_t>(in, 16)};
  if (m.job == 0 || m.acknowledged > m.layers) return std::nullopt;
  return m;
}

Bytes encode(const Progress& m) {
  Bytes out;
  put_le(out, m.job);
  put_le(out, m.acknowledged);
  put_le(out, m.limit);
  put_le(out, m.digest);
  return out;
}

std::optional<Progress> decode_progress(View in) {
  if (in.size() != 24) return std::nullopt;
  const Progress m{get_le<std::uint64_t>(in, 0), get_le<std::uint32_t>(in, 8),
                   get_le<std::uint32_t>(in, 12), get_le<std::uint64_t>(in, 16)};
  if (m.job == 0 || m.limit < m.acknowledged) return std::nullopt;
  return m;
}

Bytes encode(const LayerHead& m) {
  Bytes out;
  put_le(out, m.job);
  put_le(out, m.layer);
  put_le<std::uint32_t>(out, 0);
  return out;
}

std::optional<LayerHead> decode_layer_head(View in) {
  if (in.size() < kLayerHeadBytes || get_le<std::uint32_t>(in, 12) != 0) return std::nullopt;
  return LayerHead{get_le<std::uint64_t>(in, 0), get_le<std::uint32_t>(in, 8)};
}

Bytes encode(const Totals& m) {
  Bytes out;
  put_le(out, m.job);
  put_le(out, m.layers);
  put_le<std::uint32_t>(out, 0);
  put_le(out, m.digest);
  return out;
}

std::optional<Totals> decode_totals(View in) {
  if (in.size() != 24 || get_le<std::uint32_t>(in, 12) != 0) return std::nullopt;
  return Totals{get_le<std::uint64_t>(in, 0), get_le<std::uint32_t>(in, 8),
                get_le<std::uint64_t>(in, 16)};
}

Bytes encode(const Status& m) {
  std::string reasons;
  for (const std::string& reason : m.reasons) reasons += (reasons.empty() ? "" : ",") + reason;
  Bytes out;
  put_le(out, static_cast<std::uint8_t>(m.state));
  put_le(out, static_cast<std::uint8_t>(m.supplies.size()));
  put_le(out, static_cast<std::uint16_t>(reasons.size()));
  put_le<std::uint32_t>(out, 0);
  put_le(out, m.acknowledged);
  put_le(out, m.job);
  put_text(out, reasons);
  for (const Supply& supply : m.supplies) {
    const std::string_view name = std::string_view(supply.name).substr(0, kMaxTextBytes);
    put_le(out, static_cast<std::uint8_t>(supply.level_percent < 0 ? 255 : supply.level_percent));
    put_le(out, static_cast<std::uint8_t>(name.size()));
    put_text(out, name);
  }
  return out;
}

std::optional<Status> decode_status(View in) {
  if (in.size() < kStatusBytes || get_le<std::uint32_t>(in, 4) != 0) return std::nullopt;
  const auto state = get_le<std::uint8_t>(in, 0);
  if (state < 3 || state > 5) return std::nullopt;
  Status m;
  m.state = static_cast<State>(state);
  const std::size_t supplies = get_le<std::uint8_t>(in, 1);
  const std::size_t reason_bytes = get_le<std::uint16_t>(in, 2);
  m.acknowledged = get_le<std::uint32_t>(in, 8);
  m.job = get_le<std::uint64_t>(in, 12);
  View rest = in.subspan(kStatusBytes);
  if (rest.size() < reason_bytes) return std::nullopt;
  const std::string reasons = get_text(rest.first(reason_bytes));
  rest = rest.subspan(reason_bytes);
  for (std::size_t begin = 0; begin < reasons.size();) {
    const std::size_t end = std::min(reasons.find(',', begin), reasons.size());
    if (end > begin) m.reasons.push_back(reasons.substr(begin, end - begin));
    begin = end + 1;
  }
  for (std::size_t i = 0; i < supplies; ++i) {
    if (rest.size() < 2) return std::nullopt;
    const int level = get_le<std::uint8_t>(rest, 0);
    const std::size_t name_bytes = get_le<std::uint8_t>(rest, 1);
    if (rest.size() - 2 < name_bytes || (level > 100 && level != 255)) return std::nullopt;
    m.supplies.push_back({get_text(rest.subspan(2, name_bytes)), level == 255 ? -1 : level});
    rest = rest.subspan(2 + name_bytes);
  }
  if (!rest.empty()) return std::nullopt;
  return m;
}

Bytes encode(const Refused& m) {
  Bytes out;
  put_le(out, m.sequence);
  put_le(out, static_cast<std::uint16_t>(m.reason));
  put_le<std::uint16_t>(out, 0);
  put_le(out, m.job);
  put_text(out, std::string_view(m.text).substr(0, kMaxTextBytes));
  return out;
}

std::optional<Refused> decode_refused(View in) {
  if (in.size() < kRefusedBytes || in.size() > kRefusedBytes + kMaxTextBytes) return std::nullopt;
  if (get_le<std::uint16_t>(in, 6) != 0) return std::nullopt;
  return Refused{get_le<std::uint32_t>(in, 0), static_cast<Refusal>(get_le<std::uint16_t>(in, 4)),
                 get_le<std::uint64_t>(in, 8), get_text(in.subspan(kRefusedBytes))};
}

Bytes encode_key(std::uint64_t job) {
  Bytes out;
  put_le(out, job);
  return out;
}

std::optional<std::uint64_t> decode_key(View in) {
  if (in.size() != 8) return std::nullopt;
  return get_le<std::uint64_t>(in, 0);
}

std::uint64_t first_digest(std::string_view header, std::uint32_t layers) {
  return checksum(as_bytes(header), layers);
}

std::uint64_t next_digest(std::uint64_t digest, View records) { return checksum(records, digest); }

}  // namespace binderjet::protocol
