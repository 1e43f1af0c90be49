// SPDX-License-Identifier: GPL-3.0-or-later
// Fields from samples (a kd-tree), of one color, and of a bed.
#include "slicer/color/field.h"

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace binderjet {
namespace {

using CgalKernel = CGAL::Simple_cartesian<double>;
using Place = CgalKernel::Point_3;
using PlaceMap = CGAL::Pointer_property_map<Place>::const_type;
using Traits =
    CGAL::Search_traits_adapter<std::size_t, PlaceMap, CGAL::Search_traits_3<CgalKernel>>;
using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;

class SampleField : public ColorField {
 public:
  SampleField(const std::vector<Point>& samples, std::vector<Rgb> colors, int neighbors)
      : colors_(std::move(colors)), neighbors_(neighbors) {
    places_.reserve(samples.size());
    for (const Point& p : samples) places_.emplace_back(p[0], p[1], p[2]);
    const PlaceMap map = CGAL::make_property_map(std::as_const(places_));
    std::vector<std::size_t> indices(places_.size());
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i;
    tree_ = std::make_unique<Search::Tree>(indices.begin(), indices.end(), Search::Tree::Splitter(),
                                           Traits(map));
    tree_->build();  // now: later it would build itself in whichever thread asks first
  }

  std::unique_ptr<ColorSlab> slab(double, double) const override {
    return std::make_unique<Slab>(*this);
  }

 private:
  class Slab : public ColorSlab {
   public:
    explicit Slab(const SampleField& field)
        : field_(field), distance_(CGAL::make_property_map(field.places_)) {}

    FloatRgb at(const Point& point) const override {
      const Search search(*field_.tree_, Place(point[0], point[1], point[2]),
                          static_cast<unsigned>(field_.neighbors_), 0, true, distance_);
      std::array<double, 3> sum{};
      double weights = 0;
      bool exact = false;
      for (const auto& [index, squared] : search) {
        const bool here = squared == 0;
        if (exact && !here) continue;
        if (here && !exact) {
          exact = true;
          sum = {};
          weights = 0;
        }
        const double weight = here ? 1 : 1 / std::sqrt(squared);
        const Rgb& color = field_.colors_[index];
        for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * color[c];
        weights += weight;
      }
      FloatRgb out{};
      for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<float>(sum[c] / weights);
      return out;
    }

   private:
    const SampleField& field_;
    Search::Distance distance_;
  };

  std::vector<Place> places_;
  std::vector<Rgb> colors_;
  int neighbors_;
  std::unique_ptr<Search::Tree> tree_;
};

class PlainField : public ColorField {
 public:
  explicit PlainField(Rgb color) {
    for (std::size_t c = 0; c < 3; ++c) color_[c] = color[c];
  }
  std::unique_ptr<ColorSlab> slab(double, double) const override {
    return std::make_unique<Slab>(color_);
  }

 private:
  class Slab : public ColorSlab {
   public:
    explicit Slab(const FloatRgb& color) : color_(color) {}
    FloatRgb at(const Point&) const override { return color_; }

   private:
    FloatRgb color_;
  };
  FloatRgb color_{};
};

class BedField : public ColorField {
 public:
  explicit BedField(std::vector<PartField> parts) : parts_(std::move(parts)) {}
  std::unique_ptr<ColorSlab> slab(double low_mm, double high_mm) const override {
    return std::make_unique<Slab>(*this, low_mm, high_mm);
  }

 private:
  class Slab : public ColorSlab {
   public:
    Slab(const BedField& bed, double low_mm, double high_mm)
        : bed_(bed), low_mm_(low_mm), high_mm_(high_mm), slabs_(bed.parts_.size()) {}
    FloatRgb at(const Point& point) const override {
      std::size_t nearest = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < bed_.parts_.size(); ++i) {
        const Box& box = bed_.parts_[i].box;
        double away = 0;
        for (std::size_t axis = 0; axis < 2; ++axis) {
          away = std::max({away, box.min[axis] - point[axis], point[axis] - box.max[axis]});
        }
        if (away < least) {
          least = away;
          nearest = i;
        }
      }
      if (!slabs_[nearest]) slabs_[nearest] = bed_.parts_[nearest].field->slab(low_mm_, high_mm_);
      return slabs_[nearest]->at(point);
    }

   private:
    const BedField& bed_;
    double low_mm_;
    double high_mm_;
    mutable std::vector<std::unique_ptr<ColorSlab>> slabs_;
  };
  std::vector<PartField> parts_;
};

}  // namespace

std::shared_ptr<const ColorField> sample_field(const std::vector<Point>& samples,
                                               std::vector<Rgb> colors, int neighbors) {
  return std::make_shared<SampleField>(samples, std::move(colors), neighbors);
}

std::shared_ptr<const ColorField> plain_field(Rgb color) {
  return std::make_shared<PlainField>(color);
}

std::shared_ptr<const ColorField> bed_field(std::vector<PartField> parts) {
  if (parts.size() == 1) return parts.front().field;
  return std::make_shared<BedField>(std::move(parts));
}

}  // namespace binderjet
