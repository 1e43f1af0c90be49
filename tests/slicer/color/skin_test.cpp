// SPDX-License-Identifier: GPL-3.0-or-later
// The skin against the paper's words by brute force, and the shell against distances by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/slicer/color/colored_layers.h"

namespace binderjet {
namespace {

using colored::Layers;

struct Vertices {
  std::vector<Point> points;
  std::vector<Rgb> colors;
  std::shared_ptr<const ColorField> field() const { return sample_field(points, colors, 4); }
};

// Colors that vary over some times `length_mm`, none of them white.
Vertices waves(const Mesh& mesh, double length_mm = 1) {
  Vertices out;
  for (const Point& p : mesh.points) {
    out.points.push_back(p);
    out.colors.push_back(rgb_of(0.45 + 0.3 * std::sin(p[0] / length_mm),
                                0.45 + 0.3 * std::sin((p[1] + p[2]) / length_mm),
                                0.45 + 0.3 * std::cos((p[2] - p[0]) / length_mm)));
  }
  return out;
}

// The nearest four vertices, weighted by the inverse distance (paper, 4.4), in a dozen lines.
std::array<double, 3> reference(const Vertices& vertices, const Point& at) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < vertices.points.size(); ++i) {
    const Point& p = vertices.points[i];
    order.emplace_back(std::hypot(p[0] - at[0], p[1] - at[1], p[2] - at[2]), i);
  }
  std::partial_sort(order.begin(), order.begin() + 4, order.end());
  std::array<double, 3> sum{};
  double weights = 0;
  for (int n = 0; n < 4; ++n) {
    const auto [distance, index] = order[static_cast<std::size_t>(n)];
    if (distance == 0) {
      const Rgb& c = vertices.colors[index];
      return {double(c[0]), double(c[1]), double(c[2])};
    }
    for (std::size_t c = 0; c < 3; ++c) sum[c] += vertices.colors[index][c] / distance;
    weights += 1 / distance;
  }
  for (double& value : sum) value /= weights;
  return sum;
}

bool voxel(const Layers& layers, int x, int y, int slice) {
  if (slice < 0 || slice >= 2 * layers.box.size_px[2]) return false;
  return layers.targets[static_cast<std::size_t>(slice / 2)]
      ->slices[static_cast<std::size_t>(slice % 2)]
      .at(x, y);
}

bool boundary_voxel(const Layers& layers, int x, int y, int s) {
  return voxel(layers, x, y, s) &&
         !(voxel(layers, x - 1, y, s) && voxel(layers, x + 1, y, s) && voxel(layers, x, y - 1, s) &&
           voxel(layers, x, y + 1, s) && voxel(layers, x, y, s - 1) && voxel(layers, x, y, s + 1));
}

// The centers of a pixel's boundary voxels.
std::vector<Point> boundary_centers(const Layers& layers, int i, int j, int k) {
  std::vector<Point> centers;
  for (int v = 0; v < 8; ++v) {
    const int x = 2 * i + (v & 1), y = 2 * j + (v >> 1 & 1), s = 2 * k + (v >> 2);
    if (!boundary_voxel(layers, x, y, s)) continue;
    centers.push_back({layers.grid.center_mm(0, x - 2 * layers.box.margin_px[0]),
                       layers.grid.center_mm(1, y - 2 * layers.box.margin_px[1]),
                       layers.grid.center_mm(2, s)});
  }
  return centers;
}

// The share of pixels with boundary voxels, in the mask or not, whose color is within `levels` of
// `want`, which is given the centers of these voxels.
template <class Want>
double share_within(const Layers& layers, double levels, Want want) {
  std::int64_t compared = 0;
  std::int64_t close = 0;
  for (int k = 0; k < layers.box.size_px[2]; k += 2) {
    for (int j = 0; j < layers.box.size_px[1]; ++j) {
      for (int i = 0; i < layers.box.size_px[0]; ++i) {
        const std::vector<Point> centers = boundary_centers(layers, i, j, k);
        if (centers.empty()) continue;
        const std::array<double, 3> color = want(centers);
        bool equal = true;
        for (std::size_t c = 0; c < 3; ++c) {
          equal &= std::abs(layers.at(i, j, k)[c] - color[c]) <= levels;
        }
        ++compared;
        close += equal ? 1 : 0;
      }
    }
  }
  EXPECT_GT(compared, 3000);
  return static_cast<double>(close) / static_cast<double>(compared);
}

TEST(Skin, IsTheMeanOfTheNearestFourVerticesOverThePixelsBoundaryVoxels) {
  const Mesh mesh = models::at_origin(models::sphere(2.2, 4));
  const Vertices vertices = waves(mesh);
  const Layers layers = colored::paint(mesh, vertices.field());
  const double share = share_within(layers, 1, [&](const std::vector<Point>& centers) {
    std::array<double, 3> mean{};
    for (const Point& center : centers) {
      const std::array<double, 3> color = reference(vertices, center);
      for (std::size_t c = 0; c < 3; ++c) {
        mean[c] += color[c] / static_cast<double>(centers.size());
      }
    }
    return mean;
  });
  EXPECT_EQ(share, 1);
}

TEST(Skin, EqualsTheNearestFourVerticesAtAnyBoundaryVoxelWhereColorVariesSlowly) {
  const Mesh mesh = models::at_origin(models::sphere(2.2, 4));
  const Vertices vertices = waves(mesh, 10);
  const Layers layers = colored::paint(mesh, vertices.field());
  const double share = share_within(layers, 3, [&](const std::vector<Point>& centers) {
    return reference(vertices, centers.front());
  });
  EXPECT_GE(share, 0.99);
}

TEST(Skin, ASampleAtTheVoxelDecidesAlone) {
  const auto field = sample_field({{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {1, 1, 1}},
                                  {{10, 20, 30}, {200, 0, 0}, {0, 200, 0}, {0, 0, 200}}, 4);
  const FloatRgb color = field->slab(0, 1)->at({0, 0, 0});
  EXPECT_EQ(color, (FloatRgb{10, 20, 30}));
}

TEST(Shell, LeavesNoBoundaryPixelOfAnEnhancedMaskUncoloredAndNoColorOutOfRange) {
  const Mesh mesh = models::at_origin(models::golf_ball(3, 4));
  const Vertices vertices = waves(mesh);
  Rgb low = kWhite;
  Rgb high{};
  for (const Rgb& color : vertices.colors) {
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], color[c]);
      high[c] = std::max(high[c], color[c]);
    }
  }
  for (const double depth_mm : {0.0, 0.6}) {
    const Layers layers = colored::paint(mesh, vertices.field(), 2, depth_mm);
    std::int64_t boundary = 0;
    for (int k = 0; k < layers.box.size_px[2]; ++k) {
      for (int y = 0; y < layers.box.size_px[1]; ++y) {
        for (int x = 0; x < layers.box.size_px[0]; ++x) {
          const Rgb color = layers.at(x, y, k);
          if (layers.on_boundary(x, y, k)) {
            ++boundary;
            ASSERT_NE(color, kWhite) << x << ' ' << y << ' ' << k;
          }
          if (!layers.mask(x, y, k) && boundary_centers(layers, x, y, k).empty()) {
            ASSERT_EQ(color, kWhite);
          }
          if (color == kWhite) continue;
          for (std::size_t c = 0; c < 3; ++c) {
            ASSERT_GE(color[c], low[c]);
            ASSERT_LE(color[c], high[c]);
          }
        }
      }
    }
    EXPECT_GT(boundary, 1000);
  }
}

TEST(Shell, GoesAsDeepAsItIsToldAlongEveryAxis) {
  const Mesh mesh = models::box({0, 0, 0}, {5.08, 5.08, 5.1});  // 60 x 90 pixels, 50 layers
  const Layers layers = colored::paint(mesh, plain_field({200, 0, 0}), 0, 0.6);
  const int x = layers.box.size_px[0] / 2;
  const int y = layers.box.size_px[1] / 2;
  const int k = layers.box.size_px[2] / 2;
  const auto depth = [&](auto colored_at) {
    int count = 0;
    while (colored_at(count)) ++count;
    return count;
  };
  const auto& margin = layers.box.margin_px;
  const auto is_red = [&](int i, int j, int layer) {
    return layers.at(i, j, layer) == Rgb{200, 0, 0};
  };
  // Centers at (n + 1/2) pitch below the face, up to 0.6 mm: 7 of 0.0847, 11 of 0.0564, 6 of 0.102.
  EXPECT_EQ(depth([&](int n) { return is_red(margin[0] + n, y, k); }), 7);
  EXPECT_EQ(depth([&](int n) { return is_red(x, margin[1] + n, k); }), 11);
  EXPECT_EQ(depth([&](int n) { return is_red(x, y, n); }), 6);
  EXPECT_EQ(depth([&](int n) { return is_red(x, y, layers.box.size_px[2] - 1 - n); }), 6);
  EXPECT_EQ(layers.at(x, y, k), kWhite);
}

TEST(Shell, GivesTheNearestSkinWhereverBruteForceLooks) {
  const Mesh mesh = models::at_origin(models::sphere(1.5, 3));
  const Vertices vertices = waves(mesh);
  const Layers layers = colored::paint(mesh, vertices.field());
  const Layers thin = colored::paint(mesh, vertices.field(), 0, 0);
  std::mt19937 random(7);
  int inside = 0;
  for (int n = 0; n < 4000; ++n) {
    const auto pick = [&](std::size_t axis) {
      return static_cast<int>(random() % static_cast<unsigned>(layers.box.size_px[axis]));
    };
    const int x = pick(0), y = pick(1), k = pick(2);
    if (!layers.mask(x, y, k) || layers.on_boundary(x, y, k)) continue;
    double least = 1e9;
    std::vector<Rgb> nearest;
    for (int dk = -8; dk <= 8; ++dk) {
      for (int dy = -12; dy <= 12; ++dy) {
        for (int dx = -9; dx <= 9; ++dx) {
          if (!layers.mask(x + dx, y + dy, k + dk) || !thin.on_boundary(x + dx, y + dy, k + dk)) {
            continue;
          }
          double mm2 = 0;
          const std::array<int, 3> d = {dx, dy, dk};
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const double mm =
                d[axis] == 0 ? 0 : (std::abs(d[axis]) + 0.5) * layers.grid.pitch_mm[axis];
            mm2 += mm * mm;
          }
          if (mm2 < least - 1e-6) nearest.clear();
          if (mm2 < least + 1e-6) nearest.push_back(thin.at(x + dx, y + dy, k + dk));
          least = std::min(least, mm2);
        }
      }
    }
    if (std::abs(least - 0.36) < 0.04 || nearest.empty()) continue;
    ++inside;
    // Boundary pixels of the mask and pixels with boundary voxels differ by a pixel here and there,
    // and so do their colors, a little.
    const Rgb got = layers.at(x, y, k);
    if (least > 0.36) {
      EXPECT_EQ(got, kWhite);
      continue;
    }
    bool close = false;
    for (const Rgb& c : nearest) {
      close |= std::abs(c[0] - got[0]) + std::abs(c[1] - got[1]) + std::abs(c[2] - got[2]) < 40;
    }
    EXPECT_TRUE(close) << x << ' ' << y << ' ' << k;
  }
  EXPECT_GT(inside, 500);
}

TEST(Shell, SharesAreTheWholeByteForByte) {
  const Mesh mesh = models::at_origin(models::sphere(1.5, 3));
  for (const bool painted_triangles : {false, true}) {
    std::shared_ptr<const ColorField> field = waves(mesh).field();
    if (painted_triangles) {
      Paint paint;
      paint.points = mesh.points;
      paint.triangles = mesh.triangles;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto level = static_cast<std::uint8_t>(t % 250);
        const Rgb c = {level, static_cast<std::uint8_t>(250 - level), 99};
        paint.corners.push_back({c, c, c});
      }
      field = surface_field(std::move(paint), {});
    }
    const Layers whole = colored::paint(mesh, field);
    for (const LayerRange range : {LayerRange{0, 5}, LayerRange{5, 18}, LayerRange{18, 30}}) {
      const Layers share = colored::paint(mesh, field, 0, 0.6, range);
      for (int k = range.first; k < range.last; ++k) {
        ASSERT_EQ(share.bitmaps[static_cast<std::size_t>(k - range.first)],
                  whole.bitmaps[static_cast<std::size_t>(k)]);
      }
    }
  }
}

}  // namespace
}  // namespace binderjet
