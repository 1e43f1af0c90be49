// SPDX-License-Identifier: GPL-3.0-or-later
// Creases darkened: ambient occlusion and concavity at samples of the mesh, mixed like any color.
//
//   occluded = share of rays over the hemisphere that hit the mesh within the radius
//   concave  = 2 * sum of heights above the tangent plane / sum of distances, over near samples
//   dark     = strength * min(1, 1.5 occluded + concave)
//
// Occlusion is the coarse scale. Concavity is the fine one: near samples that lie above the tangent
// plane are the walls of a groove.
#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "slicer/color/color.h"
#include "slicer/color/triangle_tree.h"

namespace binderjet {
namespace {

using CgalKernel = CGAL::Simple_cartesian<double>;
using Place = CgalKernel::Point_3;
using Vector = CgalKernel::Vector_3;

// More would cost minutes and show nothing: on a part as large as the bed these are 0.6 mm apart.
constexpr double kMaxSamples = 300'000;
constexpr int kDirections = 32;
constexpr unsigned kAround = 24;  // samples that say how the surface bends

struct Samples {
  std::vector<Place> places;
  std::vector<Vector> normals;
};

// Evenly over the surface, by the R2 sequence.
Samples sample(const Mesh& mesh, double spacing_mm) {
  struct Face {
    Place a;
    Vector ab, ac, cross;
    double area;
  };
  const auto face = [&](const Triangle& t) {
    const auto place = [&](int corner) {
      const Point& p = mesh.points[static_cast<std::size_t>(corner)];
      return Place(p[0], p[1], p[2]);
    };
    const Place a = place(t[0]);
    Face f{a, place(t[1]) - a, place(t[2]) - a, {}, 0};
    f.cross = CGAL::cross_product(f.ab, f.ac);
    f.area = std::sqrt(f.cross.squared_length()) / 2;
    return f;
  };
  double total = 0;
  for (const Triangle& t : mesh.triangles) total += face(t).area;
  const double per_mm2 = std::min(1 / (spacing_mm * spacing_mm), kMaxSamples / total);
  Samples samples;
  double owed = 1;  // one sample at least, however small the part
  double u = 0.5;
  double v = 0.5;
  for (const Triangle& t : mesh.triangles) {
    const Face f = face(t);
    if (!(f.area > 0)) continue;
    for (owed += f.area * per_mm2; owed >= 1; owed -= 1) {
      u = std::fmod(u + 0.7548776662466927, 1.0);
      v = std::fmod(v + 0.5698402909980532, 1.0);
      const bool outside = u + v > 1;
      samples.places.push_back(f.a + f.ab * (outside ? 1 - u : u) + f.ac * (outside ? 1 - v : v));
      samples.normals.push_back(f.cross / (2 * f.area));
    }
  }
  return samples;
}

// Directions over the hemisphere of +z, as many as light from there counts (by the cosine).
std::vector<Vector> hemisphere() {
  std::vector<Vector> directions;
  constexpr double kGoldenAngle = 2.399963229728653;
  for (int i = 0; i < kDirections; ++i) {
    const double r = std::sqrt((i + 0.5) / kDirections);
    directions.emplace_back(r * std::cos(i * kGoldenAngle), r * std::sin(i * kGoldenAngle),
                            std::sqrt(1 - r * r));
  }
  return directions;
}

// Occlusion by what stands within the radius, 0 to 1. Rays of different lengths make near things
// count more than far ones.
double occlusion(const TriangleTree& tree, const Place& place, const Vector& n, double radius_mm,
                 const std::vector<Vector>& directions) {
  const Vector other = std::abs(n.x()) < 0.6 ? Vector(1, 0, 0) : Vector(0, 1, 0);
  Vector s = CGAL::cross_product(n, other);
  s = s / std::sqrt(s.squared_length());
  const Vector t = CGAL::cross_product(n, s);
  const Place from = place + n * (0.01 * radius_mm);
  int hits = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Vector& d = directions[i];
    // A stride that has no factor in common with their number takes the lengths through in turn.
    const double length = radius_mm * (0.1 + 0.9 * static_cast<double>(i * 13 % kDirections) /
                                                 static_cast<double>(kDirections));
    const Vector ray = s * d.x() + t * d.y() + n * d.z();
    if (tree.do_intersect(CgalKernel::Segment_3(from, from + ray * length))) ++hits;
  }
  return static_cast<double>(hits) / kDirections;
}

std::vector<int> triangles_between(const Mesh& mesh, double low_mm, double high_mm) {
  std::vector<int> found;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto z = [&](std::size_t corner) {
      return mesh.points[static_cast<std::size_t>(mesh.triangles[t][corner])][2];
    };
    if (std::max({z(0), z(1), z(2)}) >= low_mm && std::min({z(0), z(1), z(2)}) <= high_mm) {
      found.push_back(static_cast<int>(t));
    }
  }
  return found;
}

class CreaseField : public ColorField {
 public:
  CreaseField(std::shared_ptr<const ColorField> base, std::shared_ptr<const ColorField> shade)
      : base_(std::move(base)), shade_(std::move(shade)) {}
  std::unique_ptr<ColorSlab> slab(double low_mm, double high_mm) const override {
    return std::make_unique<Slab>(base_->slab(low_mm, high_mm), shade_->slab(low_mm, high_mm));
  }

 private:
  class Slab : public ColorSlab {
   public:
    Slab(std::unique_ptr<ColorSlab> base, std::unique_ptr<ColorSlab> shade)
        : base_(std::move(base)), shade_(std::move(shade)) {}
    FloatRgb at(const Point& point) const override {
      FloatRgb color = base_->at(point);
      const float shade = shade_->at(point)[0] / 255;
      for (float& channel : color) channel *= shade;
      return color;
    }

   private:
    std::unique_ptr<ColorSlab> base_;
    std::unique_ptr<ColorSlab> shade_;
  };
  std::shared_ptr<const ColorField> base_;
  std::shared_ptr<const ColorField> shade_;
};

}  // namespace

std::shared_ptr<const ColorField> crease_field(std::shared_ptr<const ColorField> base,
                                               const Mesh& mesh, const ColorSettings& settings,
                                               const Work& work) {
  const double radius_mm = settings.crease_radius_mm;
  const Samples samples = sample(mesh, radius_mm / 8);

  using Map = CGAL::Pointer_property_map<Place>::const_type;
  using Traits = CGAL::Search_traits_adapter<std::size_t, Map, CGAL::Search_traits_3<CgalKernel>>;
  using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;
  const Map map = CGAL::make_property_map(samples.places);
  std::vector<std::size_t> indices(samples.places.size());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i;
  Search::Tree neighbors(indices.begin(), indices.end(), Search::Tree::Splitter(), Traits(map));
  neighbors.build();

  const std::vector<Vector> directions = hemisphere();
  std::vector<Rgb> shades(samples.places.size());
  Stage stage(work, "darkening creases", static_cast<std::int64_t>(shades.size()), "samples");
  const auto shade = [&](const TriangleTree& tree, std::size_t i) {
    const Place& here = samples.places[i];
    const Vector& normal = samples.normals[i];
    const double occluded = occlusion(tree, here, normal, radius_mm, directions);
    double above = 0;
    double away = 0;
    const Search::Distance distance(map);
    const Search search(neighbors, here, kAround, 0, true, distance);
    for (const auto& [index, squared] : search) {
      if (squared > radius_mm * radius_mm) continue;
      above += (samples.places[index] - here) * normal;
      away += std::sqrt(squared);
    }
    const double concave = away > 0 ? std::max(0.0, 2 * above / away) : 0.0;
    const double dark = settings.crease_strength * std::min(1.0, 1.5 * occluded + concave);
    const auto level = static_cast<std::uint8_t>(std::lround(255 * (1 - dark)));
    shades[i] = {level, level, level};
  };

  // In bands of z, each with a tree of the triangles its rays can meet: a tree of a whole scan
  // would be the largest thing in memory.
  const Box box = bounding_box(mesh);
  const double band_mm = std::max(4 * radius_mm, box.size(2) / 32);
  std::vector<std::size_t>& by_z = indices;
  std::sort(by_z.begin(), by_z.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(samples.places[a].z(), a) < std::pair(samples.places[b].z(), b);
  });
  for (std::size_t first = 0; first < by_z.size();) {
    const double low_mm = samples.places[by_z[first]].z();
    std::size_t last = first;
    while (last < by_z.size() && samples.places[by_z[last]].z() <= low_mm + band_mm) ++last;
    const std::vector<int> near =
        triangles_between(mesh, low_mm - 1.1 * radius_mm, low_mm + band_mm + 1.1 * radius_mm);
    TriangleTree tree(near.cbegin(), near.cend(), TriangleView{&mesh.points, &mesh.triangles});
    tree.build();
    oneapi::tbb::parallel_for(first, last, [&](std::size_t i) {
      shade(tree, by_z[i]);
      stage.advance();
    });
    first = last;
  }
  std::vector<Point> points;
  points.reserve(samples.places.size());
  for (const Place& p : samples.places) points.push_back({p.x(), p.y(), p.z()});
  return std::make_shared<CreaseField>(std::move(base),
                                       sample_field(points, std::move(shades), settings.neighbors));
}

}  // namespace binderjet
