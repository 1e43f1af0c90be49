// SPDX-License-Identifier: GPL-3.0-or-later
// The color of the nearest point of painted triangles: a tree of boxes (AABB) finds the nearest
// triangle, and the paint is mixed from its corners by the weights a, b, c of that point:
//
//   nearest point = a A + b B + c C,  a + b + c = 1;   color, or place in the texture, likewise
//
// Each layer has a tree of its own, so memory is one layer's triangles and a layer's colors depend
// on nothing but the layer. Equal distances go to the triangle with the lower number.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "slicer/color/field.h"
#include "slicer/color/triangle_tree.h"

namespace binderjet {
namespace {

// Surface this far above and below a layer is in its tree. Boundary voxels are within one voxel
// of the surface; an enhanced mask's within a few.
constexpr double kMarginMm = 1.0;

struct Nearest {
  double squared_mm = std::numeric_limits<double>::infinity();
  int triangle = -1;
  std::array<double, 3> weights{};  // of the corners, at the nearest point
};

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The nearest point of the segment a-b to p, as the weight of b.
double along(const Point& p, const Point& a, const Point& b) {
  const Point ab = minus(b, a);
  const double length = dot(ab, ab);
  return length > 0 ? std::clamp(dot(minus(p, a), ab) / length, 0.0, 1.0) : 0.0;
}

// The weights of the corners at the triangle's point nearest to p.
std::array<double, 3> nearest_weights(const Point& p, const std::array<Point, 3>& t) {
  const Point ab = minus(t[1], t[0]);
  const Point ac = minus(t[2], t[0]);
  const Point ap = minus(p, t[0]);
  const double d00 = dot(ab, ab), d01 = dot(ab, ac), d11 = dot(ac, ac);
  const double d20 = dot(ap, ab), d21 = dot(ap, ac);
  const double area = d00 * d11 - d01 * d01;
  if (area > 0) {
    const double v = (d11 * d20 - d01 * d21) / area;
    const double w = (d00 * d21 - d01 * d20) / area;
    if (v >= 0 && w >= 0 && v + w <= 1) return {1 - v - w, v, w};
  }
  std::array<double, 3> best{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double s = along(p, t[i], t[j]);
    double squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double gap = t[i][axis] + s * (t[j][axis] - t[i][axis]) - p[axis];
      squared += gap * gap;
    }
    if (squared < least) {
      least = squared;
      best = {};
      best[i] = 1 - s;
      best[j] = s;
    }
  }
  return best;
}

// Walks the boxes that may hold something nearer than what was found.
class NearestTraversal {
 public:
  NearestTraversal(const TriangleView& view, double squared_mm) : view_(view) {
    nearest_.squared_mm = squared_mm;
  }
  static bool go_further() { return true; }
  void intersection(const Point& query, const TrianglePrimitive& primitive) {
    const std::array<Point, 3> t = view_.corners(primitive.id());
    const std::array<double, 3> weights = nearest_weights(query, t);
    double squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double gap =
          weights[0] * t[0][axis] + weights[1] * t[1][axis] + weights[2] * t[2][axis] - query[axis];
      squared += gap * gap;
    }
    const bool wins = squared < nearest_.squared_mm ||
                      (squared == nearest_.squared_mm &&
                       (nearest_.triangle < 0 || primitive.id() < nearest_.triangle));
    if (wins) nearest_ = {squared, primitive.id(), weights};
  }
  template <class Node>
  bool do_intersect(const Point& query, const Node& node) const {
    const auto box = node.bbox();
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double q = query[static_cast<std::size_t>(axis)];
      const double gap = std::max({0.0, box.min(axis) - q, q - box.max(axis)});
      squared += gap * gap;
    }
    return squared <= nearest_.squared_mm;
  }
  const Nearest& nearest() const { return nearest_; }

 private:
  TriangleView view_;
  Nearest nearest_;
};

class SurfaceField : public ColorField {
 public:
  SurfaceField(Paint paint, std::vector<std::optional<Texture>> textures)
      : paint_(std::move(paint)), textures_(std::move(textures)) {
    sort_by_height();
  }

  std::unique_ptr<ColorSlab> slab(double low_mm, double high_mm) const override {
    return std::make_unique<Slab>(*this, near(low_mm - kMarginMm, high_mm + kMarginMm));
  }

  TriangleView view() const { return {&paint_.points, &paint_.triangles}; }

  FloatRgb color(const Nearest& nearest) const {
    const auto t = static_cast<std::size_t>(nearest.triangle);
    FloatRgb out = {255, 255, 255};
    for (std::size_t c = 0; c < 3 && !paint_.corners.empty(); ++c) {
      double value = 0;
      for (std::size_t i = 0; i < 3; ++i) value += nearest.weights[i] * paint_.corners[t][i][c];
      out[c] = static_cast<float>(value);
    }
    if (paint_.images.empty() || paint_.images[t] < 0) return out;
    const auto& texture = textures_[static_cast<std::size_t>(paint_.images[t])];
    const std::array<Uv, 3>& corners = paint_.uvs[t];
    Uv uv{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      double value = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        value += nearest.weights[i] * static_cast<double>(corners[i][axis]);
      }
      uv[axis] = static_cast<float>(value);
    }
    const Rgb texel = texture ? texture->at(uv, corners) : kNeutral;
    for (std::size_t c = 0; c < 3; ++c) out[c] *= static_cast<float>(texel[c]) / 255;
    return out;
  }

  // Where a layer's own surface has nothing, all of it is asked, one triangle after the other.
  Nearest nearest_of_all(const Point& point) const {
    NearestTraversal search(view(), std::numeric_limits<double>::infinity());
    const std::vector<int> all =
        near(-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
    for (const int i : all) search.intersection(point, TrianglePrimitive(i));
    return search.nearest();
  }

 private:
  class Slab : public ColorSlab {
   public:
    Slab(const SurfaceField& field, const std::vector<int>& triangles) : field_(field) {
      if (triangles.empty()) return;
      tree_.insert(triangles.begin(), triangles.end(), field.view());
      tree_.build();
      empty_ = false;
    }
    FloatRgb at(const Point& point) const override {
      // Points are asked in rows, so the last one's triangle bounds the walk from the start.
      if (last_.id() >= 0) {
        NearestTraversal search(field_.view(), std::numeric_limits<double>::infinity());
        search.intersection(point, last_);
        if (search.nearest().squared_mm < kMarginMm * kMarginMm) return walk(point, search);
      }
      for (const double reach_mm : {0.1, kMarginMm}) {
        if (empty_) break;
        NearestTraversal search(field_.view(), reach_mm * reach_mm);
        tree_.traversal(point, search);
        if (search.nearest().triangle < 0) continue;
        last_ = TrianglePrimitive(search.nearest().triangle);
        return field_.color(search.nearest());
      }
      return field_.color(field_.nearest_of_all(point));
    }

   private:
    FloatRgb walk(const Point& point, NearestTraversal& search) const {
      tree_.traversal(point, search);
      last_ = TrianglePrimitive(search.nearest().triangle);
      return field_.color(search.nearest());
    }

    const SurfaceField& field_;
    TriangleTree tree_;
    bool empty_ = true;
    mutable TrianglePrimitive last_{-1};
  };

  // Triangles of similar height together, each class in order of lowest points: those that meet a
  // range of z are then a short stretch of each class.
  struct HeightClass {
    double height_mm = 0;  // the largest in the class
    std::vector<std::pair<float, int>> by_low;
  };

  double z(int triangle, std::size_t corner) const {
    const Triangle& t = paint_.triangles[static_cast<std::size_t>(triangle)];
    return paint_.points[static_cast<std::size_t>(t[corner])][2];
  }
  double low(int i) const { return std::min({z(i, 0), z(i, 1), z(i, 2)}); }
  double high(int i) const { return std::max({z(i, 0), z(i, 1), z(i, 2)}); }

  void sort_by_height() {
    constexpr std::size_t kClasses = 24;
    classes_.resize(kClasses);
    for (int i = 0; i < static_cast<int>(paint_.triangles.size()); ++i) {
      const double height = high(i) - low(i);
      const int place = height > 0 ? std::ilogb(height) + 12 : 0;
      HeightClass& of =
          classes_[static_cast<std::size_t>(std::clamp(place, 0, static_cast<int>(kClasses) - 1))];
      of.height_mm = std::max(of.height_mm, height);
      of.by_low.emplace_back(static_cast<float>(low(i)), i);
    }
    for (HeightClass& of : classes_) std::sort(of.by_low.begin(), of.by_low.end());
  }

  std::vector<int> near(double low_mm, double high_mm) const {
    constexpr double kRounding = 1e-3;  // of the lowest points as float; the test below is exact
    std::vector<int> found;
    for (const HeightClass& of : classes_) {
      auto entry = std::lower_bound(
          of.by_low.begin(), of.by_low.end(), low_mm - of.height_mm - kRounding,
          [](const auto& a, double b) { return static_cast<double>(a.first) < b; });
      for (; entry != of.by_low.end() && static_cast<double>(entry->first) <= high_mm + kRounding;
           ++entry) {
        if (low(entry->second) <= high_mm && high(entry->second) >= low_mm) {
          found.push_back(entry->second);
        }
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  Paint paint_;
  std::vector<std::optional<Texture>> textures_;
  std::vector<HeightClass> classes_;
};

}  // namespace

std::shared_ptr<const ColorField> surface_field(Paint paint,
                                                std::vector<std::optional<Texture>> textures) {
  return std::make_shared<SurfaceField>(std::move(paint), std::move(textures));
}

}  // namespace binderjet
