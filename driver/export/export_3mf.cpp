// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/export/export_3mf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "driver/base/layer_blocks.h"
#include "driver/job/picture_rows.h"
#include "slicer/coupon/coupon_shapes.h"
#include "slicer/stack/png.h"
#include "slicer/stack/zip_writer.h"

namespace binderjet {
namespace {

constexpr const char* kXml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
constexpr const char* kModelPart = "3D/3dmodel.model";

constexpr const char* kContentTypes =
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n"
    " <Default Extension=\"rels\" "
    "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n"
    " <Default Extension=\"model\" "
    "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\n"
    " <Default Extension=\"png\" ContentType=\"image/png\"/>\n"
    "</Types>\n";

constexpr const char* kRelationships =
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n";

std::string relationship(const std::string& id, const std::string& target, const char* type) {
  return fmt::format(
      " <Relationship Id=\"{}\" Target=\"/{}\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/{}\"/>\n",
      id, target, type);
}

// One image3d of the model; what it is called is also the folder of its sheets.
struct Image {
  int id;
  const char* name;
};
constexpr Image kMask = {1, "mask"};
constexpr Image kColor = {3, "color"};
constexpr int kMaskFunction = 2;
constexpr int kColorFunction = 4;
constexpr int kVolume = 5;
constexpr int kBox = 6;
constexpr int kPart = 7;

std::string sheet(const Image& image, int index) {
  return fmt::format("3D/volumetric/{}/sheet{:06}.png", image.name, index);
}

std::string sheet_relationships(const MaskSource& job) {
  std::string text = std::string(kXml) + kRelationships;
  for (const Image& image : {kMask, kColor}) {
    if (image.id == kColor.id && !job.color) continue;
    for (int index = 0; index < job.size_px[2]; ++index) {
      text +=
          relationship(fmt::format("{}{}", image.name, index), sheet(image, index), "3dtexture");
    }
  }
  return text + "</Relationships>\n";
}

std::string image_text(const MaskSource& job, const Image& image, int function,
                       const char* scaling) {
  std::string text = fmt::format(
      "  <v:image3d id=\"{}\" name=\"{}\">\n"
      "   <v:imagestack rowcount=\"{}\" columncount=\"{}\" sheetcount=\"{}\">\n",
      image.id, image.name, job.size_px[1], job.size_px[0], job.size_px[2]);
  for (int index = 0; index < job.size_px[2]; ++index) {
    text += fmt::format("    <v:imagesheet path=\"/{}\"/>\n", sheet(image, index));
  }
  return text + fmt::format(
                    "   </v:imagestack>\n  </v:image3d>\n"
                    "  <v:functionfromimage3d id=\"{}\" image3did=\"{}\" filter=\"nearest\" "
                    "tilestyleu=\"clamp\" tilestylev=\"clamp\" tilestylew=\"clamp\"{}/>\n",
                    function, image.id, scaling);
}

// The box of the job, in millimeters from its corner: where the level set is looked at.
std::string box_text(const std::array<double, 3>& size_mm) {
  std::string text =
      fmt::format("  <object id=\"{}\" type=\"model\" name=\"box\">\n   <mesh>\n", kBox);
  text += "    <vertices>\n";
  Mesh box;
  add_box(box, {0, 0, 0}, size_mm);
  for (const Point& p : box.points) {
    text += fmt::format("     <vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", p[0], p[1], p[2]);
  }
  text += "    </vertices>\n    <triangles>\n";
  for (const Triangle& t : box.triangles) {
    text += fmt::format("     <triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", t[0], t[1], t[2]);
  }
  return text + "    </triangles>\n   </mesh>\n  </object>\n";
}

std::string model_text(const MaskSource& job) {
  std::array<double, 3> size_mm{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size_mm[axis] = job.size_px[axis] * job.pitch_mm[axis];
  }
  const std::string to_image = fmt::format("{:.17g} 0 0 0 {:.17g} 0 0 0 {:.17g} 0 0 0",
                                           1 / size_mm[0], 1 / size_mm[1], 1 / size_mm[2]);
  std::string text = fmt::format(
      "{}<model unit=\"millimeter\" xml:lang=\"en-US\" requiredextensions=\"v\"\n"
      " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"\n"
      " xmlns:v=\"http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01\">\n"
      " <metadata name=\"Application\">binderjet " BINDERJET_VERSION
      "</metadata>\n"
      " <resources>\n",
      kXml);
  text += image_text(job, kMask, kMaskFunction, " valueoffset=\"0.5\" valuescale=\"-1\"");
  std::string volume;
  if (job.color) {
    text += image_text(job, kColor, kColorFunction, "");
    text += fmt::format(
        "  <v:volumedata id=\"{}\">\n"
        "   <v:color functionid=\"{}\" channel=\"color\" transform=\"{}\"/>\n  </v:volumedata>\n",
        kVolume, kColorFunction, to_image);
    volume = fmt::format(" volumeid=\"{}\"", kVolume);
  }
  text += box_text(size_mm);
  text += fmt::format(
      "  <object id=\"{}\" type=\"model\" name=\"masks\">\n"
      "   <v:levelset functionid=\"{}\" channel=\"red\" meshid=\"{}\" meshbboxonly=\"true\" "
      "minfeaturesize=\"{}\" transform=\"{}\"{}/>\n  </object>\n </resources>\n",
      kPart, kMaskFunction, kBox, *std::min_element(job.pitch_mm.begin(), job.pitch_mm.end()),
      to_image, volume);
  return text + fmt::format(
                    " <build>\n  <item objectid=\"{}\" "
                    "transform=\"1 0 0 0 1 0 0 0 1 {} {} {}\"/>\n </build>\n</model>\n",
                    kPart, job.origin_mm[0], job.origin_mm[1], job.origin_mm[2]);
}

}  // namespace

GiveName export_3mf(const MaskSource& job, const std::string& path, const Work& work) {
  const auto [width, height, layers] = job.size_px;
  const std::array<double, 2> pitch_mm = {job.pitch_mm[0], job.pitch_mm[1]};
  const auto zip = std::make_shared<ZipWriter>(path);
  zip->add("[Content_Types].xml", std::string(kXml) + kContentTypes);
  zip->add("_rels/.rels", std::string(kXml) + kRelationships +
                              relationship("model", kModelPart, "3dmodel") + "</Relationships>\n");
  zip->add("3D/_rels/3dmodel.model.rels", sheet_relationships(job));
  zip->add(kModelPart, model_text(job));

  Stage stage(work, "writing masks", layers, "layers");
  encode_in_order(
      layers, stage,
      [&, w = width, h = height](int index) {
        return encode_png_mask(back_first(job.packed(index), h), w, h, pitch_mm);
      },
      [&](int index, const auto& png) { zip->add(sheet(kMask, index), png); });
  if (job.color) {
    Stage colors(work, "writing color", layers, "layers");
    encode_in_order(
        layers, colors,
        [&, w = width, h = height](int index) {
          return encode_png_rgb(back_first(job.color(index), h), w, h, pitch_mm);
        },
        [&](int index, const auto& png) { zip->add(sheet(kColor, index), png); });
  }
  zip->complete();
  return [zip] { zip->finish(); };
}

}  // namespace binderjet
