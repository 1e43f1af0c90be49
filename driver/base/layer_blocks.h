// SPDX-License-Identifier: GPL-3.0-or-later
// Work on all layers of a job, on all cores; each layer is an advance of the stage.
#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "slicer/base/work.h"
#include "slicer/layers/stream.h"

namespace binderjet {

// Runs each(index) for index in [0, count).
template <class Each>
void for_each_layer(int count, Stage& stage, Each each) {
  oneapi::tbb::parallel_for(0, count, [&](int index) {
    each(index);
    stage.advance();
  });
}

// Hands encode(index), a vector of bytes, to take(index, bytes) in the order of the layers. Memory
// is what one block encodes to.
template <class Encode, class Take>
void encode_in_order(int count, Stage& stage, Encode encode, Take take) {
  constexpr int kBlock = 4 * kBlockLayers;
  for (int first = 0; first < count; first += kBlock) {
    const int last = std::min(count, first + kBlock);
    std::vector<std::vector<std::byte>> block(static_cast<std::size_t>(last - first));
    oneapi::tbb::parallel_for(first, last, [&](int index) {
      block[static_cast<std::size_t>(index - first)] = encode(index);
      stage.advance();
    });
    for (int index = first; index < last; ++index) {
      take(index, block[static_cast<std::size_t>(index - first)]);
    }
  }
}

}  // namespace binderjet
