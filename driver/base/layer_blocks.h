// SPDX-License-Identifier: GPL-3.0-or-later
// Work on all layers of a job, on all cores, in blocks between which progress is told and Ctrl-C is
// heard.
#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "driver/base/console.h"
#include "slicer/layers/stream.h"

namespace binderjet {

constexpr int kWorkLayers = 4 * kBlockLayers;

// Runs work(index) for index in [0, count).
template <class Work>
void for_each_layer(int count, Progress& progress, Work work) {
  for (int first = 0; first < count; first += kWorkLayers) {
    const int last = std::min(count, first + kWorkLayers);
    oneapi::tbb::parallel_for(first, last, work);
    progress.advance(last);
  }
}

// Hands encode(index), a vector of bytes, to take(index, bytes) in the order of the layers. Memory
// is what one block encodes to.
template <class Encode, class Take>
void encode_in_order(int count, Progress& progress, Encode encode, Take take) {
  for (int first = 0; first < count; first += kWorkLayers) {
    const int last = std::min(count, first + kWorkLayers);
    std::vector<std::vector<std::byte>> block(static_cast<std::size_t>(last - first));
    oneapi::tbb::parallel_for(first, last, [&](int index) {
      block[static_cast<std::size_t>(index - first)] = encode(index);
    });
    for (int index = first; index < last; ++index) {
      take(index, block[static_cast<std::size_t>(index - first)]);
    }
    progress.advance(last);
  }
}

}  // namespace binderjet
