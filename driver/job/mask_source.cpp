// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/mask_source.h"

#include <filesystem>
#include <utility>
#include <vector>

#include "driver/base/transport_errors.h"
#include "transport/job/job_file.h"

namespace binderjet {
namespace {

class SourceStream : public Stream<RunLayer> {
 public:
  explicit SourceStream(const MaskSource& source) : source_(source), rest_(source.layers()) {}
  LayerRange rest() const override { return rest_; }
  std::vector<Shared<RunLayer>> next(int count) override {
    const int last = std::min(rest_.last, rest_.first + count);
    std::vector<Shared<RunLayer>> out(static_cast<std::size_t>(last - rest_.first));
    oneapi::tbb::parallel_for(rest_.first, last, [&](int layer) {
      out[static_cast<std::size_t>(layer - rest_.first)] =
          std::make_shared<const RunLayer>(source_.read(layer - source_.first));
    });
    rest_.first = last;
    return out;
  }

 private:
  const MaskSource& source_;
  LayerRange rest_;
};

std::vector<std::byte> read_layer(const JobReader& reader, RecordKind kind, int layer,
                                  std::size_t size) {
  return value_or_throw(reader.read(kind, layer, size));
}

MaskSource open_stack(const std::string& path) {
  auto reader = std::make_shared<const StackReader>(path);
  const StackInfo& info = reader->info();
  if (info.kind != StackKind::kMask) {
    throw Error(ErrorKind::kBadInput, path,
                "is a stack of kind " + word(info.kind) + "; masks are needed here");
  }
  MaskSource source;
  source.path = path;
  source.size_px = info.size;
  source.first = info.first;
  source.pitch_mm = info.pitch_mm;
  source.origin_mm = info.origin_mm;
  source.packed = [reader](int index) { return pack(reader->read(index)); };
  return source;
}

}  // namespace

std::unique_ptr<Stream<RunLayer>> MaskSource::stream() const {
  return std::make_unique<SourceStream>(*this);
}

JobPlace MaskSource::place() const {
  JobPlace place;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    place.origin_mm[axis] = origin_mm[axis];
    place.size_mm[axis] = size_px[axis] * pitch_mm[axis];
  }
  return place;
}

StackInfo MaskSource::stack_info(StackKind kind) const {
  StackInfo info;
  info.kind = kind;
  info.size = size_px;
  info.pitch_mm = pitch_mm;
  info.origin_mm = origin_mm;
  info.files = word(kind) + "_%06d.png";
  info.first = first;
  return info;
}

MaskSource open_job(const std::string& path, const Console& console) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw Error(ErrorKind::kUsage, path, "is a folder; a job (.bjob) is needed here");
  }
  auto reader = std::make_shared<const JobReader>(value_or_throw(JobReader::open(path)));
  const std::vector<int> layers = reader->layers(RecordKind::kMask);
  if (!reader->whole()) console.warning(path + ": " + reader->damage());
  if (layers.empty()) throw Error(ErrorKind::kBadInput, path, "holds no whole layer");
  if (static_cast<int>(layers.size()) != layers.back() - layers.front() + 1) {
    throw Error(ErrorKind::kBadInput, path, "lacks layers in its middle; slice it again");
  }
  MaskSource source;
  source.path = path;
  source.header = parse_job_header(reader->header(), path);
  source.first = layers.front();
  source.size_px = source.header->box.size_px;
  if (layers.back() >= source.size_px[2]) {
    throw Error(ErrorKind::kBadInput, path, "holds more layers than its header says");
  }
  source.size_px[2] = static_cast<int>(layers.size());
  source.pitch_mm = source.header->grid.pitch_mm;
  source.origin_mm = source.header->origin_mm();
  source.origin_mm[2] = source.first * source.pitch_mm[2];
  const std::size_t size =
      packed_row_bytes(source.size_px[0]) * static_cast<std::size_t>(source.size_px[1]);
  source.packed = [reader, size, first = source.first](int index) {
    return read_layer(*reader, RecordKind::kMask, first + index, size);
  };
  if (source.header->color) {
    const std::size_t bytes = 3 * static_cast<std::size_t>(source.size_px[0]) *
                              static_cast<std::size_t>(source.size_px[1]);
    source.color = [reader, bytes, first = source.first](int index) {
      return read_layer(*reader, RecordKind::kColor, first + index, bytes);
    };
  }
  return source;
}

MaskSource open_masks(const std::string& path, const Console& console) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return open_stack(path);
  return open_job(path, console);
}

}  // namespace binderjet
