// SPDX-License-Identifier: GPL-3.0-or-later
// The printer model (slicer/MODEL.md) with every effect on the whole volume, in plain loops and
// real numbers: what the streamed engine on runs and integers must agree with.
//
// Three formulas are shared with the engine, each of which has tests of its own: the gain of the
// dose and the shift at a place (BedDependence), the share of weak drops, and the density around a
// place (DensityField). Where binder lands, how it spreads, from which layers it comes and what
// wear takes is written here again.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "slicer/model/printer_model.h"
#include "tests/support/volume.h"

namespace binderjet::whole {

// A print, and which of its voxels the two engines may tell apart by rounding alone.
struct WholePrint {
  Volume voxels;
  Volume unsure;
};

// Layers that get the mask of another layer.
inline Volume moved(const Volume& mask, const AssembledModel& form) {
  Volume out(mask.nx, mask.ny, mask.nz);
  out.fill([&](int x, int y, int z) {
    int from = z;
    for (const LayerMove& move : form.moves) from += move.by(z);
    return mask.at(x, y, from) == 1;
  });
  return out;
}

// Binder per voxel, with room around the masks for what lands beside them.
class Binder {
 public:
  Binder(int nx, int ny, int room)
      : nx_(nx + 2 * room),
        room_(room),
        amount_(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny + 2 * room), 0),
        ny_(ny + 2 * room) {}
  double* at(int x, int y) {
    x += room_;
    y += room_;
    if (x < 0 || y < 0 || x >= nx_ || y >= ny_) return nullptr;
    return &amount_[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_) +
                    static_cast<std::size_t>(x)];
  }
  double get(int x, int y) const {
    const double* amount = const_cast<Binder*>(this)->at(x, y);
    return amount == nullptr ? 0 : *amount;
  }

 private:
  int nx_;
  int room_;
  std::vector<double> amount_;
  int ny_;
};

// Where the binder of one layer lands before it spreads. A pixel covers [edge, next edge) along x
// and its rows along y, both to 1/16 of a voxel; a voxel gets its share of what covers it in part.
inline Binder landed(const Volume& mask, int layer, const AssembledModel& form, const Grid& grid,
                     const JobPlace& place, int room) {
  constexpr int kFine = 16;
  const int rx = grid.detail_vx[0];
  const int ry = grid.detail_vx[1];
  const BedDependence& placed = form.placed;
  Binder out(mask.nx * rx, mask.ny * ry, room);
  for (int y = 0; y < mask.ny; ++y) {
    Spot spot = spot_at(grid, place, rx * mask.nx / 2.0, (y + 0.5) * ry - 0.5, layer);
    const double shift_y = placed.shift_at(spot)[1] / grid.voxel_mm(1);
    const auto edge = [&](int x) {
      spot.x_mm = place.origin_mm[0] + x * grid.pitch_mm[0];
      return std::lround((x * rx + placed.shift_at(spot)[0] / grid.voxel_mm(0)) * kFine);
    };
    int run = -1;
    std::size_t pixel = 0;  // of the run
    for (int x = 0; x < mask.nx; ++x) {
      if (mask.at(x, y, layer) == 0) continue;
      pixel = mask.at(x - 1, y, layer) == 1 ? pixel + 1 : 0;
      run += pixel == 0 ? 1 : 0;
      const bool weak = (run == 0 || placed.weak_after_gaps) && pixel < placed.weak_drops.size();
      const double amount = weak ? 1 - placed.weak_drops[pixel] : 1;
      const long from = edge(x);
      const long to = edge(x + 1);
      for (int row = y * ry; row < (y + 1) * ry; ++row) {
        const long low = row * kFine + std::lround(shift_y * kFine);
        for (long j = low / kFine - 1; j <= low / kFine + 1; ++j) {
          const long high = std::min((j + 1) * kFine, low + kFine);
          const double in_y = static_cast<double>(std::max(0L, high - std::max(j * kFine, low)));
          if (in_y == 0) continue;
          // Shifts may turn a pixel inside out: it then takes binder away.
          const long left = std::min(from, to);
          const long right = std::max(from, to);
          for (long i = left / kFine - 1; i <= right / kFine + 1; ++i) {
            const long in_x =
                std::max(0L, std::min((i + 1) * kFine, right) - std::max(i * kFine, left));
            double* voxel = out.at(static_cast<int>(i), static_cast<int>(j));
            if (voxel == nullptr) continue;
            *voxel +=
                (to > from ? 1 : -1) * amount * in_y * static_cast<double>(in_x) / (kFine * kFine);
          }
        }
      }
    }
  }
  return out;
}

// The binder of one layer, spread.
inline Binder spread(const Binder& in, const Kernel& x_kernel, const Kernel& y_kernel, int nx,
                     int ny, int room) {
  const auto share = [](const Kernel& kernel, int offset) {
    return static_cast<double>(kernel.at(offset)) / static_cast<double>(kernel.total());
  };
  Binder along_x(nx, ny, room);
  for (int y = -room; y < ny + room; ++y)
    for (int x = 0; x < nx; ++x)
      for (int i = x_kernel.first; i <= x_kernel.last(); ++i)
        *along_x.at(x, y) += share(x_kernel, i) * in.get(x - i, y);
  Binder out(nx, ny, room);
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x)
      for (int j = y_kernel.first; j <= y_kernel.last(); ++j)
        *out.at(x, y) += share(y_kernel, j) * along_x.get(x, y - j);
  return out;
}

// What is bound.
inline WholePrint bound(const Volume& sent, const AssembledModel& form, const Grid& grid,
                        const JobPlace& place) {
  const Volume mask = moved(sent, form);
  const int nx = mask.nx * grid.detail_vx[0];
  const int ny = mask.ny * grid.detail_vx[1];
  const BedDependence& placed = form.placed;
  const auto reach = form.reach(grid).xy_vx;
  const int room = std::max(reach[0], reach[1]) + 2;
  std::vector<Binder> binder;
  for (int k = 0; k < mask.nz; ++k) binder.push_back(landed(mask, k, form, grid, place, room));
  // The engine rounds gains of terms to 2^-20 and weak drops to less: no more than this in a dose.
  // A dose of one kernel alone is exact, and a tie counts as bound.
  constexpr double kRounding = 1e-5;
  const bool exact = form.terms.size() == 1 && placed.gains.empty() && placed.shifts.empty() &&
                     placed.weak_drops.empty();
  WholePrint out{Volume(nx, ny, mask.nz), Volume(nx, ny, mask.nz)};
  std::vector<RunLayer> runs;
  for (int k = 0; k < mask.nz; ++k) runs.push_back(slice(mask, k));
  for (int k = 0; k < mask.nz; ++k) {
    Binder dose(nx, ny, 0);
    for (const DoseTerm& term : form.terms) {
      const int from = k + term.layer;
      if (from < 0 || from >= mask.nz) continue;
      const Binder own =
          spread(binder[static_cast<std::size_t>(from)], term.x, term.y, nx, ny, room);
      for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) *dose.at(x, y) += term.gain * own.get(x, y);
    }
    std::optional<DensityField> density;
    if (placed.density_radius_mm) {
      std::vector<const RunLayer*> window;
      const int around = placed.density_layers(grid);
      for (int n = k - around; n <= k + around; ++n) {
        window.push_back(n < 0 || n >= mask.nz ? nullptr : &runs[static_cast<std::size_t>(n)]);
      }
      density.emplace(window, grid, *placed.density_radius_mm);
    }
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        const double gain =
            gain_at_voxel(grid, place, placed, density ? &*density : nullptr, x, y, k);
        const double margin = dose.get(x, y) * gain - form.level;
        out.voxels.set(x, y, k, margin >= -1e-12);
        out.unsure.set(x, y, k, !exact && std::abs(margin) < kRounding);
      }
    }
  }
  return out;
}

// Solid where `all` or any of the voxels within `radius_mm` are; `flat`: within the layer alone.
// What lies beyond the stack in z is left out if `skip`, else it is powder.
inline Volume by_ball(const Volume& v, double radius_mm, const Grid& grid, bool flat, bool all,
                      bool skip) {
  const std::array<double, 3> size{grid.voxel_mm(0), grid.voxel_mm(1), grid.pitch_mm[2]};
  const auto reach = [&](std::size_t axis) { return static_cast<int>(radius_mm / size[axis]) + 1; };
  Volume out(v.nx, v.ny, v.nz);
  out.fill([&](int x, int y, int z) {
    bool result = all;
    for (int c = flat ? 0 : -reach(2); c <= (flat ? 0 : reach(2)); ++c) {
      if (skip && (z + c < 0 || z + c >= v.nz)) continue;
      for (int b = -reach(1); b <= reach(1); ++b) {
        for (int a = -reach(0); a <= reach(0); ++a) {
          const double away = std::hypot(a * size[0], b * size[1], c * size[2]);
          if (away > radius_mm * (1 + 1e-9)) continue;
          const bool solid = v.at(x + a, y + b, z + c) == 1;
          result = all ? result && solid : result || solid;
        }
      }
    }
    return result;
  });
  return out;
}

// The part blurred by a normal distribution along x, y and z, and cut at a half.
inline WholePrint smoothed(const Volume& v, double sigma_mm, const Grid& grid) {
  const std::array<double, 3> size{grid.voxel_mm(0), grid.voxel_mm(1), grid.pitch_mm[2]};
  std::array<int, 3> reach{};
  std::array<std::vector<double>, 3> shares;  // of offsets -reach to reach
  for (std::size_t axis = 0; axis < 3; ++axis) {
    reach[axis] = static_cast<int>(4 * sigma_mm / size[axis]) + 1;
    const double scale = size[axis] / sigma_mm / std::numbers::sqrt2;
    for (int i = -reach[axis]; i <= reach[axis]; ++i) {
      shares[axis].push_back((std::erf((i + 0.5) * scale) - std::erf((i - 0.5) * scale)) / 2);
    }
  }
  const auto share = [&](std::size_t axis, int offset) {
    return shares[axis][static_cast<std::size_t>(offset + reach[axis])];
  };
  // The engine's weights are whole numbers of 1024 along each axis, and cut where 2^-12 lies
  // beyond.
  constexpr double kRounding = 0.02;
  WholePrint out{Volume(v.nx, v.ny, v.nz), Volume(v.nx, v.ny, v.nz)};
  for (int z = 0; z < v.nz; ++z) {
    for (int y = 0; y < v.ny; ++y) {
      for (int x = 0; x < v.nx; ++x) {
        double sum = 0;
        for (int c = -reach[2]; c <= reach[2]; ++c)
          for (int b = -reach[1]; b <= reach[1]; ++b)
            for (int a = -reach[0]; a <= reach[0]; ++a)
              if (v.at(x + a, y + b, z + c) == 1) sum += share(0, a) * share(1, b) * share(2, c);
        out.voxels.set(x, y, z, sum >= 0.5);
        out.unsure.set(x, y, z, std::abs(sum - 0.5) < kRounding);
      }
    }
  }
  return out;
}

// What wear leaves of a bound part; none if `effect` wears nothing that is known here.
inline std::optional<WholePrint> worn(const Volume& part, const EffectSpec& effect,
                                      const Grid& grid) {
  const Volume sure(part.nx, part.ny, part.nz);
  if (effect.kind == "survive") {
    const auto vx = [&](std::size_t axis) {
      return static_cast<int>(std::ceil(
          effect.number("width_mm", axis) / grid.voxel_mm(static_cast<int>(axis)) - 1e-9));
    };
    return WholePrint{opened(part, vx(0), vx(1)), sure};
  }
  if (effect.kind == "infiltrant") {
    const double radius = effect.number("radius_mm");
    const Volume grown = by_ball(part, radius, grid, false, false, true);
    return WholePrint{by_ball(grown, radius - effect.number("skin_mm"), grid, false, true, true),
                      sure};
  }
  if (effect.kind == "rounding") {
    const double radius = effect.number("radius_mm");
    if (effect.words.at("shape") == "gaussian") return smoothed(part, radius, grid);
    const bool flat = effect.words.at("shape") == "disc";
    const Volume eroded = by_ball(part, radius, grid, flat, true, false);
    return WholePrint{by_ball(eroded, radius, grid, flat, false, true), sure};
  }
  return std::nullopt;
}

}  // namespace binderjet::whole
