// SPDX-License-Identifier: GPL-3.0-or-later
// A reader's word: whatever a file holds, it is read or refused with an Error, and what was read is
// sound. Nothing else is thrown.
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "driver/job/job.h"
#include "driver/profile/profile.h"
#include "slicer/base/error.h"
#include "slicer/calibrate/gauges/gauge_slots.h"
#include "slicer/calibrate/gauges/length_blocks.h"
#include "slicer/mesh/read/read_mesh.h"
#include "slicer/model/printer_model.h"
#include "slicer/stack/slice_stack.h"
#include "tests/fuzz/targets.h"
#include "transport/job/job_file.h"

namespace binderjet {
namespace {

std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// A folder of this process, in memory where there is such a place.
class Folder {
 public:
  Folder() {
    std::error_code error;
    const std::filesystem::path memory = "/dev/shm";
    const auto base = std::filesystem::is_directory(memory, error)
                          ? memory
                          : std::filesystem::temp_directory_path();
    std::string name = (base / "binderjet-fuzz-XXXXXX").string();
    require(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~Folder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path() const { return path_; }
  std::string write(const std::string& name, std::string_view text) const {
    std::string file = path_ + "/" + name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  std::string path_;
};

const Folder& folder() {
  static const Folder here;
  return here;
}

template <class Read>
void read_or_refuse(Read read) {
  try {
    read();
  } catch (const Error&) {
  }
}

void read_model(const std::string& name, std::string_view text) {
  const std::string path = folder().write(name, text);
  read_or_refuse([&] {
    const MeshFile file = read_mesh(path);
    const auto points = static_cast<int>(file.mesh.points.size());
    require(!file.mesh.triangles.empty());
    for (const Triangle& triangle : file.mesh.triangles) {
      for (const int corner : triangle) require(corner >= 0 && corner < points);
    }
    for (const Point& point : file.mesh.points) {
      for (const double value : point) require(std::isfinite(value));
    }
  });
}

}  // namespace

void fuzz_stl(const std::uint8_t* data, std::size_t size) {
  read_model("a.stl", text_of(data, size));
}

void fuzz_ply(const std::uint8_t* data, std::size_t size) {
  read_model("a.ply", text_of(data, size));
}

void fuzz_obj(const std::uint8_t* data, std::size_t size) {
  // What follows this line is a.mtl.
  constexpr std::string_view kMaterials = "\n#a.mtl\n";
  const std::string text = text_of(data, size);
  const std::size_t at = text.find(kMaterials);
  // Anew each time: what an earlier input left must not decide.
  folder().write("a.mtl", at == std::string::npos ? "" : text.substr(at + kMaterials.size()));
  read_model("a.obj", text.substr(0, at));
}

void fuzz_off(const std::uint8_t* data, std::size_t size) {
  read_model("a.off", text_of(data, size));
}

void fuzz_wrl(const std::uint8_t* data, std::size_t size) {
  read_model("a.wrl", text_of(data, size));
}

void fuzz_3mf(const std::uint8_t* data, std::size_t size) {
  read_model("a.3mf", text_of(data, size));
}

void fuzz_gltf(const std::uint8_t* data, std::size_t size) {
  read_model("a.gltf", text_of(data, size));
}

void fuzz_profile(const std::uint8_t* data, std::size_t size) {
  read_or_refuse([&] {
    const Profile profile = parse_profile(text_of(data, size), "a.toml");
    const Grid grid = profile.grid(std::nullopt);
    for (int axis = 0; axis < 3; ++axis) require(grid.voxel_mm(axis) > 0);
  });
}

void fuzz_job(const std::uint8_t* data, std::size_t size) {
  const std::string text = text_of(data, size);
  // A header by itself, so that the fuzzer need not guess checksums; then a file.
  read_or_refuse([&] {
    const JobHeader header = parse_job_header(text, "a.bjob");
    const std::string again = to_text(header);
    require(to_text(parse_job_header(again, "a.bjob")) == again);
  });
  const std::string path = folder().write("a.bjob", text);
  const Result<JobReader> job = JobReader::open(path);
  if (!job) return;
  std::vector<int> layers = job->layers(RecordKind::kMask);
  if (layers.size() > 4) layers.resize(4);
  for (const int layer : layers) static_cast<void>(job->read(RecordKind::kMask, layer));
}

void fuzz_stack(const std::uint8_t* data, std::size_t size) {
  folder().write("stack.json", text_of(data, size));
  folder().write("mask_000000.png", "\x89PNG\r\n");
  read_or_refuse([&] {
    const StackReader stack(folder().path());
    for (const int count : stack.info().size) require(count > 0);
    stack.read(0);
  });
}

void fuzz_gauges(const std::uint8_t* data, std::size_t size) {
  const std::string path = folder().write("a.csv", text_of(data, size));
  read_or_refuse([&] {
    const GaugeTable table = read_gauge_table(path);
    for (const GaugeTable::Row& row : table.rows) {
      require(row.cells.size() == table.header.size());
    }
    if (has_slots(table)) read_slots(table);
    if (!axes_in(table).empty()) blocks_of(table);
  });
}

}  // namespace binderjet
