// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/inverse_layer.h"

#include "slicer/score/voxel_counts.h"

namespace binderjet {
namespace {

// The masks around the layer at `offset`, which need not be the middle one.
template <class MaskOf>
RunWindow gather(const LayerWindow& layers, int offset, const PrinterModel& model, MaskOf mask_of) {
  return RunWindow::around(model.window_reach(), [&](int from_there) -> const RunLayer* {
    const InverseLayer* layer = layers.at(offset + from_there);
    return layer == nullptr ? nullptr : mask_of(*layer, offset + from_there);
  });
}

template <class MaskOf>
RunLayer print(const LayerWindow& layers, int offset, const PrinterModel& model, MaskOf mask_of) {
  return model.print(gather(layers, offset, model, mask_of), layers.at(0)->number + offset);
}

}  // namespace

ModelOffsets offsets_of(const AssembledModel& form) {
  ModelOffsets offsets;
  for (const DoseTerm& term : form.terms) offsets.printed.insert(-term.layer);
  for (const int printed : offsets.printed) {
    for (const DoseTerm& term : form.terms) offsets.masks.insert(printed + term.layer);
  }
  return offsets;
}

RunWindow masks_around(const LayerWindow& layers, int offset, const PrinterModel& model) {
  return gather(layers, offset, model,
                [](const InverseLayer& layer, int) { return layer.mask.get(); });
}

RunLayer print_plain(const LayerWindow& layers, int offset, const PrinterModel& model) {
  return print(layers, offset, model,
               [](const InverseLayer& layer, int) { return layer.plain.get(); });
}

RunLayer print_with(const LayerWindow& layers, int offset, const PrinterModel& model,
                    const RunLayer& own) {
  return print(layers, offset, model, [&own](const InverseLayer& layer, int at) {
    return at == 0 ? &own : layer.mask.get();
  });
}

std::int64_t wrong_voxels(const InverseLayer& layer, const RunLayer& printed) {
  const VoxelCounts counts = count_voxels(*layer.target, printed);
  return counts.missing + counts.extra;
}

}  // namespace binderjet
