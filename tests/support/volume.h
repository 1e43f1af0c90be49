// SPDX-License-Identifier: GPL-3.0-or-later
// Voxels one byte each, all of them at once, and slicer/MODEL.md on them in plain loops: what the
// streaming engine must agree with, bit for bit.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/pipeline.h"
#include "slicer/layers/run_layer.h"
#include "slicer/model/printer_model.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet::whole {

struct Volume {
  int nx = 0;
  int ny = 0;
  int nz = 0;
  std::vector<std::uint8_t> bits;

  Volume(int x, int y, int z)
      : nx(x), ny(y), nz(z), bits(static_cast<std::size_t>(x) * static_cast<std::size_t>(y * z)) {}
  bool inside(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz;
  }
  std::size_t place(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(x);
  }
  // Outside is powder.
  int at(int x, int y, int z) const { return inside(x, y, z) ? bits[place(x, y, z)] : 0; }
  void set(int x, int y, int z, bool solid) { bits[place(x, y, z)] = solid ? 1 : 0; }
  template <class Value>
  void fill(Value value) {
    for (int z = 0; z < nz; ++z)
      for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) set(x, y, z, value(x, y, z));
  }
  bool operator==(const Volume&) const = default;
};

// The slicing operator: one mask per layer, at the printer grid.
inline Volume masks(const Volume& v, const Grid& grid) {
  const auto [rx, ry, rz] = grid.detail_vx;
  Volume out(v.nx / rx, v.ny / ry, v.nz / rz);
  out.fill([&, rx = rx, ry = ry, rz = rz](int i, int j, int k) {
    int ones = 0;
    for (int z = k * rz; z < (k + 1) * rz; ++z)
      for (int y = j * ry; y < (j + 1) * ry; ++y)
        for (int x = i * rx; x < (i + 1) * rx; ++x) ones += v.at(x, y, z);
    return 2 * ones >= rx * ry * rz;
  });
  return out;
}

// The boxes of (nx, ny) voxels that fit into each layer.
inline Volume opened(const Volume& v, int nx, int ny) {
  Volume out(v.nx, v.ny, v.nz);
  const auto box = [&](int x, int y, int z, auto act) {
    bool all = true;
    for (int j = y; j < y + ny; ++j)
      for (int i = x; i < x + nx; ++i) all = act(i, j, z) && all;
    return all;
  };
  for (int z = 0; z < v.nz; ++z)
    for (int y = 0; y < v.ny; ++y)
      for (int x = 0; x < v.nx; ++x)
        if (box(x, y, z, [&](int i, int j, int k) { return v.at(i, j, k) == 1; }))
          box(x, y, z, [&](int i, int j, int k) { return out.set(i, j, k, true), true; });
  return out;
}

// The printed voxels, one slice per layer.
inline Volume print(const Volume& mask, const AssembledModel& form, const Grid& grid) {
  const int rx = grid.detail_vx[0];
  const int ry = grid.detail_vx[1];
  Volume out(mask.nx * rx, mask.ny * ry, mask.nz);
  out.fill([&](int x, int y, int k) {
    long double dose = 0;
    for (const DoseTerm& term : form.terms) {
      std::int64_t sum = 0;
      for (int j = term.y.first; j <= term.y.last(); ++j)
        for (int i = term.x.first; i <= term.x.last(); ++i)
          if (x >= i && y >= j && mask.at((x - i) / rx, (y - j) / ry, k + term.layer) == 1)
            sum += term.x.at(i) * term.y.at(j);
      dose += static_cast<long double>(term.gain) * static_cast<long double>(sum) /
              static_cast<long double>(term.x.total()) / static_cast<long double>(term.y.total());
    }
    return dose > 0 && dose >= static_cast<long double>(form.level) * (1 - 1e-12L);
  });
  // Of wear only that of thin parts is known here; all of it is in whole_print.h. It reaches as far as
  // its box is wide, less one.
  for (const Wear& step : form.wear) {
    if (!step.keeps_edges) continue;
    out = opened(out, step.reach.xy_vx[0] + 1, step.reach.xy_vx[1] + 1);
  }
  return out;
}

constexpr int kFaces[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

inline bool at_boundary(const Volume& v, int x, int y, int z) {
  return std::any_of(std::begin(kFaces), std::end(kFaces), [&](const int(&d)[3]) {
    return v.at(x + d[0], y + d[1], z + d[2]) != v.at(x, y, z);
  });
}

// One pass of the paper's rule; `printed` has a slice per layer of rz slices.
inline Volume paper_pass(const Volume& v, const Volume& printed, const Volume& target, int rz) {
  Volume out = v;
  out.fill([&](int x, int y, int z) {
    if (!at_boundary(v, x, y, z)) return v.at(x, y, z) == 1;
    int surplus = 0;
    for (int c = z - 1; c <= z + 1; ++c)
      for (int b = y - 1; b <= y + 1; ++b)
        for (int a = x - 1; a <= x + 1; ++a)
          surplus += (c < 0 ? 0 : printed.at(a, b, c / rz)) - target.at(a, b, c);
    return surplus == 0 ? v.at(x, y, z) == 1 : surplus < 0;
  });
  return out;
}

// The masks after `passes` passes.
inline Volume paper_masks(const Volume& target, const AssembledModel& form, const Grid& grid,
                          int passes) {
  Volume v = target;
  for (int pass = 0; pass < passes; ++pass) {
    v = paper_pass(v, print(masks(v, grid), form, grid), target, grid.detail_vx[2]);
  }
  return masks(v, grid);
}

// Slice z as runs, and back.
inline RunLayer slice(const Volume& v, int z) {
  RunLayer out(v.nx);
  for (int y = 0; y < v.ny; ++y) {
    for (int x = 0; x <= v.nx; ++x) {
      if (v.at(x, y, z) != v.at(x - 1, y, z)) out.flip(x);
    }
    out.end_row();
  }
  return out;
}

inline Volume stacked(const std::vector<Shared<RunLayer>>& layers) {
  Volume out(layers.front()->width(), layers.front()->height(), static_cast<int>(layers.size()));
  out.fill([&](int x, int y, int z) { return layers[static_cast<std::size_t>(z)]->at(x, y); });
  return out;
}

// A volume's layers as a stream, of voxels (rz slices each) or of one slice each.
template <class T>
class VolumeStream : public Stream<T> {
 public:
  VolumeStream(const Volume& volume, int rz, LayerRange layers)
      : volume_(volume), rz_(rz), rest_(layers) {}
  LayerRange rest() const override { return rest_; }
  std::vector<Shared<T>> next(int count) override {
    std::vector<Shared<T>> out;
    for (; count > 0 && rest_.size() > 0; --count) out.push_back(layer(rest_.first++));
    return out;
  }

 private:
  Shared<T> layer(int k) const {
    if constexpr (std::is_same_v<T, RunLayer>) {
      return std::make_shared<const RunLayer>(slice(volume_, k));
    } else {
      auto voxels = std::make_shared<VoxelLayer>();
      for (int z = k * rz_; z < (k + 1) * rz_; ++z) voxels->slices.push_back(slice(volume_, z));
      return voxels;
    }
  }

  Volume volume_;
  int rz_;
  LayerRange rest_;
};

inline std::unique_ptr<Stream<VoxelLayer>> voxel_stream(const Volume& v, int rz,
                                                        LayerRange layers) {
  return std::make_unique<VolumeStream<VoxelLayer>>(v, rz, layers);
}
inline Pipeline<VoxelLayer> voxel_layers(const Volume& v, int rz) {
  return {
      "voxels", {0, v.nz / rz}, [v, rz](LayerRange layers) { return voxel_stream(v, rz, layers); }};
}
inline std::unique_ptr<Stream<RunLayer>> layer_stream(const Volume& v) {
  return std::make_unique<VolumeStream<RunLayer>>(v, 1, LayerRange{0, v.nz});
}

}  // namespace binderjet::whole
