// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/encoded_layers.h"

#include <algorithm>
#include <semaphore>
#include <utility>

#include "slicer/color/shell.h"
#include "slicer/color/skin.h"
#include "slicer/enhance/masks.h"
#include "transport/job_file.h"

namespace binderjet {
namespace {

EncodedLayer encode(int layer, const MaskLayer& masks) {
  EncodedLayer out{encode_record(RecordKind::kMask, layer, pack(masks.mask)), masks.mask.count(),
                   0};
  for (const RunLayer& slice : masks.target->slices) out.target_vx += slice.count();
  return out;
}

// Masks with the color bitmaps beside them.
std::unique_ptr<Stream<EncodedLayer>> colored_layers(const JobHeader& header,
                                                     std::shared_ptr<const Mesh> mesh,
                                                     std::shared_ptr<const ColorField> field,
                                                     LayerRange range) {
  const auto shell =
      std::make_shared<const Shell>(header.grid, header.box, header.profile.color.depth_mm, field);
  const LayerRange skins = grown(range, shell->reach(), header.layers());
  auto layers = skin(mask_stream(header, std::move(mesh), grown(skins, 1, header.layers())),
                     header.grid, header.box, skins, std::move(field));
  // A bitmap and its compressed form are in memory for each layer being painted. On a large part
  // fewer are painted at once than there may be cores.
  constexpr std::int64_t kBitmapBytes = std::int64_t{64} << 20;
  const std::int64_t bytes = std::int64_t{6} * header.box.size_px[0] * header.box.size_px[1];
  const auto places = std::make_shared<std::counting_semaphore<>>(
      std::clamp<std::int64_t>(kBitmapBytes / bytes, 1, 64));
  using Paint = Step<SkinLayer, EncodedLayer>;
  return std::make_unique<Paint>(
      std::move(layers), range, shell->reach(), header.layers(),
      [shell, places](int layer, Paint::Window window) {
        EncodedLayer out = encode(layer, *window[static_cast<std::size_t>(shell->reach())]->masks);
        places->acquire();
        const std::vector<std::byte> color =
            encode_record(RecordKind::kColor, layer, shell->paint(layer, window));
        places->release();
        out.record.insert(out.record.end(), color.begin(), color.end());
        return out;
      });
}

std::unique_ptr<Stream<EncodedLayer>> plain_layers(const JobHeader& header,
                                                   std::shared_ptr<const Mesh> mesh,
                                                   LayerRange range) {
  using Encode = Step<MaskLayer, EncodedLayer>;
  return std::make_unique<Encode>(
      mask_stream(header, std::move(mesh), range), range, 0, header.layers(),
      [](int layer, Encode::Window window) { return encode(layer, *window[0]); });
}

}  // namespace

std::unique_ptr<Stream<EncodedLayer>> encoded_layers(const JobHeader& header,
                                                     std::shared_ptr<const Mesh> mesh,
                                                     std::shared_ptr<const ColorField> color,
                                                     LayerRange layers) {
  return color ? colored_layers(header, std::move(mesh), std::move(color), layers)
               : plain_layers(header, std::move(mesh), layers);
}

}  // namespace binderjet
