// SPDX-License-Identifier: GPL-3.0-or-later
// Drops wet a window of pixels and sink one layer; a pixel that got enough binds.
#include "driver/emulator/printed_volume.h"

#include <zstd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "slicer/stack/slice_stack.h"
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

using Bits = std::vector<std::uint8_t>;  // one byte a pixel, with a dry margin around

struct Plane {
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

// The mask among a layer's records.
Plane unpack_mask(const std::vector<std::byte>& records, int width, int height) {
  const std::size_t row_bytes = (static_cast<std::size_t>(width) + 7) / 8;
  const std::size_t size = row_bytes * static_cast<std::size_t>(height);
  std::span<const std::byte> rest = records;
  while (const auto head = job_format::decode_record_head(rest)) {
    if (rest.size() - job_format::kRecordHeadBytes < head->frame_bytes) break;
    const auto frame = rest.subspan(job_format::kRecordHeadBytes, head->frame_bytes);
    rest = rest.subspan(job_format::kRecordHeadBytes + head->frame_bytes);
    if (head->kind != RecordKind::kMask) continue;
    if (head->payload_bytes != size) break;
    std::vector<unsigned char> packed(size);
    if (ZSTD_decompress(packed.data(), size, frame.data(), frame.size()) != size) break;
    Plane plane(width, height);
    for (int y = 0; y < height; ++y) {
      const unsigned char* row = packed.data() + row_bytes * static_cast<std::size_t>(y);
      for (int x = 0; x < width; ++x) {
        plane.bits[plane.at(x, y)] = static_cast<std::uint8_t>(row[x / 8] >> (7 - x % 8) & 1);
      }
    }
    return plane;
  }
  throw std::runtime_error("a layer without a mask of the header's size");
}

std::vector<std::byte> bind(const Plane& mask, const Plane* above) {
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

}  // namespace

PrintedVolume print_volume(const EmulatedJob& job) {
  const auto header = nlohmann::json::parse(job.header);
  PrintedVolume volume;
  header.at("size_px").get_to(volume.size_px);
  volume.pitch_mm = header.value("pitch_mm", std::array<double, 3>{0.1, 0.1, 0.1});
  volume.origin_mm = header.value("origin_mm", std::array<double, 3>{0, 0, 0});
  volume.size_px[2] = static_cast<int>(job.layers.size());
  std::vector<Plane> masks;  // the layer and the one above it
  for (std::size_t layer = 0; layer < job.layers.size(); ++layer) {
    if (masks.empty()) {
      masks.push_back(unpack_mask(job.layers[layer], volume.size_px[0], volume.size_px[1]));
    }
    if (layer + 1 < job.layers.size()) {
      masks.push_back(unpack_mask(job.layers[layer + 1], volume.size_px[0], volume.size_px[1]));
    }
    volume.layers.push_back(bind(masks[0], masks.size() > 1 ? &masks[1] : nullptr));
    masks.erase(masks.begin());
  }
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
