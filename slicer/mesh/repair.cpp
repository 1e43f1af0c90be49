// SPDX-License-Identifier: GPL-3.0-or-later
// Repairs in the order of how little they change; each has to leave less boundary than it found.
#include "slicer/mesh/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

#include "slicer/base/counted.h"
#include "slicer/base/error.h"
#include "slicer/mesh/boundary.h"
#include "slicer/mesh/crossings.h"
#include "slicer/mesh/holes.h"
#include "slicer/mesh/shells.h"
#include "slicer/mesh/wall.h"
#include "slicer/mesh/weld.h"

namespace binderjet {
namespace {

// A lid may be this much of the surface as it came. An open bowl's lid is half of it and more.
constexpr double kMaxInvented = 0.5;
// Below this share of the box a volume is rounding.
constexpr double kMinVolume = 1e-9;
// Up to this many triangles the surface is asked whether it goes through itself, which only earns
// a remark; the answer takes 0.1 s there, and grows.
constexpr std::size_t kSmall = 20'000;

double diagonal(const Mesh& mesh) {
  const Box box = bounding_box(mesh);
  return std::hypot(box.size(0), box.size(1), box.size(2));
}

std::int64_t drop_repeated_corners(Mesh& mesh) {
  return static_cast<std::int64_t>(std::erase_if(mesh.triangles, [](const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  }));
}

// Of the faces with the same three points: `cancel` keeps as many as are left when opposite ones
// cancel, at most one; else one stays in any case, the first.
std::int64_t drop_duplicates(Mesh& mesh, bool cancel) {
  struct Key {
    Triangle corners;  // sorted
    int face;
  };
  std::vector<Key> keys;
  keys.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle corners = mesh.triangles[i];
    std::sort(corners.begin(), corners.end());
    keys.push_back({corners, static_cast<int>(i)});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::pair(a.corners, a.face) < std::pair(b.corners, b.face);
  });
  const auto is_even = [&](const Key& key) {
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(key.face)];
    return (t[0] < t[1]) ^ (t[1] < t[2]) ^ (t[2] < t[0]);
  };
  std::vector<bool> goes(mesh.triangles.size(), false);
  for (auto key = keys.begin(); key != keys.end();) {
    const auto end =
        std::find_if(key, keys.end(), [&](const Key& k) { return k.corners != key->corners; });
    if (end - key > 1) {
      const auto even = std::count_if(key, end, is_even);
      const auto odd = (end - key) - even;
      bool keeps = !cancel || even != odd;
      for (auto k = key; k != end; ++k) {
        const bool wanted = !cancel || is_even(*k) == (even > odd);
        goes[static_cast<std::size_t>(k->face)] = !(keeps && wanted);
        if (wanted) keeps = false;
      }
    }
    key = end;
  }
  std::size_t face = 0;
  return static_cast<std::int64_t>(
      std::erase_if(mesh.triangles, [&](const Triangle&) { return goes[face++]; }));
}

// Merges points of the boundary that lie within `distance` of each other into the first of them.
std::int64_t merge_near_points(Mesh& mesh, double distance) {
  std::vector<int> open;
  for (const DirectedEdge& edge : boundary_edges(mesh))
    open.insert(open.end(), edge.begin(), edge.end());
  std::sort(open.begin(), open.end());
  open.erase(std::unique(open.begin(), open.end()), open.end());

  using Cell = std::array<std::int64_t, 3>;
  const auto at = [&](int index) -> const Point& {
    return mesh.points[static_cast<std::size_t>(index)];
  };
  std::map<Cell, std::vector<int>> grid;
  std::map<int, int> target;
  const Point origin = bounding_box(mesh).min;
  for (const int index : open) {
    Cell cell{};
    for (std::size_t i = 0; i < 3; ++i) {
      cell[i] = static_cast<std::int64_t>(std::floor((at(index)[i] - origin[i]) / distance));
    }
    int nearest = -1;
    double least = distance;
    for (int n = 0; n < 27; ++n) {
      const auto found =
          grid.find({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1});
      if (found == grid.end()) continue;
      for (const int other : found->second) {
        const double gap = std::hypot(at(index)[0] - at(other)[0], at(index)[1] - at(other)[1],
                                      at(index)[2] - at(other)[2]);
        if (gap <= least) {
          least = gap;
          nearest = other;
        }
      }
    }
    if (nearest >= 0) {
      target[index] = nearest;
    } else {
      grid[cell].push_back(index);
    }
  }
  if (target.empty()) return 0;
  for (Triangle& triangle : mesh.triangles) {
    for (int& corner : triangle) {
      const auto moved = target.find(corner);
      if (moved != target.end()) corner = moved->second;
    }
  }
  drop_repeated_corners(mesh);
  return static_cast<std::int64_t>(target.size());
}

class Repairer {
 public:
  Repairer(Mesh& mesh, const std::string& where, double wall, const Work& work)
      : mesh_(mesh), where_(where), wall_(wall), work_(work) {}

  Repair repair() {
    note(drop_repeated_corners(mesh_), "dropped", "degenerate face", "degenerate faces");
    if (mesh_.triangles.empty()) refuse("has no face with an area; export the model again");
    EdgeCounts edges = count_edges(mesh_);
    if (edges.open > 0) {
      close();
      edges = count_edges(mesh_);
    } else if (edges.crowded > 0) {
      // Only a repeated face can be dropped from a closed surface, and only if it stays closed.
      note(drop_if_closed(), "dropped", "duplicate face", "duplicate faces");
      edges = count_edges(mesh_);
    }
    work_.check();
    turn_outward();
    work_.check();
    remark(edges);
    return std::move(result_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(ErrorKind::kBadInput, where_, what);
  }

  void note(std::int64_t count, const std::string& verb, const std::string& one,
            const std::string& many) {
    if (count > 0) result_.notes.push_back(verb + " " + counted(count, one, many));
  }

  // Keeps what `change` does to the mesh only if less boundary is left; returns its count.
  template <typename Change>
  std::int64_t attempt(const Change& change) {
    work_.check();
    if (open_ == 0) return 0;
    Mesh changed = mesh_;
    const std::int64_t count = change(changed);
    if (count == 0) return 0;
    const std::size_t open = boundary_edges(changed).size();
    if (open >= open_) return 0;
    open_ = open;
    mesh_ = std::move(changed);
    return count;
  }

  void close() {
    // Files other than STL may repeat their points, which is no fault of the surface.
    note(weld_points(mesh_), "merged", "duplicate point", "duplicate points");
    note(drop_repeated_corners(mesh_), "dropped", "degenerate face", "degenerate faces");
    open_ = boundary_edges(mesh_).size();
    area_ = surface_area(mesh_);
    if (!(area_ > 0)) refuse("has no face with an area; export the model again");
    orient_and_drop();
    // Cracks: first what is certainly rounding, then up to 0.02 mm on a part as large as the bed.
    for (const double share : {1e-6, 1e-5, 1e-4}) {
      const double distance = share * diagonal(mesh_);
      note(attempt([&](Mesh& m) { return merge_near_points(m, distance); }), "merged",
           "nearly equal point", "nearly equal points");
      orient_and_drop();
    }
    if (open_ > 0) fill();
    note(turn_shells_outward(mesh_), "turned", "piece inside in -> out", "pieces inside in -> out");
  }

  void orient_and_drop() {
    std::int64_t turned = 0;
    std::int64_t dropped = attempt([](Mesh& m) { return drop_duplicates(m, true); });
    turned += attempt([](Mesh& m) { return orient_triangles(m); });
    // Duplicates hide from orientation, which asks for edges of two faces.
    const auto both = [&](bool cancel) {
      std::int64_t turned_now = 0;
      const std::int64_t dropped_now = attempt([&](Mesh& m) {
        const std::int64_t count = drop_duplicates(m, cancel);
        turned_now = orient_triangles(m);
        return count;
      });
      dropped += dropped_now;
      if (dropped_now > 0) turned += turned_now;
    };
    both(true);
    both(false);
    note(dropped, "dropped", "duplicate face", "duplicate faces");
    note(turned, "turned", "face against its neighbors", "faces against their neighbors");
  }

  void fill() {
    work_.check();
    Mesh filled = mesh_;
    const ClosedHoles lids = close_holes(filled);
    if (lids.area > kMaxInvented * area_) {
      if (!(wall_ > 0)) {
        refuse(fmt::format(
            "is no closed surface: {} of its edges are open, and closing them would invent {:.0f} "
            "% "
            "of the surface it has; close the model in a mesh editor, or give it a wall (--wall)",
            open_, 100 * lids.area / area_));
      }
      add_wall(mesh_, wall_);
      result_.notes.push_back("gave the open surface a wall");
      return;
    }
    mesh_ = std::move(filled);
    result_.notes.push_back(
        fmt::format("closed {} ({}, {:.2g} % of the surface)", counted(lids.holes, "hole", "holes"),
                    counted(lids.edges, "edge", "edges"), 100 * lids.area / area_));
    // A lid that lies on a stray face cancels it.
    note(drop_if_closed(), "dropped", "stray face", "stray faces");
  }

  std::int64_t drop_if_closed() {
    Mesh changed = mesh_;
    const std::int64_t count = drop_duplicates(changed, true);
    if (count == 0 || changed.triangles.empty() || !is_closed(changed)) return 0;
    mesh_ = std::move(changed);
    return count;
  }

  void turn_outward() {
    const Box box = bounding_box(mesh_);
    const double whole = box.size(0) * box.size(1) * box.size(2);
    const double volume = signed_volume(mesh_);
    if (std::abs(volume) <= kMinVolume * whole && !has_volume(whole)) {
      refuse(
          fmt::format("encloses no volume ({}); give the model a thickness",
                      counted(static_cast<std::int64_t>(mesh_.triangles.size()), "face", "faces")));
    }
    if (volume < 0) {
      for (Triangle& t : mesh_.triangles) std::swap(t[1], t[2]);
      result_.notes.push_back("turned the part inside in -> out");
    }
  }

  // Whether any piece has a volume of its own: those of two may cancel.
  bool has_volume(double whole) const {
    const Shells shells = shells_by_points(mesh_);
    if (shells.count < 2) return false;
    const std::vector<double> volumes = volumes_of(mesh_, shells);
    return std::any_of(volumes.begin(), volumes.end(),
                       [&](double v) { return std::abs(v) > kMinVolume * whole; });
  }

  // A cavity hangs together by itself, but it is no piece: all that is within it is outside.
  int count_pieces() const {
    const Shells shells = shells_by_points(mesh_);
    if (shells.count < 2) return shells.count;
    const auto is_inward = [](double volume) { return volume < 0; };
    std::vector<double> volumes = volumes_of(mesh_, shells);
    if (std::any_of(volumes.begin(), volumes.end(), is_inward)) {
      Mesh outward = mesh_;  // a piece inside out is one all the same
      turn_shells_outward(outward);
      volumes = volumes_of(outward, shells);
    }
    return shells.count -
           static_cast<int>(std::count_if(volumes.begin(), volumes.end(), is_inward));
  }

  // The signed volume of each shell.
  static std::vector<double> volumes_of(const Mesh& mesh, const Shells& shells) {
    std::vector<double> volumes(static_cast<std::size_t>(shells.count), 0.0);
    Mesh one;
    one.points = mesh.points;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      one.triangles = {mesh.triangles[t]};
      volumes[static_cast<std::size_t>(shells.of_triangle[t])] += signed_volume(one);
    }
    return volumes;
  }

  void remark(const EdgeCounts& edges) {
    if (edges.crowded > 0) {
      result_.remarks.push_back(counted(edges.crowded, "edge", "edges") +
                                " of more than two faces, left as they are");
    }
    if (mesh_.triangles.size() <= kSmall) {
      const std::int64_t crossings = count_crossings(mesh_);
      if (crossings > 0) {
        result_.remarks.push_back("goes through itself at " +
                                  counted(crossings, "pair of faces", "pairs of faces") +
                                  "; all that the surface winds around is solid");
      }
    }
    const int pieces = count_pieces();
    if (pieces > 1) {
      result_.remarks.push_back(fmt::format("has {} pieces that do not touch", pieces));
    }
    std::int64_t flat = 0;
    for (const Triangle& t : mesh_.triangles) flat += triangle_area(mesh_, t) > 0 ? 0 : 1;
    if (flat > 0) {
      result_.remarks.push_back("kept " + counted(flat, "face", "faces") +
                                " without area, which change nothing");
    }
  }

  Mesh& mesh_;
  const std::string& where_;
  double wall_;
  Work work_;
  Repair result_;
  std::size_t open_ = 0;
  double area_ = 0;
};

}  // namespace

Repair repair_mesh(Mesh& mesh, const std::string& where, double wall, const Work& work) {
  return Repairer(mesh, where, wall, work).repair();
}

}  // namespace binderjet
