// SPDX-License-Identifier: GPL-3.0-or-later
// A stretch of layers with their prints, whose masks may be patched as long as that leaves less
// lost, fused, spurious and loose.
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

// The middle layer of a window of window_reach() on each side with its print ...
PrintedLayer with_print(const SearchModel& by, LayerWindow layers);
// ... and of three such layers the middle one with what of it is lost and fused.
PrintedLayer with_missing(const SearchModel& by, const Window<PrintedLayer>& three);

// Pixels of some layers that get others, counted from the stretch's first layer.
struct Patch {
  // From the plain mask alone, from its union with the mask so far, or from what both have; or from
  // the mask of the layer `copied`.
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
    std::int64_t weight = 0;
  };

  Stretch(const SearchModel& by, Layers layers, int job_layers);

  const Layers& layers() const { return layers_; }
  int count() const { return static_cast<int>(layers_.size()); }
  const Faults& faults() const { return faults_; }

  // The same without what lies outside these pixels or layers.
  Stretch cut(const Rect& pixels, LayerRange range);
  // Changes the layers if that leaves less wrong, and no layer prints worse than with plain masks,
  // or than it did when it was first looked at; says whether it did.
  bool take(const Patch& patch);

 private:
  const InverseLayer& layer(int k) const { return *layers_[static_cast<std::size_t>(k)]->layer; }
  const RunLayer& printed(int k) const { return *layers_[static_cast<std::size_t>(k)]->printed; }

  bool goes_on(const Region& region) const;
  Faults faults_of(const Layers& layers) const;
  RunLayer print(const Layers& layers, int k, Shared<RunLayer> InverseLayer::*mask) const;
  void look_at(Layers& layers, int k) const;
  std::int64_t most_wrong(int k);
  RunLayer filling(const Patch& patch, const InverseLayer& of) const;

  const SearchModel* by_;
  Layers layers_;
  Rect box_;    // in voxels; what is outside was cut off ...
  Rect whole_;  // ... from this
  bool open_below_;
  bool open_above_;
  std::map<int, std::int64_t> most_wrong_;  // by layer, as far as it was asked for
  Faults faults_;
};

}  // namespace binderjet
