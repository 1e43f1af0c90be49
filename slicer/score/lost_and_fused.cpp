// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/lost_and_fused.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

using rows::Row;
using Flips = std::vector<int>;

// One material, the target's or powder: where it is wanted and where the print has it. Rows and
// layers beyond the ends are powder.
class Material {
 public:
  Material(bool is_powder, int width) : is_powder_(is_powder), width_(width) {}

  // Row y of a layer as this material's; null is a layer of powder.
  Row row(const RunLayer* layer, int y, Flips& scratch) const {
    const Row solid = layer == nullptr ? Row() : layer->row(y);
    if (!is_powder_) return solid;
    rows::complement(solid, width_, scratch);
    return scratch;
  }
  // Where the material is wanted and the print does not have it; never beyond the layer.
  void missing(Row target, Row printed, Flips& out) const {
    if (is_powder_) std::swap(target, printed);
    rows::subtract(target, printed, out);
  }

 private:
  bool is_powder_;
  int width_;
};

// Takes from `open` (a row of each slice, from the end that lies next to the other layer) what
// that layer has in print, as far as the material goes on from slice to slice.
void wear_from_layer(const Material& material, const ComparedLayer* other, bool other_is_below,
                     const VoxelLayer& target, int y, std::vector<Flips>& open) {
  const RunLayer* nearest = nullptr;
  if (other != nullptr) {
    nearest = other_is_below ? &other->target->slices.back() : &other->target->slices.front();
  }
  Flips scratch_a;
  Flips scratch_b;
  Flips reached;
  rows::intersect(material.row(nearest, y, scratch_a),
                  material.row(other == nullptr ? nullptr : other->printed.get(), y, scratch_b),
                  reached);
  const std::size_t rz = target.slices.size();
  Flips next;
  for (std::size_t n = 0; n < rz && !reached.empty(); ++n) {
    const std::size_t s = other_is_below ? n : rz - 1 - n;
    rows::intersect(reached, material.row(&target.slices[s], y, scratch_a), next);
    reached.swap(next);
    rows::subtract(open[s], reached, next);
    open[s].swap(next);
  }
}

// The target's voxels of this material that the print lacks, without what a layer above or below
// still has.
std::vector<RunLayer> unprinted(const Material& material, const ComparedLayer* below,
                                const ComparedLayer& layer, const ComparedLayer* above) {
  const std::vector<RunLayer>& slices = layer.target->slices;
  std::vector<RunLayer> out(slices.size(), RunLayer(layer.printed->width()));
  std::vector<Flips> open(slices.size());
  for (int y = 0; y < layer.printed->height(); ++y) {
    bool any = false;
    for (std::size_t s = 0; s < slices.size(); ++s) {
      material.missing(slices[s].row(y), layer.printed->row(y), open[s]);
      any = any || !open[s].empty();
    }
    if (any) {
      wear_from_layer(material, below, true, *layer.target, y, open);
      wear_from_layer(material, above, false, *layer.target, y, open);
    }
    for (std::size_t s = 0; s < slices.size(); ++s) out[s].append_row(open[s]);
  }
  return out;
}

// Moves the ends of the runs of `open` inwards by `by`, but for those that end with the material.
void wear_along_row(Row open, Row material, int by, Flips& out) {
  out.clear();
  std::size_t run = 0;
  for (std::size_t i = 0; i < open.size(); i += 2) {
    while (material[run + 1] <= open[i]) run += 2;
    const int first = open[i] == material[run] ? open[i] : open[i] + by;
    const int last = open[i + 1] == material[run + 1] ? open[i + 1] : open[i + 1] - by;
    if (first < last) out.insert(out.end(), {first, last});
  }
}

// One step of wear along rows: what is printed or worn takes `by` voxels on each side.
RunLayer wear_along_rows(const Material& material, const RunLayer& slice, const RunLayer& open,
                         int by) {
  RunLayer out(open.width());
  out.reserve(open.height(), open.flip_count());
  Flips row;
  Flips scratch;
  for (int y = 0; y < open.height(); ++y) {
    row.clear();
    if (!open.row(y).empty()) {
      wear_along_row(open.row(y), material.row(&slice, y, scratch), by, row);
    }
    out.append_row(row);
  }
  return out;
}

// One step of wear across rows, from each row into those beside it.
RunLayer wear_across_rows(const Material& material, const RunLayer& slice, const RunLayer& open) {
  RunLayer out(open.width());
  out.reserve(open.height(), open.flip_count());
  Flips row;
  Flips worn;
  Flips left;
  Flips scratch;
  for (int y = 0; y < open.height(); ++y) {
    row.assign(open.row(y).begin(), open.row(y).end());
    for (int other = y - 1; other <= y + 1 && !row.empty(); other += 2) {
      rows::subtract(material.row(&slice, other, scratch), open.row(other), worn);
      rows::subtract(row, worn, left);
      row.swap(left);
    }
    out.append_row(row);
  }
  return out;
}

// What is neither printed nor worn.
std::vector<RunLayer> missing(const Material& material, const ComparedLayer* below,
                              const ComparedLayer& layer, const ComparedLayer* above,
                              const Grid& grid) {
  std::vector<RunLayer> open = unprinted(material, below, layer, above);
  // Whole voxels, spread evenly over the steps, so that a path may run aslant.
  const std::array<int, 2> reach{static_cast<int>(kWornMm / grid.voxel_mm(0)),
                                 static_cast<int>(kWornMm / grid.voxel_mm(1))};
  const int steps = std::max(reach[0], reach[1]);
  for (std::size_t s = 0; s < open.size(); ++s) {
    const RunLayer& slice = layer.target->slices[s];
    const auto takes = [&](int step, std::size_t axis) {
      return (step + 1) * reach[axis] / steps - step * reach[axis] / steps;
    };
    for (int step = 0; step < steps && !open[s].empty(); ++step) {
      open[s] = wear_along_rows(material, slice, open[s], takes(step, 0));
      if (takes(step, 1) > 0) open[s] = wear_across_rows(material, slice, open[s]);
    }
  }
  return open;
}

}  // namespace

LostAndFused find_lost_and_fused(const ComparedLayer* below, const ComparedLayer& layer,
                                 const ComparedLayer* above, const Grid& grid) {
  const int width = layer.printed->width();
  return {missing(Material(false, width), below, layer, above, grid),
          missing(Material(true, width), below, layer, above, grid)};
}

}  // namespace binderjet
