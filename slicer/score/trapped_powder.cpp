// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/trapped_powder.h"

#include <algorithm>

namespace binderjet {
namespace {

RunLayer powder_of(const RunLayer& printed) {
  RunLayer powder(printed.width());
  powder.reserve(printed.height(),
                 printed.flip_count() + 2 * static_cast<std::size_t>(printed.height()));
  for (int y = 0; y < printed.height(); ++y) {
    powder.flip(0);
    for (const int flip : printed.row(y)) powder.flip(flip);
    powder.flip(printed.width());
    powder.end_row();
  }
  return powder;
}

// The outermost voxels of a layer, where the box ends and the bed's powder begins.
RunLayer frame(int width, int height) {
  RunLayer marks(width);
  for (int y = 0; y < height; ++y) {
    marks.flip(0);
    if (y > 0 && y + 1 < height && width > 2) {
      marks.flip(1);
      marks.flip(width - 1);
    }
    marks.flip(width);
    marks.end_row();
  }
  return marks;
}

}  // namespace

std::vector<Region> TrappedPowder::add(const RunLayer& printed) {
  const RunLayer powder = powder_of(printed);
  const RunLayer marks = first_ ? powder : frame(printed.width(), printed.height());
  first_ = false;
  std::vector<Region> ended = powder_.add(powder, &marks);
  std::erase_if(ended, [](const Region& region) { return region.touches; });
  return ended;
}

}  // namespace binderjet
