// SPDX-License-Identifier: GPL-3.0-or-later
// Drops wet a window of pixels and sink one layer; a pixel that got enough binds.
#include "driver/emulator/printed_volume.h"

#include <zstd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "slicer/base/error.h"
#include "transport/job/job_format.h"

namespace binderjet {
namespace {

// This printer's own physics, in drops: nobody measured it, and whoever calibrates has to find it.
// A pixel is wetted by the drops around it, further along x than along y, and by what sinks from
// the layer above; the top of a part, with nothing above it, comes out narrower.
constexpr int kReachX = 2;
constexpr int kReachY = 1;
constexpr int kSinkReachX = 1;
constexpr int kSinks = 2;  // drops, if any fell above
constexpr int kBinds = 7;  // drops

// A header is a claim: a layer of more than this is none that any printer has.
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

using Bits = std::vector<std::uint8_t>;  // one byte a pixel, with a dry margin around

}  // namespace

struct PowderBed::Plane {
  int width, height;
  Bits bits;
  Plane(int w, int h)
      : width(w),
        height(h),
        bits(static_cast<std::size_t>(w + 2 * kReachX) *
             static_cast<std::size_t>(h + 2 * kReachY)) {}
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y + kReachY) * static_cast<std::size_t>(width + 2 * kReachX) +
           static_cast<std::size_t>(x + kReachX);
  }
  int drops(int x, int y, int reach_x) const {
    int sum = 0;
    for (int i = x - reach_x; i <= x + reach_x; ++i) sum += bits[at(i, y)];
    return sum;
  }
};

PowderBed::PowderBed(const std::string& header, int layer_count) {
  const auto wrong = [] {
    return Error(ErrorKind::kBadInput, "",
                 "the job's header does not say how large its layers are; slice it again");
  };
  info_.kind = StackKind::kMeasured;
  info_.files = "measured_%06d.png";
  try {
    const auto fields = nlohmann::json::parse(header);
    fields.at("size_px").get_to(info_.size);
    info_.pitch_mm = fields.value("pitch_mm", std::array<double, 3>{0.1, 0.1, 0.1});
    info_.origin_mm = fields.value("origin_mm", std::array<double, 3>{0, 0, 0});
  } catch (const nlohmann::json::exception&) {
    throw wrong();
  }
  info_.size[2] = layer_count;
  const auto is_pitch = [](double mm) { return mm > 1e-6 && mm < 1e6; };
  if (!std::all_of(info_.pitch_mm.begin(), info_.pitch_mm.end(), is_pitch) || info_.size[0] < 1 ||
      info_.size[1] < 1 || std::int64_t{info_.size[0]} * info_.size[1] > kMaxPixels) {
    throw wrong();
  }
}

PowderBed::~PowderBed() = default;

std::optional<std::vector<std::byte>> PowderBed::take(std::span<const std::byte> records) {
  const int width = info_.size[0];
  const int height = info_.size[1];
  const std::size_t row_bytes = (static_cast<std::size_t>(width) + 7) / 8;
  const std::size_t size = row_bytes * static_cast<std::size_t>(height);
  while (const auto head = job_format::decode_record_head(records)) {
    if (records.size() - job_format::kRecordHeadBytes < head->frame_bytes) break;
    const auto frame = records.subspan(job_format::kRecordHeadBytes, head->frame_bytes);
    records = records.subspan(job_format::kRecordHeadBytes + head->frame_bytes);
    if (head->kind != RecordKind::kMask) continue;
    if (head->payload_bytes != size) break;
    std::vector<unsigned char> packed(size);
    if (ZSTD_decompress(packed.data(), size, frame.data(), frame.size()) != size) break;
    auto plane = std::make_unique<Plane>(width, height);
    for (int y = 0; y < height; ++y) {
      const unsigned char* row = packed.data() + row_bytes * static_cast<std::size_t>(y);
      for (int x = 0; x < width; ++x) {
        plane->bits[plane->at(x, y)] = static_cast<std::uint8_t>(row[x / 8] >> (7 - x % 8) & 1);
      }
    }
    std::optional<std::vector<std::byte>> below;
    if (newest_) below = bind(*newest_, plane.get());
    newest_ = std::move(plane);
    return below;
  }
  throw Error(ErrorKind::kBadInput, "",
              "a layer has no mask of the size that the job's header names; slice it again");
}

std::optional<std::vector<std::byte>> PowderBed::top() const {
  if (!newest_) return std::nullopt;
  return bind(*newest_, nullptr);
}

std::vector<std::byte> PowderBed::bind(const Plane& mask, const Plane* above) {
  const std::size_t row_bytes = (static_cast<std::size_t>(mask.width) + 7) / 8;
  std::vector<std::byte> out(row_bytes * static_cast<std::size_t>(mask.height));
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      int binder = 0;
      for (int j = y - kReachY; j <= y + kReachY; ++j) binder += mask.drops(x, j, kReachX);
      if (above != nullptr && above->drops(x, y, kSinkReachX) > 0) binder += kSinks;
      if (binder < kBinds) continue;
      std::byte& byte =
          out[row_bytes * static_cast<std::size_t>(y) + static_cast<std::size_t>(x) / 8];
      byte |= static_cast<std::byte>(0x80 >> x % 8);
    }
  }
  return out;
}

PrintedVolume print_volume(const EmulatedJob& job) {
  PowderBed bed(job.header, static_cast<int>(job.layers.size()));
  PrintedVolume volume{bed.info().size, bed.info().pitch_mm, bed.info().origin_mm, {}};
  for (const std::vector<std::byte>& records : job.layers) {
    if (auto layer = bed.take(records)) volume.layers.push_back(*std::move(layer));
  }
  if (auto layer = bed.top()) volume.layers.push_back(*std::move(layer));
  return volume;
}

void write_measured(const PrintedVolume& volume, const std::string& folder) {
  StackInfo info;
  info.kind = StackKind::kMeasured;
  info.size = volume.size_px;
  info.pitch_mm = volume.pitch_mm;
  info.origin_mm = volume.origin_mm;
  info.files = "measured_%06d.png";
  StackWriter stack(folder, info);
  for (std::size_t layer = 0; layer < volume.layers.size(); ++layer) {
    stack.write_packed(static_cast<int>(layer), volume.layers[layer]);
  }
  stack.finish();
}

}  // namespace binderjet
