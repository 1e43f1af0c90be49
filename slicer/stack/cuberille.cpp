// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/stack/cuberille.h"

#include <fmt/format.h>

#include <array>
#include <unordered_map>
#include <utility>
#include <vector>

#include "slicer/base/error.h"
#include "slicer/base/whole_file.h"

namespace binderjet {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// The corners of one plane between two layers that have a vertex so far.
class Plane {
 public:
  Plane() = default;
  explicit Plane(int layer) : layer_(layer) {}
  int layer() const { return layer_; }
  // The vertex at pixel corner (i, j); `make` writes a new one.
  template <class Make>
  std::int32_t vertex(int i, int j, Make make) {
    const std::uint64_t key = static_cast<std::uint64_t>(j) << 32 | static_cast<std::uint32_t>(i);
    const auto [place, added] = vertices_.try_emplace(key, 0);
    if (added) place->second = make(i, j, layer_);
    return place->second;
  }

 private:
  int layer_ = 0;
  std::unordered_map<std::uint64_t, std::int32_t> vertices_;
};

// Calls take(x, y) for each voxel of a row that is 1 in `a` and 0 in `b`.
template <class Take>
void for_each_only_in(std::span<const int> a, std::span<const int> b, Take take) {
  std::size_t other = 0;
  for (std::size_t i = 0; i < a.size(); i += 2) {
    for (int x = a[i]; x < a[i + 1]; ++x) {
      while (other < b.size() && b[other] <= x) ++other;
      if (other % 2 == 0) take(x);
    }
  }
}

}  // namespace

struct CuberilleWriter::State {
  State(const std::string& path, const Grid& voxels) : out(path), grid(voxels) {}

  WholeFile out;
  Grid grid;
  File vertices{nullptr, std::fclose};
  File faces{nullptr, std::fclose};
  std::int64_t vertex_count = 0;
  std::int64_t face_count = 0;
  RunLayer below;
  Plane low;   // under the layer being added
  Plane high;  // above it

  void put(std::FILE* file, const void* bytes, std::size_t size) const {
    if (std::fwrite(bytes, 1, size, file) != size) fail_to_write(out.path());
  }
  std::int32_t corner(Plane& plane, int i, int j) {
    return plane.vertex(i, j, [this](int x, int y, int layer) {
      const std::array<double, 3> at{x * grid.pitch_mm[0], y * grid.pitch_mm[1],
                                     layer * grid.pitch_mm[2]};
      put(vertices.get(), at.data(), sizeof at);
      return static_cast<std::int32_t>(vertex_count++);
    });
  }
  // Counter-clockwise seen from outside.
  void quad(const std::array<std::int32_t, 4>& corners) {
    const std::uint8_t four = 4;
    put(faces.get(), &four, 1);
    put(faces.get(), corners.data(), sizeof corners);
    ++face_count;
  }
  // The squares in plane `plane` where `inside` is 1 and `outside` is 0.
  void flat_faces(const RunLayer& inside, const RunLayer& outside, Plane& plane, bool up) {
    for (int j = 0; j < inside.height(); ++j) {
      for_each_only_in(inside.row(j), outside.row(j), [&](int i) {
        const std::int32_t a = corner(plane, i, j);
        const std::int32_t b = corner(plane, i + 1, j);
        const std::int32_t c = corner(plane, i + 1, j + 1);
        const std::int32_t d = corner(plane, i, j + 1);
        quad(up ? std::array{a, b, c, d} : std::array{a, d, c, b});
      });
    }
  }
  void side_faces(const RunLayer& mask) {
    for (int j = 0; j < mask.height(); ++j) {
      const std::span<const int> row = mask.row(j);
      for (std::size_t n = 0; n < row.size(); ++n) {  // faces that look along x
        const int i = row[n];
        const bool to_left = n % 2 == 0;
        wall(to_left ? std::array{i, j + 1} : std::array{i, j},
             to_left ? std::array{i, j} : std::array{i, j + 1});
      }
      for_each_only_in(row, mask.row(j - 1), [&](int i) { wall({i, j}, {i + 1, j}); });
      for_each_only_in(row, mask.row(j + 1), [&](int i) { wall({i + 1, j + 1}, {i, j + 1}); });
    }
  }
  // A square on the pixel edge from -> to, outside to its right.
  void wall(std::array<int, 2> from, std::array<int, 2> to) {
    quad({corner(low, from[0], from[1]), corner(low, to[0], to[1]), corner(high, to[0], to[1]),
          corner(high, from[0], from[1])});
  }
};

CuberilleWriter::CuberilleWriter(const std::string& path, const Grid& grid)
    : state_(std::make_unique<State>(path, grid)) {
  state_->vertices.reset(std::fopen(state_->out.part().c_str(), "wb+"));
  state_->faces.reset(std::tmpfile());
  if (!state_->vertices || !state_->faces) fail_to_write(path);
  // The counts are known only at the end, so their places are kept free.
  const std::string space(256, ' ');
  state_->put(state_->vertices.get(), space.data(), space.size());
}

CuberilleWriter::~CuberilleWriter() = default;

void CuberilleWriter::add(const RunLayer& mask) {
  State& s = *state_;
  s.high = Plane(s.low.layer() + 1);
  s.flat_faces(s.below, mask, s.low, true);
  s.flat_faces(mask, s.below, s.low, false);
  s.side_faces(mask);
  s.below = mask;
  s.low = std::move(s.high);
}

void CuberilleWriter::complete() {
  State& s = *state_;
  s.flat_faces(s.below, RunLayer(), s.low, true);
  if (s.vertex_count > INT32_MAX) {
    throw Error(ErrorKind::kNoRoom, s.out.path(),
                "the cuberille has more than 2^31 vertices; export masks instead");
  }

  std::rewind(s.faces.get());
  std::vector<char> piece(1 << 20);
  while (const std::size_t got = std::fread(piece.data(), 1, piece.size(), s.faces.get())) {
    s.put(s.vertices.get(), piece.data(), got);
  }
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n"
      "property double y\nproperty double z\nelement face {}\n"
      "property list uchar int vertex_indices\n",
      s.vertex_count, s.face_count);
  const std::string end = "end_header\n";
  const std::string comment = "comment ";
  header += comment;
  header.resize(256 - end.size() - 1, ' ');
  header += "\n" + end;
  std::rewind(s.vertices.get());
  s.put(s.vertices.get(), header.data(), header.size());
  if (std::fclose(s.vertices.release()) != 0) fail_to_write(s.out.path());
}

void CuberilleWriter::finish() {
  if (state_->vertices) complete();
  state_->out.keep();
}

}  // namespace binderjet
