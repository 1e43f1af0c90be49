// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/section_memo.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace binderjet {

Shared<RunLayer> SectionMemo::mask_of(const Shared<VoxelLayer>& target,
                                      const std::function<Shared<RunLayer>()>& search) {
  std::promise<Shared<RunLayer>> promise;
  {
    std::unique_lock lock(mutex_);
    const auto known = std::find_if(known_.begin(), known_.end(), [&](const Known& of) {
      return of.target->slices == target->slices;
    });
    if (known != known_.end()) {
      const std::shared_future<Shared<RunLayer>> mask = known->mask;
      lock.unlock();
      return mask.get();
    }
    known_.push_front({target, promise.get_future().share()});
    if (known_.size() > kMost) known_.pop_back();
  }
  try {
    Shared<RunLayer> mask = search();
    promise.set_value(mask);
    return mask;
  } catch (...) {
    promise.set_exception(std::current_exception());
    const std::lock_guard lock(mutex_);
    std::erase_if(known_, [&](const Known& of) { return of.target == target; });
    throw;
  }
}

}  // namespace binderjet
