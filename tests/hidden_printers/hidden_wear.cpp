// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/hidden_printers/hidden_wear.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace binderjet::hidden {
namespace {

// A byte per voxel.
struct Solid3 {
  int nx = 0;
  int ny = 0;
  int nz = 0;
  std::vector<char> v;

  std::size_t place(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(x);
  }
  char at(int x, int y, int z) const {
    return x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz ? char{0} : v[place(x, y, z)];
  }
};

Solid3 dense(const std::vector<Shared<RunLayer>>& layers) {
  Solid3 out{
      layers.front()->width(), layers.front()->height(), static_cast<int>(layers.size()), {}};
  for (const Shared<RunLayer>& layer : layers) {
    for (int y = 0; y < out.ny; ++y) {
      const std::size_t begin = out.v.size();
      out.v.resize(begin + static_cast<std::size_t>(out.nx), 0);
      const auto row = layer->row(y);
      for (std::size_t i = 0; i < row.size(); i += 2) {
        for (int x = row[i]; x < row[i + 1]; ++x) out.v[begin + static_cast<std::size_t>(x)] = 1;
      }
    }
  }
  return out;
}

std::vector<Shared<RunLayer>> runs(const Solid3& solid) {
  std::vector<Shared<RunLayer>> out;
  for (int z = 0; z < solid.nz; ++z) {
    RunLayer layer(solid.nx);
    for (int y = 0; y < solid.ny; ++y) {
      for (int x = 0; x <= solid.nx; ++x) {
        if (solid.at(x, y, z) != solid.at(x - 1, y, z)) layer.flip(x);
      }
      layer.end_row();
    }
    out.push_back(std::make_shared<const RunLayer>(std::move(layer)));
  }
  return out;
}

// What stands thinner than `min_mm` along x or y within its layer is gone: walls by the length of
// the run that they are in, first in rows, then in columns of what is left.
void break_thin(Solid3& solid, double min_mm, const std::array<double, 3>& voxel_mm) {
  const auto sweep = [&](int lines, int length, double step_mm, auto place) {
    for (int line = 0; line < lines; ++line) {
      for (int i = 0; i < length;) {
        int end = i;
        while (end < length && solid.v[place(line, end)] != 0) ++end;
        if ((end - i) * step_mm < min_mm - 1e-9) {
          for (int k = i; k < end; ++k) solid.v[place(line, k)] = 0;
        }
        i = end + 1;
      }
    }
  };
  for (int z = 0; z < solid.nz; ++z) {
    sweep(solid.ny, solid.nx, voxel_mm[0], [&](int y, int x) { return solid.place(x, y, z); });
    sweep(solid.nx, solid.ny, voxel_mm[1], [&](int x, int y) { return solid.place(x, y, z); });
  }
}

// Every voxel within `radius_mm` of one that is `value` becomes `value`. Beyond the stack in z
// nothing is, beyond it in x and y all is powder.
Solid3 spread_of(const Solid3& in, char value, double radius_mm,
                 const std::array<double, 3>& voxel_mm) {
  std::array<int, 3> reach{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    reach[axis] = static_cast<int>(radius_mm / voxel_mm[axis] + 1e-9);
  }
  Solid3 out = in;
  oneapi::tbb::parallel_for(0, in.nz, [&](int z) {
    for (int y = 0; y < in.ny; ++y) {
      for (int x = 0; x < in.nx; ++x) {
        if (in.at(x, y, z) == value) continue;
        bool near = false;
        for (int c = -reach[2]; c <= reach[2] && !near; ++c) {
          if (z + c < 0 || z + c >= in.nz) continue;
          for (int b = -reach[1]; b <= reach[1] && !near; ++b) {
            for (int a = -reach[0]; a <= reach[0] && !near; ++a) {
              near =
                  in.at(x + a, y + b, z + c) == value &&
                  std::hypot(a * voxel_mm[0], b * voxel_mm[1], c * voxel_mm[2]) <= radius_mm + 1e-9;
            }
          }
        }
        if (near) out.v[out.place(x, y, z)] = value;
      }
    }
  });
  return out;
}

}  // namespace

std::vector<Shared<RunLayer>> worn(const Printer& printer, std::vector<Shared<RunLayer>> layers,
                                   const std::array<double, 3>& voxel_mm) {
  if (printer.thinnest_mm <= 0 && printer.soak_mm <= 0) return layers;
  Solid3 solid = dense(layers);
  if (printer.thinnest_mm > 0) break_thin(solid, printer.thinnest_mm, voxel_mm);
  if (printer.soak_mm > 0) {
    // Glue stands in every gap that is narrower than its drop, and a skin of it stays.
    const Solid3 wet = spread_of(solid, 1, printer.soak_mm, voxel_mm);
    solid = spread_of(wet, 0, printer.soak_mm - printer.skin_mm, voxel_mm);
  }
  return runs(solid);
}

}  // namespace binderjet::hidden
