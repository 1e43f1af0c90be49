// SPDX-License-Identifier: GPL-3.0-or-later
// The masks of the sections that were searched last: parts with straight walls have hundreds of
// equal layers, and the search of one is the search of all. For models whose masks depend on the
// section alone.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <mutex>

#include "slicer/layers/run_layer.h"
#include "slicer/layers/window.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

class SectionMemo {
 public:
  // The mask of this section, from `search` if it is not known. Who asks while another thread
  // searches waits for that one. What `search` throws everybody gets who waits, and it is
  // forgotten.
  Shared<RunLayer> mask_of(const Shared<VoxelLayer>& target,
                           const std::function<Shared<RunLayer>()>& search);

 private:
  struct Known {
    Shared<VoxelLayer> target;
    std::shared_future<Shared<RunLayer>> mask;
  };
  // More than the layers that are worked on at once hardly help: equal ones lie beside each other.
  static constexpr std::size_t kMost = 8;

  std::mutex mutex_;
  std::deque<Known> known_;  // the newest first
};

}  // namespace binderjet
