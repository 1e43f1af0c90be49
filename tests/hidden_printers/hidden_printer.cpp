// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/hidden_printers/hidden_printer.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "tests/hidden_printers/hidden_wear.h"

namespace binderjet::hidden {
namespace {

constexpr double kPixelX = 25.4 / 300;
constexpr double kPixelY = 25.4 / 450;
constexpr double kLayer = 0.102;

struct Image {
  int nx = 0;
  int ny = 0;
  std::vector<float> v;

  Image(int x, int y)
      : nx(x), ny(y), v(static_cast<std::size_t>(x) * static_cast<std::size_t>(y)) {}
  float& at(int x, int y) {
    return v[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) +
             static_cast<std::size_t>(x)];
  }
  float get(int x, int y) const {
    if (x < 0 || y < 0 || x >= nx || y >= ny) return 0;
    return v[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) +
             static_cast<std::size_t>(x)];
  }
};

std::vector<double> box_weights(double width_vx) {
  const int reach = static_cast<int>(std::ceil(width_vx / 2 - 0.5));
  std::vector<double> out;
  for (int i = -reach; i <= reach; ++i) {
    const double low = std::max(i - 0.5, -width_vx / 2);
    const double high = std::min(i + 0.5, width_vx / 2);
    out.push_back(std::max(0.0, high - low) / width_vx);
  }
  return out;
}
std::vector<double> gauss_weights(double sigma_vx) {
  const int reach = static_cast<int>(std::ceil(4 * sigma_vx));
  std::vector<double> out;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i)
    sum += out.emplace_back(std::exp(-i * i / (2 * sigma_vx * sigma_vx)));
  for (double& w : out) w /= sum;
  return out;
}

Image convolved(const Image& in, const std::vector<double>& wx, const std::vector<double>& wy) {
  const int rx = static_cast<int>(wx.size()) / 2;
  const int ry = static_cast<int>(wy.size()) / 2;
  Image mid(in.nx, in.ny);
  for (int y = 0; y < in.ny; ++y) {
    for (int i = -rx; i <= rx; ++i) {
      const auto w = static_cast<float>(wx[static_cast<std::size_t>(i + rx)]);
      const int first = std::max(0, i);
      const int last = std::min(in.nx, in.nx + i);
      for (int x = first; x < last; ++x) mid.at(x, y) += w * in.get(x - i, y);
    }
  }
  Image out(in.nx, in.ny);
  for (int i = -ry; i <= ry; ++i) {
    const auto w = static_cast<float>(wy[static_cast<std::size_t>(i + ry)]);
    for (int y = std::max(0, i); y < std::min(in.ny, in.ny + i); ++y) {
      for (int x = 0; x < in.nx; ++x) out.at(x, y) += w * mid.get(x, y - i);
    }
  }
  return out;
}

At at_voxel(double x, double y, int layer) {
  return {(x + 0.5) * kPixelX / 2, (y + 0.5) * kPixelY / 2, (layer + 0.5) * kLayer, layer};
}

// The mask on the voxel grid, moved and dosed drop by drop.
Image binder(const Printer& printer, const RunLayer& mask, int layer) {
  Image fine(2 * mask.width(), 2 * mask.height());
  for (int y = 0; y < mask.height(); ++y) {
    const double drops = printer.drops ? printer.drops(at_voxel(0, 2 * y + 0.5, layer)) : 1;
    const auto row = mask.row(y);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      for (int x = 2 * row[i]; x < 2 * row[i + 1]; ++x) {
        double drop = drops;
        if (printer.drop_of_line && i == 0) {
          // Two voxels are one drop.
          drop *= printer.drop_of_line((x / 2 - row[i] + 0.5) * kPixelX);
        }
        fine.at(x, 2 * y) = static_cast<float>(drop);
        fine.at(x, 2 * y + 1) = static_cast<float>(drop);
      }
    }
  }
  if (!printer.shift_mm) return fine;
  Image moved(fine.nx, fine.ny);
  for (int y = 0; y < fine.ny; ++y) {
    for (int x = 0; x < fine.nx; ++x) {
      const auto by = printer.shift_mm(at_voxel(x, y, layer));
      const double u = x - by[0] / (kPixelX / 2);
      const double v = y - by[1] / (kPixelY / 2);
      const int i = static_cast<int>(std::floor(u));
      const int j = static_cast<int>(std::floor(v));
      const auto a = static_cast<float>(u - i);
      const auto b = static_cast<float>(v - j);
      moved.at(x, y) = (1 - b) * ((1 - a) * fine.get(i, j) + a * fine.get(i + 1, j)) +
                       b * ((1 - a) * fine.get(i, j + 1) + a * fine.get(i + 1, j + 1));
    }
  }
  return moved;
}

// The share of solid in a ball around each fourth voxel of each layer, spread to all voxels.
std::vector<Image> ball_shares(const std::vector<Image>& masks, double radius_mm) {
  constexpr int kCoarse = 8;
  const int nx = masks.front().nx / kCoarse + 1;
  const int ny = masks.front().ny / kCoarse + 1;
  const int nz = static_cast<int>(masks.size());
  std::vector<Image> coarse(masks.size(), Image(nx, ny));
  for (std::size_t k = 0; k < masks.size(); ++k) {
    for (int y = 0; y < masks[k].ny; ++y) {
      for (int x = 0; x < masks[k].nx; ++x) {
        coarse[k].at(x / kCoarse, y / kCoarse) += masks[k].get(x, y) / (kCoarse * kCoarse);
      }
    }
  }
  const double px = kCoarse * kPixelX / 2;
  const double py = kCoarse * kPixelY / 2;
  std::vector<Image> out(masks.size(), Image(nx, ny));
  oneapi::tbb::parallel_for(0, nz, [&](int k) {
    const int rz = static_cast<int>(radius_mm / kLayer);
    double volume = 0;
    for (int dz = -rz; dz <= rz; ++dz) {
      const double left = radius_mm * radius_mm - dz * dz * kLayer * kLayer;
      const int ry = static_cast<int>(std::sqrt(std::max(0.0, left)) / py);
      for (int dy = -ry; dy <= ry; ++dy) {
        const int rx = static_cast<int>(std::sqrt(std::max(0.0, left - dy * dy * py * py)) / px);
        volume += 2 * rx + 1;
        if (k + dz < 0 || k + dz >= nz) continue;
        const Image& from = coarse[static_cast<std::size_t>(k + dz)];
        for (int y = 0; y < ny; ++y) {
          float run = 0;
          for (int x = -rx; x < nx; ++x) {
            run += from.get(x + rx, y + dy) - from.get(x - rx - 1, y + dy);
            if (x >= 0) out[static_cast<std::size_t>(k)].at(x, y) += run;
          }
        }
      }
    }
    for (float& share : out[static_cast<std::size_t>(k)].v) share /= static_cast<float>(volume);
  });
  std::vector<Image> fine(masks.size(), Image(masks.front().nx, masks.front().ny));
  for (std::size_t k = 0; k < masks.size(); ++k) {
    for (int y = 0; y < fine[k].ny; ++y) {
      for (int x = 0; x < fine[k].nx; ++x) {
        const double u = (x + 0.5) / kCoarse - 0.5;
        const double v = (y + 0.5) / kCoarse - 0.5;
        const int i = std::clamp(static_cast<int>(std::floor(u)), 0, nx - 2);
        const int j = std::clamp(static_cast<int>(std::floor(v)), 0, ny - 2);
        const auto a = static_cast<float>(std::clamp(u - i, 0.0, 1.0));
        const auto b = static_cast<float>(std::clamp(v - j, 0.0, 1.0));
        fine[k].at(x, y) = (1 - b) * ((1 - a) * out[k].get(i, j) + a * out[k].get(i + 1, j)) +
                           b * ((1 - a) * out[k].get(i, j + 1) + a * out[k].get(i + 1, j + 1));
      }
    }
  }
  return fine;
}

RunLayer cut(const Image& image, float level) {
  RunLayer out(image.nx);
  for (int y = 0; y < image.ny; ++y) {
    bool solid = false;
    for (int x = 0; x <= image.nx; ++x) {
      const bool here = x < image.nx && image.get(x, y) >= level;
      if (here != solid) out.flip(x);
      solid = here;
    }
    out.end_row();
  }
  return out;
}

}  // namespace

MeasuredJob part(const std::string& name, std::array<double, 3> size_mm, int variant) {
  MeasuredJob job;
  job.name = name;
  job.grid = {{kPixelX, kPixelY, kLayer}, {2, 2, 2}};
  const int nx = static_cast<int>(size_mm[0] / kPixelX);
  const int ny = static_cast<int>(size_mm[1] / kPixelY);
  const int nz = static_cast<int>(size_mm[2] / kLayer);
  job.place.size_mm = {nx * kPixelX, ny * kPixelY};
  const double edge = 0.9;
  const double v = variant * 0.37;
  const double sx = size_mm[0];
  const double sy = size_mm[1];
  const double sz = size_mm[2];
  for (int k = 0; k < nz; ++k) {
    const double z = (k + 0.5) * kLayer;
    RunLayer mask(nx);
    for (int j = 0; j < ny; ++j) {
      const double y = (j + 0.5) * kPixelY;
      bool before = false;
      for (int i = 0; i <= nx; ++i) {
        const double x = (i + 0.5) * kPixelX;
        bool solid = i < nx && x > edge && x < sx - edge && y > edge && y < sy - edge;
        // Copies at pitches that share no divisor: slots along y, then along x, then walls.
        const double u = std::fmod(x + v, 2.3);
        const double w = std::fmod(y + v, 1.9);
        const int copy = static_cast<int>((x + v) / 2.3);
        const int copy_y = static_cast<int>((y + v) / 1.9);
        const bool left = x < sx * 0.5;
        const bool low = y < sy * 0.5;
        if (left && low && z > 0.2 * sz) solid = solid && u > 0.45 + 0.13 * (copy % 6);
        if (!left && low && z > 0.15 * sz) solid = solid && w > 0.25 + 0.09 * (copy_y % 7);
        if (left && !low && z > 0.4 * sz) {
          solid = solid && (u < 0.5 + 0.16 * (copy % 7) || w < 0.2 + 0.1 * (copy_y % 5));
        }
        if (!left && !low) {
          // A wedge, an overhang, a round hole and a closed pocket.
          const double cx = x - 0.75 * sx;
          const double cy = y - 0.75 * sy;
          const double r = std::hypot(cx, cy);
          solid = solid && r > 0.08 * sx + 0.3 * z;
          if (x > 0.9 * sx - 0.5 * z) solid = solid && z > 0.5 * sz;
          if (r > 0.15 * sx && r < 0.17 * sx && z > 0.3 * sz && z < 0.7 * sz) solid = false;
          if (cx < -0.15 * sx && cy < -0.12 * sy) solid = solid && cy + 0.3 * cx > -0.2 * sy + z;
        }
        if (solid != before) mask.flip(i);
        before = solid;
      }
      mask.end_row();
    }
    job.masks.push_back(std::make_shared<const RunLayer>(std::move(mask)));
  }
  return job;
}

void print(const Printer& printer, MeasuredJob& job, unsigned seed) {
  const auto count = static_cast<std::size_t>(job.layers());
  const double vx = kPixelX / 2;
  const double vy = kPixelY / 2;
  std::vector<double> wx = box_weights(printer.width_mm[0] / vx);
  std::vector<double> wy = box_weights(printer.width_mm[1] / vy);
  if (printer.gaussian) {
    wx = gauss_weights(printer.width_mm[0] / vx / std::sqrt(12.0));
    wy = gauss_weights(printer.width_mm[1] / vy / std::sqrt(12.0));
  }
  std::vector<Image> masks(count, Image(0, 0));
  std::vector<Image> spread(count, Image(0, 0));
  oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
    const int layer = static_cast<int>(k);
    const int from = printer.layer_of ? printer.layer_of(layer) : layer;
    const RunLayer powder = RunLayer::powder(job.masks[k]->width(), job.masks[k]->height());
    masks[k] = binder(
        printer,
        from < 0 || from >= job.layers() ? powder : *job.masks[static_cast<std::size_t>(from)],
        layer);
    spread[k] = convolved(masks[k], wx, wy);
    if (printer.tail_share > 0) {
      const Image wide = convolved(masks[k], gauss_weights(printer.tail_mm / vx),
                                   gauss_weights(printer.tail_mm / vy));
      const auto s = static_cast<float>(printer.tail_share);
      for (std::size_t i = 0; i < wide.v.size(); ++i) {
        spread[k].v[i] = (1 - s) * spread[k].v[i] + s * wide.v[i];
      }
    }
  });
  std::vector<Image> shares;
  if (printer.density != 0) shares = ball_shares(masks, printer.ball_mm);
  std::vector<Image> dose(count, Image(0, 0));
  oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
    Image sum = spread[k];
    double share = 1;
    for (std::size_t above = k + 1; printer.bleed_down > 0 && above < count; ++above) {
      share *= printer.bleed_down;
      if (share < 1e-4) break;
      for (std::size_t i = 0; i < sum.v.size(); ++i) {
        sum.v[i] += static_cast<float>(share) * spread[above].v[i];
      }
    }
    if (k > 0) {
      for (std::size_t i = 0; i < sum.v.size(); ++i) {
        sum.v[i] += static_cast<float>(printer.wick_up) * spread[k - 1].v[i];
      }
    }
    for (int y = 0; y < sum.ny; ++y) {
      for (int x = 0; x < sum.nx; ++x) {
        float& d = sum.at(x, y);
        if (printer.gain)
          d *= static_cast<float>(printer.gain(at_voxel(x, y, static_cast<int>(k))));
        if (printer.density != 0) {
          d += static_cast<float>(printer.density * (shares[k].get(x, y) - 0.5));
        }
      }
    }
    if (seed != 0) {
      std::mt19937 engine(seed * 7919U + static_cast<unsigned>(k));
      std::normal_distribution<float> normal;
      Image noise(sum.nx, sum.ny);
      for (float& n : noise.v) n = normal(engine);
      noise = convolved(noise, gauss_weights(printer.noise_mm / vx),
                        gauss_weights(printer.noise_mm / vy));
      double power = 0;
      for (const float n : noise.v) power += static_cast<double>(n) * n;
      const auto scale = static_cast<float>(printer.noise /
                                            std::sqrt(power / static_cast<double>(noise.v.size())));
      for (std::size_t i = 0; i < sum.v.size(); ++i) sum.v[i] += scale * noise.v[i];
    }
    dose[k] = std::move(sum);
  });
  const auto level = static_cast<float>(printer.level) - 1e-6F;
  if (printer.wear_mm > 0) {
    std::vector<Image> solid(count, Image(0, 0));
    for (std::size_t k = 0; k < count; ++k) {
      solid[k] = dose[k];
      for (float& d : solid[k].v) d = d >= level ? 1.F : 0.F;
      solid[k] = convolved(solid[k], gauss_weights(printer.wear_mm / vx),
                           gauss_weights(printer.wear_mm / vy));
    }
    const std::vector<double> up = gauss_weights(printer.wear_mm / kLayer);
    const int reach = static_cast<int>(up.size()) / 2;
    for (int k = 0; k < static_cast<int>(count); ++k) {
      Image& out = dose[static_cast<std::size_t>(k)];
      std::fill(out.v.begin(), out.v.end(), 0.F);
      for (int d = -reach; d <= reach; ++d) {
        if (k + d < 0 || k + d >= static_cast<int>(count)) continue;
        const auto w = static_cast<float>(up[static_cast<std::size_t>(d + reach)]);
        for (std::size_t i = 0; i < out.v.size(); ++i) {
          out.v[i] += w * solid[static_cast<std::size_t>(k + d)].v[i];
        }
      }
    }
  }
  std::vector<Shared<RunLayer>> layers(count);
  const float cut_at = printer.wear_mm > 0 ? 0.5F - 1e-6F : level;
  oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
    layers[k] = std::make_shared<const RunLayer>(cut(dose[k], cut_at));
  });
  job.prints.push_back(worn(printer, std::move(layers), {vx, vy, kLayer}));
}

}  // namespace binderjet::hidden
