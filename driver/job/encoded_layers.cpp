// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/encoded_layers.h"

#include <algorithm>
#include <semaphore>
#include <utility>

#include "driver/job/job_masks.h"
#include "slicer/color/shell.h"
#include "slicer/color/skin.h"
#include "transport/job/job_file.h"

namespace binderjet {
namespace {

EncodedLayer encode(int layer, const MaskLayer& masks) {
  EncodedLayer out{encode_record(RecordKind::kMask, layer, pack(masks.mask)), masks.mask.count(), 0,
                   masks.changes};
  for (const RunLayer& slice : masks.target->slices) out.target_vx += slice.count();
  return out;
}

Pipeline<EncodedLayer> encoded(const Pipeline<MaskLayer>& masks) {
  return masks.then("encode", {}, [](int layer, const Window<MaskLayer>& window) {
    return encode(layer, window.middle());
  });
}

// Masks with the color bitmaps beside them.
Pipeline<EncodedLayer> colored(const Pipeline<MaskLayer>& masks, const JobHeader& header,
                               std::shared_ptr<const ColorField> field) {
  const auto shell =
      std::make_shared<const Shell>(header.grid, header.box, header.profile.color.depth_mm, field);
  // A bitmap and its compressed form are in memory for each layer being painted. On a large part
  // fewer are painted at once than there may be cores.
  constexpr std::int64_t kBitmapBytes = std::int64_t{64} << 20;
  const std::int64_t bytes = std::int64_t{6} * header.box.size_px[0] * header.box.size_px[1];
  const auto places = std::make_shared<std::counting_semaphore<>>(
      std::clamp<std::int64_t>(kBitmapBytes / bytes, 1, 64));
  return skin(masks, header.grid, header.box, std::move(field))
      .then("paint and encode", LayerReach::both_sides(shell->reach()),
            [shell, places](int layer, const Window<SkinLayer>& window) {
              EncodedLayer out = encode(layer, *window.middle().masks);
              places->acquire();
              const std::vector<std::byte> color =
                  encode_record(RecordKind::kColor, layer, shell->paint(layer, window));
              places->release();
              out.record.insert(out.record.end(), color.begin(), color.end());
              return out;
            });
}

}  // namespace

Pipeline<EncodedLayer> encoded_layers(const JobHeader& header, std::shared_ptr<const Mesh> mesh,
                                      std::shared_ptr<const ColorField> color, const Work& work) {
  const Pipeline<MaskLayer> masks = job_masks(header, std::move(mesh), work);
  return color ? colored(masks, header, std::move(color)) : encoded(masks);
}

}  // namespace binderjet
