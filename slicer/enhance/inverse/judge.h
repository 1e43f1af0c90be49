// SPDX-License-Identifier: GPL-3.0-or-later
// The exact model's word on a layer's new mask, against what the plain masks print.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/enhance/inverse/search/mask_search.h"
#include "slicer/enhance/inverse/search/search_model.h"

namespace binderjet {

// A voxel deeper than this may not be wrong where the plain print has it right; where no plain
// print of the layer is wrong as deep, than that, or kShallowMm. Depth is the distance to the
// target's surface in the slice; columns whose slices differ lie at a surface.
constexpr double kDeepMm = 0.125;
constexpr double kShallowMm = 0.1;

// Faults by layer, and what they weigh: their voxels, and more for each feature and each piece.
struct FoundFaults {
  std::vector<SearchFaults> faults;
  std::int64_t weight = 0;
};

// What is lost, fused (slicer/score/lost_and_fused.h), spurious
// (slicer/enhance/inverse/spurious.h) or loose in the middle layer, as all masks so far print.
FoundFaults find_broken(const LayerWindow& layers, const Grid& grid);
// Whether what has been found in the layer at `offset` still holds: prints are the same.
bool is_known(const LayerWindow& layers, int offset);
// The prints of a layer and so many on each side, from below; null beyond the job's ends.
std::vector<Shared<RunLayer>> prints_around(const LayerWindow& layers, int offset, int around);

class Judge {
 public:
  // Both must outlive this.
  Judge(const SearchModel& by, const LayerWindow& layers);

  // With `own` as the middle layer's mask: voxels that are too deep to be wrong ...
  FoundFaults too_deep(const RunLayer& own) const;
  // ... and besides what is lost, fused, spurious or loose, in the layers beside, too: what is lost
  // there may hang on the print here. Faults are where the middle layer's mask can mend them.
  FoundFaults broken(const RunLayer& own) const;
  // The same of the mask so far.
  FoundFaults broken() const;
  // The wrong voxels of all layers that it prints into.
  std::int64_t wrong_voxels(const RunLayer& own) const;
  // No layer that it prints into has more wrong voxels than with plain masks.
  bool no_worse_than_plain(const RunLayer& own) const;

  // `own`, with the pixels of the mask so far around what is too deep. Where that does not help,
  // the mask so far.
  RunLayer held(const RunLayer& own) const;

 private:
  struct Layer {
    RunLayer solid;  // columns that are target in all slices
    RunLayer any;    // and in any
    RunLayer plain;  // printed from plain masks
    double deep_mm;
  };
  FoundFaults with_faults_beside(const std::map<int, Shared<RunLayer>>& prints,
                                 const std::map<int, FoundFaults>& found, FoundFaults deep) const;

  const SearchModel& by_;
  const LayerWindow& layers_;
  std::map<int, Layer> printed_;  // by offset
};

}  // namespace binderjet
