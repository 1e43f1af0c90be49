// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/thin_places.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "slicer/layers/rows.h"
#include "slicer/model/wear/morphology.h"

namespace binderjet {
namespace {

// How voxels become cells, and the balls in them.
struct Cells {
  Grid grid;        // its voxels are the cells
  int rows_vx = 1;  // rows of voxels in a cell
  Ellipsoid ball;   // smaller than the rule by half a cell on each side: from center to center
  Ellipsoid step;   // kSteps of them reach half the rule
  std::array<int, 3> pad{};  // cells on each side of the box: room for balls beyond it

  Cells(const Grid& voxels, double rule_mm)
      : grid{{voxels.voxel_mm(0), voxels.voxel_mm(1), voxels.pitch_mm[2]}, {1, 1, 1}},
        rows_vx(std::max(1, static_cast<int>(rule_mm / 10 / voxels.voxel_mm(1)))),
        ball(0, grid),
        step(0, grid) {
    grid.pitch_mm[1] *= rows_vx;
    const double cell_mm = *std::max_element(grid.pitch_mm.begin(), grid.pitch_mm.end());
    ball = Ellipsoid((rule_mm - cell_mm) / 2, grid);
    step = Ellipsoid(std::max(0.35 * rule_mm / 2, cell_mm), grid);
    for (std::size_t axis = 0; axis < 3; ++axis) pad[axis] = 2 * ball.reach()[axis] + 1;
  }
};
constexpr int kSteps = 3;  // small ones, for a step may leap over a gap as wide

// Any of the layer's voxels makes a cell solid; the pad around the box is powder.
RunLayer cells_of(const VoxelLayer& layer, const Cells& cells, Matter matter) {
  const RunLayer& lowest = layer.slices.front();
  const int width = lowest.width() + 2 * cells.pad[0];
  const int rows = (lowest.height() + cells.rows_vx - 1) / cells.rows_vx;
  RunLayer out(width);
  std::vector<int> row;
  std::vector<int> next;
  for (int y = -cells.pad[1]; y < rows + cells.pad[1]; ++y) {
    row.clear();
    for (const RunLayer& slice : layer.slices) {
      for (int dy = 0; dy < cells.rows_vx; ++dy) {
        rows::unite(row, slice.row(y * cells.rows_vx + dy), next);
        std::swap(row, next);
      }
    }
    if (matter == Matter::kPowder) out.flip(0);
    for (const int flip : row) out.flip(flip + cells.pad[0]);
    if (matter == Matter::kPowder) out.flip(width);
    out.end_row();
  }
  return out;
}

// The layers of a box as cells, after and before as many layers of powder as the pad says.
class CellStream : public Stream<RunLayer> {
 public:
  CellStream(std::unique_ptr<Stream<VoxelLayer>> target, Cells cells, Matter matter)
      : target_(std::move(target)), cells_(std::move(cells)), matter_(matter) {
    const LayerRange all = target_->rest();
    rest_ = {0, all.size() + 2 * cells_.pad[2]};
    below_ = cells_.pad[2];
  }
  LayerRange rest() const override { return rest_; }
  std::vector<Shared<RunLayer>> next(int count) override {
    std::vector<Shared<RunLayer>> out;
    if (waiting_.empty()) take();  // its size is that of the powder below
    for (; count > 0 && rest_.size() > 0; --count, ++rest_.first) {
      if (below_ > 0) {
        --below_;
        out.push_back(bare_);
        continue;
      }
      if (waiting_.empty() && target_->rest().size() > 0) take();
      out.push_back(waiting_.empty() ? bare_ : waiting_.front());
      if (!waiting_.empty()) waiting_.erase(waiting_.begin());
    }
    return out;
  }

 private:
  void take() {
    for (const Shared<VoxelLayer>& layer : target_->next(1)) {
      waiting_.push_back(std::make_shared<const RunLayer>(cells_of(*layer, cells_, matter_)));
      if (bare_ != nullptr) continue;
      const VoxelLayer powder{
          {RunLayer::powder(layer->slices.front().width(), layer->slices.front().height())}};
      bare_ = std::make_shared<const RunLayer>(cells_of(powder, cells_, matter_));
    }
  }

  std::unique_ptr<Stream<VoxelLayer>> target_;
  Cells cells_;
  Matter matter_;
  LayerRange rest_;
  int below_ = 0;                          // layers of powder that are still to come
  std::vector<Shared<RunLayer>> waiting_;  // at most one
  Shared<RunLayer> bare_;
};

// A layer of what is looked at, and what of it is thick as far as the steps so far know.
struct Sounded {
  Shared<RunLayer> all;
  RunLayer thick;
};

RunWindow thick_around(const Window<Sounded>& window) {
  return runs_around(window, window.reach().above, [](const Sounded& one) { return &one.thick; });
}

// The diameter of the largest ball around the middle of a run [first, last) of row y that keeps
// within what is looked at; no more than the rule is looked for.
double width_around(const RunWindow& all, int first, int last, int y, const Cells& cells,
                    double rule_mm) {
  const auto& [dx_mm, dy_mm, dz_mm] = cells.grid.pitch_mm;
  const double x = (first + last) / 2.0;
  double square = rule_mm * rule_mm / 4;
  const auto gap = [](int cells_away, double mm) {
    return cells_away == 0 ? 0 : (std::abs(cells_away) - 0.5) * mm;
  };
  const auto [_, rows, layers] = cells.ball.reach();
  for (int dz = -layers; dz <= layers; ++dz) {
    const double z2 = gap(dz, dz_mm) * gap(dz, dz_mm);
    for (int dy = -rows; dy <= rows; ++dy) {
      const double away2 = z2 + gap(dy, dy_mm) * gap(dy, dy_mm);
      if (away2 >= square) continue;
      const RunLayer* layer = all.at(dz);
      const rows::Row row = layer == nullptr ? rows::Row{} : layer->row(y + dy);
      const auto next = std::upper_bound(row.begin(), row.end(), x);
      double along_mm = 0;  // to the nearest end of the run that x is in
      if ((next - row.begin()) % 2 == 1) along_mm = std::min(*next - x, x - *(next - 1)) * dx_mm;
      square = std::min(square, away2 + along_mm * along_mm);
    }
  }
  return 2 * std::sqrt(square);
}

// What is thin in a layer, and the width around the middle of each of its runs.
struct ThinLayer {
  RunLayer thin;
  std::vector<double> width_mm;
};

ThinLayer thin_of(const Window<Sounded>& window, const Cells& cells, double rule_mm) {
  const RunWindow all =
      runs_around(window, window.reach().above, [](const Sounded& one) { return one.all.get(); });
  ThinLayer out{RunLayer(all.middle().width()), {}};
  std::vector<int> row;
  for (int y = 0; y < all.middle().height(); ++y) {
    rows::subtract(all.middle().row(y), window.middle().thick.row(y), row);
    out.thin.append_row(row);
    for (std::size_t i = 0; i < row.size(); i += 2) {
      out.width_mm.push_back(width_around(all, row[i], row[i + 1], y, cells, rule_mm));
    }
  }
  return out;
}

Pipeline<ThinLayer> thin_layers(const Pipeline<RunLayer>& all, const Cells& cells, double rule_mm) {
  const LayerReach reach = LayerReach::both_sides(cells.ball.reach()[2]);
  const LayerReach step_reach = LayerReach::both_sides(cells.step.reach()[2]);
  auto sounded =
      all.then("where balls fit", reach,
               [cells](int, const Window<RunLayer>& window) {
                 const RunWindow around = runs_around(window, window.reach().above,
                                                      [](const RunLayer& one) { return &one; });
                 return Sounded{window.shared(0), eroded(around, cells.ball, Beyond::kPowder)};
               })
          .then("what they fill", reach, [cells](int, const Window<Sounded>& window) {
            const Shared<RunLayer>& here = window.middle().all;
            return Sounded{here, dilated_within(thick_around(window), cells.ball, *here)};
          });
  for (int i = 0; i < kSteps; ++i) {
    sounded = sounded.then("what is near", step_reach, [cells](int, const Window<Sounded>& window) {
      const Shared<RunLayer>& here = window.middle().all;
      return Sounded{here, dilated_within(thick_around(window), cells.step, *here)};
    });
  }
  return sounded.then("thin", reach, [cells, rule_mm](int, const Window<Sounded>& window) {
    return thin_of(window, cells, rule_mm);
  });
}

// From cells of the padded layers to voxels and slices of the job.
ThinPlace in_job(Region region, const Cells& cells, const Grid& grid) {
  const double width_mm = region.widest;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int voxels = axis == 1 ? cells.rows_vx : axis == 2 ? grid.detail_vx[2] : 1;
    region.low[axis] = (region.low[axis] - cells.pad[axis]) * voxels;
    region.high[axis] = (region.high[axis] - cells.pad[axis]) * voxels;
  }
  region.voxels *= cells.rows_vx * grid.detail_vx[2];
  return {region, width_mm};
}

}  // namespace

double least_rule_mm(const Grid& grid) {
  return 3 * std::max({grid.voxel_mm(0), grid.voxel_mm(1), grid.pitch_mm[2]});
}

void find_thin_places(const Pipeline<VoxelLayer>& target, const Grid& grid, double rule_mm,
                      Matter matter, const Work& work,
                      const std::function<void(const ThinPlace&)>& found) {
  assert(rule_mm >= least_rule_mm(grid));
  const Cells cells(grid, rule_mm);
  auto all = std::make_unique<CellStream>(target.all_layers(), cells, matter);
  const LayerRange padded = all->rest();
  const auto layers = thin_layers({"cells", padded, std::move(all)}, cells, rule_mm).all_layers();
  RegionFinder regions;
  const auto tell = [&](const std::vector<Region>& ended) {
    for (const Region& region : ended) found(in_job(region, cells, grid));
  };
  Stage stage(work, "measuring thin places", padded.size(), "layers");
  while (layers->rest().size() > 0) {
    for (const Shared<ThinLayer>& layer : layers->next(kBlockLayers)) {
      tell(regions.add(layer->thin, nullptr, layer->width_mm));
    }
    stage.reach(layers->rest().first);
  }
  tell(regions.finish());
}

}  // namespace binderjet
