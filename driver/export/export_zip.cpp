// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/export/export_zip.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "driver/base/json_text.h"
#include "driver/base/layer_blocks.h"
#include "driver/export/export_stack.h"
#include "slicer/stack/png.h"
#include "slicer/stack/zip_writer.h"

namespace binderjet {
namespace {

// White where the mask is 1, 24 bits a pixel, the back of the bed first.
std::vector<std::byte> white_on_black(const RunLayer& mask) {
  const std::size_t stride = 3 * static_cast<std::size_t>(mask.width());
  std::vector<std::byte> rgb(stride * static_cast<std::size_t>(mask.height()));
  for (int y = 0; y < mask.height(); ++y) {
    const auto row = rgb.end() - static_cast<std::ptrdiff_t>(stride) * (y + 1);
    const std::span<const int> runs = mask.row(y);
    for (std::size_t i = 0; i < runs.size(); i += 2) {
      std::fill(row + std::ptrdiff_t{3} * runs[i], row + std::ptrdiff_t{3} * runs[i + 1],
                std::byte{255});
    }
  }
  return rgb;
}

std::string uvtools_manifest(const StackInfo& frame) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Manifest>\n"
      "  <CreatedBy>binderjet " BINDERJET_VERSION
      "</CreatedBy>\n"
      "  <LayerHeight>{}</LayerHeight>\n"
      "  <ResolutionX>{}</ResolutionX>\n  <ResolutionY>{}</ResolutionY>\n"
      "  <DisplayWidth>{}</DisplayWidth>\n  <DisplayHeight>{}</DisplayHeight>\n"
      "  <MachineZ>{}</MachineZ>\n</Manifest>\n",
      frame.pitch_mm[2], frame.size[0], frame.size[1], frame.size[0] * frame.pitch_mm[0],
      frame.size[1] * frame.pitch_mm[1], frame.size[2] * frame.pitch_mm[2]);
}

std::string nanodlp_meta() {
  const nlohmann::ordered_json meta = {{"FormatVersion", 1},     {"Distro", "generic"},
                                       {"Program", "binderjet"}, {"Version", BINDERJET_VERSION},
                                       {"OS", "linux"},          {"Arch", "any"},
                                       {"Profile", false}};
  return to_json_text(meta, 1) + "\n";
}

}  // namespace

GiveName export_zip(const MaskSource& job, const std::string& path, bool full_bed,
                    const Work& work) {
  const StackInfo frame = mask_info(job, full_bed);
  const auto [width, height, layers] = frame.size;
  const auto zip = std::make_shared<ZipWriter>(path);
  zip->add("meta.json", nanodlp_meta());
  zip->add("manifest.uvtools", uvtools_manifest(frame));
  Stage stage(work, "writing pictures", layers, "layers");
  encode_in_order(
      layers, stage,
      [&, w = width, h = height](int index) {
        const RunLayer mask = unpack(mask_bits(job, frame, index), w, h);
        return encode_png_rgb(white_on_black(mask), w, h, {frame.pitch_mm[0], frame.pitch_mm[1]});
      },
      [&](int index, const auto& png) { zip->add(fmt::format("{}.png", index + 1), png); });
  zip->complete();
  return [zip] { zip->finish(); };
}

}  // namespace binderjet
