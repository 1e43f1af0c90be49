// SPDX-License-Identifier: GPL-3.0-or-later
// export --3mf against the rules of the 3MF Volumetric Extension 0.8 and of the core's package.
#include <Model/COM/NMR_DLLInterfaces.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "slicer/stack/slice_stack.h"
#include "slicer/stack/zip_writer.h"
#include "tests/support/archive.h"
#include "tests/support/decoded_png.h"
#include "tests/support/models.h"
#include "tests/support/program.h"
#include "tests/support/random.h"
#include "tests/support/xml.h"

namespace binderjet {
namespace {

using testing::AnyOf;
using testing::ElementsAre;
using testing::IsSupersetOf;
using testing::StartsWith;

constexpr const char* kVolumetric = "http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01";
constexpr const char* kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
constexpr const char* kPackage = "http://schemas.openxmlformats.org/package/2006/";
constexpr const char* kTypes = "http://schemas.microsoft.com/3dmanufacturing/2013/01/";

using Matrix = std::array<double, 12>;  // rows; the last is the translation

Matrix matrix(const std::string& text) {
  Matrix m{};
  std::istringstream in(text);
  for (double& value : m) in >> value;
  EXPECT_TRUE(in) << text;
  return m;
}

std::array<double, 3> times(const std::array<double, 3>& p, const Matrix& m) {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = p[0] * m[i] + p[1] * m[3 + i] + p[2] * m[6 + i] + m[9 + i];
  }
  return out;
}

// The file as the specification has it read, from nothing but the file.
class Volume {
 public:
  explicit Volume(const Archive& archive)
      : archive_(archive), xml_(archive.at("3D/3dmodel.model").bytes) {
    for (const XmlElement& resource : xml_.root().child("resources").children()) {
      const int id = resource.number("id");
      EXPECT_GT(id, 0);
      EXPECT_TRUE(resources_.emplace(id, resource).second) << "two resources are " << id;
    }
    item_ = xml_.root().child("build").child("item");
    levelset_ = resource(item_.number("objectid")).child("levelset");
  }

  XmlElement root() const { return xml_.root(); }
  XmlElement item() const { return item_; }
  XmlElement levelset() const { return levelset_; }
  const std::map<int, XmlElement>& resources() const { return resources_; }
  XmlElement resource(int id) const {
    EXPECT_TRUE(resources_.contains(id)) << "nothing is " << id;
    return resources_.at(id);
  }
  XmlElement stack(const XmlElement& image) const { return image.child("imagestack"); }
  std::string sheet(const XmlElement& image, int index) const {
    return stack(image).children("imagesheet")[static_cast<std::size_t>(index)]["path"].substr(1);
  }

  // What `image` shows at a place of the bed, sampled "nearest" through `transform`: the samples of
  // one pixel, 0 to 255. A picture's first row is v = 1.
  std::vector<int> sample(const XmlElement& function, const std::string& transform,
                          std::array<double, 3> bed_mm) {
    const XmlElement image = resource(function.number("image3did"));
    const Matrix place = matrix(item_["transform"]);
    for (std::size_t i = 0; i < 3; ++i) bed_mm[i] -= place[9 + i];
    const auto [u, v, w] = times(bed_mm, matrix(transform));
    const XmlElement pixels = stack(image);
    const int columns = pixels.number("columncount");
    const int rows = pixels.number("rowcount");
    const auto index = [](double at, int count) {
      return std::clamp(static_cast<int>(std::floor(at * count)), 0, count - 1);
    };
    const int row = rows - 1 - index(v, rows);
    const int column = index(u, columns);
    const png::Decoded& png = decoded(sheet(image, index(w, pixels.number("sheetcount"))));
    const std::size_t stride = png.bits.size() / static_cast<std::size_t>(png.height);
    const auto* bits = png.bits.data() + stride * static_cast<std::size_t>(row);
    if (png.bit_depth == 1) {
      const bool set =
          (bits[column / 8] & static_cast<std::byte>(0x80 >> (column % 8))) != std::byte{0};
      return {set ? 255 : 0};
    }
    std::vector<int> samples;
    for (int c = 0; c < 3; ++c) samples.push_back(std::to_integer<int>(bits[3 * column + c]));
    return samples;
  }

  // The level set at a place of the bed; negative is inside.
  double level(const std::array<double, 3>& bed_mm) {
    const XmlElement function = resource(levelset_.number("functionid"));
    const double value = sample(function, levelset_["transform"], bed_mm)[0] / 255.0;
    return value * std::stod(function["valuescale"]) + std::stod(function["valueoffset"]);
  }

 private:
  const png::Decoded& decoded(const std::string& part) {
    const auto [place, added] = decoded_.try_emplace(part);
    if (added) place->second = png::decode(archive_.at(part).data());
    return place->second;
  }

  const Archive& archive_;
  Xml xml_;
  std::map<int, XmlElement> resources_;
  XmlElement item_{nullptr};
  XmlElement levelset_{nullptr};
  std::map<std::string, png::Decoded> decoded_;
};

class Export3mf : public testing::Test {
 protected:
  Export3mf() {
    // Red in front, blue at the back.
    const Mesh ball = models::golf_ball(3, 4);
    std::ofstream file(here_ / "ball.obj");
    for (const Point& p : ball.points) {
      file << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << (p[1] < 0 ? " 1 0 0\n" : " 0 0 1\n");
    }
    for (const Triangle& t : ball.triangles) {
      file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    }
    file.close();
    run({"slice", here_ / "ball.obj", "-p", "z450", "--at", "20,30", "--layers", "5:", "-o",
         here_ / "a.bjob"});
    run({"export", here_ / "a.bjob", "--3mf", here_ / "a.3mf"});
  }
  void run(std::vector<std::string> words) const {
    words.emplace_back("-q");
    const Ran ran = here_.run(words);
    ASSERT_EQ(ran.status, 0) << ran.err;
  }
  Archive archive() const { return Archive(here_ / "a.3mf"); }

  Workplace here_;
};

TEST_F(Export3mf, IsAPackageByTheRules) {
  const Archive package = archive();
  const Xml types(package.entries.front().bytes);
  EXPECT_EQ(package.entries.front().name, "[Content_Types].xml");
  EXPECT_EQ(types.root().space(), std::string(kPackage) + "content-types");
  std::map<std::string, std::string> type_of;
  for (const XmlElement& type : types.root().children("Default")) {
    type_of[type["Extension"]] = type["ContentType"];
  }
  EXPECT_EQ(type_of["model"], "application/vnd.ms-package.3dmanufacturing-3dmodel+xml");
  EXPECT_EQ(type_of["rels"], "application/vnd.openxmlformats-package.relationships+xml");
  EXPECT_EQ(type_of["png"], "image/png");

  std::set<std::string> parts;
  const std::regex legal("[A-Za-z0-9_/]*[A-Za-z0-9_]?\\.[a-z]+");
  for (const ArchiveEntry& entry : package.entries) {
    EXPECT_TRUE(parts.insert(entry.name).second) << "twice: " << entry.name;
    EXPECT_TRUE(entry.stored) << entry.name;
    if (entry.name == "[Content_Types].xml") continue;
    EXPECT_TRUE(type_of.contains(entry.name.substr(entry.name.rfind('.') + 1))) << entry.name;
    if (!entry.name.ends_with(".rels")) {
      EXPECT_TRUE(std::regex_match(entry.name, legal)) << entry.name;
    }
  }

  // Every part is reached over relationships, and every relationship leads to a part.
  std::set<std::string> reached = {"[Content_Types].xml", "_rels/.rels",
                                   "3D/_rels/3dmodel.model.rels"};
  const auto follow = [&](const std::string& rels, const std::string& type) {
    std::set<std::string> ids;
    const Xml relations(package.at(rels).bytes);
    for (const XmlElement& relation : relations.root().children()) {
      EXPECT_EQ(relation.space(), std::string(kPackage) + "relationships");
      EXPECT_EQ(relation["Type"], kTypes + type);
      EXPECT_TRUE(ids.insert(relation["Id"]).second);
      EXPECT_THAT(relation["Target"], StartsWith("/"));
      reached.insert(relation["Target"].substr(1));
    }
    return ids.size();
  };
  EXPECT_EQ(follow("_rels/.rels", "3dmodel"), 1);
  EXPECT_EQ(follow("3D/_rels/3dmodel.model.rels", "3dtexture"), parts.size() - 4);
  EXPECT_EQ(reached, parts);
}

TEST_F(Export3mf, HasAModelByTheRules) {
  const Archive package = archive();
  const Volume volume(package);
  const XmlElement model = volume.root();
  EXPECT_EQ(model.space(), kCore);
  EXPECT_EQ(model["unit"], "millimeter");
  EXPECT_EQ(model.prefix(model["requiredextensions"]), kVolumetric);

  // What is referred to stands before, and is what it has to be.
  const XmlElement levelset = volume.levelset();
  EXPECT_EQ(levelset.space(), kVolumetric);
  EXPECT_LT(levelset.number("functionid"), volume.item().number("objectid"));
  EXPECT_LT(levelset.number("meshid"), volume.item().number("objectid"));
  EXPECT_EQ(volume.resource(levelset.number("meshid")).child("mesh").space(), kCore);
  const XmlElement color = volume.resource(levelset.number("volumeid")).child("color");
  EXPECT_EQ(color["channel"], "color");   // a vector
  EXPECT_EQ(levelset["channel"], "red");  // a scalar
  int before = 0;
  for (const XmlElement& resource : model.child("resources").children()) {
    EXPECT_GT(resource.number("id"), before);
    before = resource.number("id");
  }
  std::set<std::string> names;
  std::set<std::string> sheets;
  for (const auto& [id, function] : volume.resources()) {
    if (function.name() != "functionfromimage3d") continue;
    EXPECT_EQ(function.space(), kVolumetric);
    EXPECT_THAT(function["filter"], AnyOf("nearest", "linear"));
    for (const char* style : {"tilestyleu", "tilestylev", "tilestylew"}) {
      EXPECT_THAT(function[style], AnyOf("wrap", "mirror", "clamp"));
    }
    EXPECT_LT(function.number("image3did"), id);
    const XmlElement image = volume.resource(function.number("image3did"));
    EXPECT_EQ(image.name(), "image3d");
    names.insert(image["name"]);
    const XmlElement stack = volume.stack(image);
    const std::vector<XmlElement> all = stack.children("imagesheet");
    ASSERT_EQ(all.size(), static_cast<std::size_t>(stack.number("sheetcount")));
    for (const XmlElement& sheet : all) {
      EXPECT_THAT(sheet["path"], StartsWith("/3D/volumetric/" + image["name"] + "/"));
      EXPECT_TRUE(sheets.insert(sheet["path"]).second);
      const png::Decoded png = png::decode(package.at(sheet["path"].substr(1)).data());
      EXPECT_EQ(png.width, stack.number("columncount"));
      EXPECT_EQ(png.height, stack.number("rowcount"));
      EXPECT_LE(std::max(png.width, png.height), 1 << 30);  // 1024^3
      EXPECT_EQ(png.bit_depth, image["name"] == "mask" ? 1 : 8);
      EXPECT_EQ(png.color_type, image["name"] == "mask" ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB);
    }
  }
  EXPECT_EQ(names, (std::set<std::string>{"mask", "color"}));
}

TEST_F(Export3mf, HasTheMasksPixelsWhereTheyArePrinted) {
  run({"export", here_ / "a.bjob", "-o", here_ / "masks"});
  run({"export", here_ / "a.bjob", "-o", here_ / "colors", "--what", "color"});
  const StackReader masks(here_ / "masks");
  const StackInfo& info = masks.info();
  const Archive package = archive();
  Volume volume(package);
  const XmlElement color = volume.resource(volume.levelset().number("volumeid")).child("color");
  const XmlElement color_function = volume.resource(color.number("functionid"));

  whole::Random random;
  int inside = 0;
  std::set<std::vector<int>> colors;
  for (int trial = 0; trial < 2000; ++trial) {
    std::array<int, 3> pixel{};
    std::array<double, 3> bed_mm{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      pixel[axis] = random.number(0, info.size[axis] - 1);
      const double within = 0.01 + 0.98 * random.number(0, 1000) / 1000.0;
      bed_mm[axis] = info.origin_mm[axis] + (pixel[axis] + within) * info.pitch_mm[axis];
    }
    const bool solid = masks.read(pixel[2]).at(pixel[0], pixel[1]);
    ASSERT_EQ(volume.level(bed_mm) < 0, solid)
        << pixel[0] << ", " << pixel[1] << ", layer " << pixel[2];
    if (!solid) continue;
    ++inside;
    colors.insert(volume.sample(color_function, color["transform"], bed_mm));
  }
  EXPECT_GT(inside, 500);
  EXPECT_THAT(colors, IsSupersetOf({std::vector{255, 0, 0}, std::vector{0, 0, 255}}));
  const auto at = [&](double y_mm) {
    const std::array<double, 3> surface = {23, y_mm, 3};
    return volume.sample(color_function, color["transform"], surface);
  };
  EXPECT_EQ(at(30.15), (std::vector{255, 0, 0}));  // the front
  EXPECT_EQ(at(35.85), (std::vector{0, 0, 255}));
}

// lib3mf 1.8 knows no level sets, so it gets the same package with the box as the part.
TEST_F(Export3mf, IsAcceptedByLib3mfAsFarAsThatKnowsIt) {
  {
    ZipWriter known(here_ / "known.3mf");
    for (ArchiveEntry entry : archive().entries) {
      if (entry.name == "3D/3dmodel.model") {
        entry.bytes = std::regex_replace(
            entry.bytes, std::regex("<object id=\"7\"[^]*</object>(\\s*</resources>)"), "$1");
        entry.bytes =
            std::regex_replace(entry.bytes, std::regex("objectid=\"7\""), "objectid=\"6\"");
      }
      known.add(entry.name, entry.bytes);
    }
    known.finish();
  }
  NMR::PLib3MFModel* model = nullptr;
  ASSERT_EQ(NMR::lib3mf_createmodel(&model), LIB3MF_OK);
  NMR::PLib3MFModelReader* reader = nullptr;
  ASSERT_EQ(NMR::lib3mf_model_queryreader(model, "3mf", &reader), LIB3MF_OK);
  EXPECT_EQ(NMR::lib3mf_reader_readfromfileutf8(reader, (here_ / "known.3mf").c_str()), LIB3MF_OK);
  DWORD code = 0;
  LPCSTR message = nullptr;
  NMR::lib3mf_getlasterror(reader, &code, &message);
  EXPECT_EQ(code, 0U) << message;
  DWORD pictures = 0;
  EXPECT_EQ(NMR::lib3mf_model_getattachmentcount(model, &pictures), LIB3MF_OK);
  EXPECT_EQ(pictures, archive().entries.size() - 4);
  std::vector<std::string> warnings;
  DWORD count = 0;
  NMR::lib3mf_reader_getwarningcount(reader, &count);
  for (DWORD i = 0; i < count; ++i) {
    std::array<char, 256> text{};
    DWORD size = 0;
    NMR::lib3mf_reader_getwarningutf8(reader, i, &code, text.data(), text.size(), &size);
    warnings.emplace_back(text.data());
  }
  EXPECT_THAT(warnings, ElementsAre("A required extension is not supported"));
  NMR::lib3mf_release(reader);
  NMR::lib3mf_release(model);
}

TEST_F(Export3mf, GivesTheSameBytesAgain) {
  run({"export", here_ / "a.bjob", "--3mf", here_ / "b.3mf"});
  EXPECT_EQ(here_.text("a.3mf"), here_.text("b.3mf"));
}

}  // namespace
}  // namespace binderjet
