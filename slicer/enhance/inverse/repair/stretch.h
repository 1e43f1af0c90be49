// SPDX-License-Identifier: GPL-3.0-or-later
// A run of layers with their prints. Patches of their masks are tried one by one, and a patch is
// kept only if it leaves less weight of faults (lost, fused, spurious, loose).
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/enhance/inverse/search/layer_search.h"
#include "slicer/enhance/rules/rect_cells.h"
#include "slicer/layers/regions.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/stream.h"
#include "slicer/score/faults.h"

namespace binderjet {

// A layer and what it comes to, under the nominal model.
struct PrintedLayer {
  Shared<InverseLayer> layer;
  Shared<RunLayer> printed;
  Shared<LostAndFused> missing;
};

// The middle layer of a window of window_reach() layers on each side, with its print.
PrintedLayer with_print(const SearchModel& by, LayerWindow layers);
// The middle one of three printed layers, with what of it is lost and fused.
PrintedLayer with_missing(const SearchModel& by, const Window<PrintedLayer>& three);

// Pixels of some layers that get others, counted from the stretch's first layer.
struct Patch {
  // plain: the plain mask. with_plain: the union of the plain mask and the mask so far.
  // common_with_plain: their intersection. copy: the mask of the layer `copied`.
  enum class Filling { plain, with_plain, common_with_plain, copy };

  LayerRange layers;
  Rect pixels;
  Filling filling = Filling::plain;
  int copied = 0;

  Patch moved(int by_layers) const {
    return {
        {layers.first + by_layers, layers.last + by_layers}, pixels, filling, copied + by_layers};
  }
};

class Stretch {
 public:
  using Layers = std::vector<Shared<PrintedLayer>>;
  struct Faults {
    std::vector<Fault> found;  // in voxels and slices from the stretch's first
    std::int64_t weight = 0;   // a fixed weight for each fault, plus its voxels
  };

  Stretch(const SearchModel& by, Layers layers, int job_layers);

  const Layers& layers() const { return layers_; }
  int count() const { return static_cast<int>(layers_.size()); }
  const Faults& faults() const { return faults_; }

  // The same without what lies outside these pixels or layers.
  Stretch cut(const Rect& pixels, LayerRange range);
  // Tries the patch. Keeps it, and returns true, if the faults weigh less afterwards and no layer
  // has more wrong voxels than the larger of: with its plain masks, and with its masks when it was
  // first asked about. Costs the prints of the patched layers and of window_reach() beside them.
  bool take(const Patch& patch);

 private:
  const InverseLayer& layer(int k) const { return *layers_[static_cast<std::size_t>(k)]->layer; }
  const RunLayer& printed(int k) const { return *layers_[static_cast<std::size_t>(k)]->printed; }

  bool goes_on(const Region& region) const;
  Faults faults_of(const Layers& layers) const;
  RunLayer print(const Layers& layers, int k, Shared<RunLayer> InverseLayer::*mask) const;
  void look_at(Layers& layers, int k) const;
  std::int64_t max_wrong(int k);
  RunLayer filling(const Patch& patch, const InverseLayer& of) const;

  const SearchModel* by_;
  Layers layers_;
  Rect box_;         // the part of the job's box that cut() has left, in voxels
  Rect whole_;       // the job's box, in voxels
  bool open_below_;  // the job goes on below the first of these layers
  bool open_above_;  // and above the last
  std::map<int, std::int64_t> max_wrong_;  // by layer, as far as it was asked for
  Faults faults_;
};

}  // namespace binderjet
