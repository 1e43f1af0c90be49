// SPDX-License-Identifier: GPL-3.0-or-later
// Names inside models: "..", absolute ones and links never lead out of the model's own folder. The
// kernel tells which files were opened.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstring>

#include "slicer/base/whole_file.h"
#include "slicer/stack/png.h"
#include "tests/support/program.h"
#include "tests/support/scene_files.h"

namespace binderjet {
namespace {

// Counts how often a file is opened.
class Watch {
 public:
  explicit Watch(const std::string& path) : fd_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    EXPECT_GE(inotify_add_watch(fd_, path.c_str(), IN_OPEN), 0) << std::strerror(errno);
  }
  ~Watch() { close(fd_); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  bool opened() const {
    alignas(inotify_event) std::array<char, 4096> events{};
    return read(fd_, events.data(), events.size()) > 0;
  }

 private:
  int fd_;
};

constexpr const char* kObjShape =
    "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl paint\n"
    "f 1/1 3/2 2/3\nf 1/1 2/2 4/3\nf 1/1 4/2 3/3\nf 2/1 3/2 4/3\n";

std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

// A tetrahedron whose numbers are in a file of its own, painted with an image.
std::string gltf(const std::string& buffer, const std::string& image) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1,)"
         R"("material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0)"
         R"(}}}],"textures":[{"source":0}],"images":[{"uri":)" +
         quoted(image) + R"(}],"buffers":[{"byteLength":104,"uri":)" + quoted(buffer) +
         R"(}],"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,)"
         R"("byteLength":24},{"buffer":0,"byteOffset":72,"byteLength":32}],"accessors":[)"
         R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],)"
         R"("max":[4,4,4]},{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"},)"
         R"({"bufferView":2,"componentType":5126,"count":4,"type":"VEC2"}]})";
}

std::string gltf_numbers() {
  std::string data;
  const auto put = [&](const auto& values) {
    for (const auto value : values) {
      data.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  };
  put(std::array<float, 12>{0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 4});
  put(std::array<std::uint16_t, 12>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
  put(std::array<float, 8>{0, 0, 1, 0, 0, 1, 1, 1});
  return data;
}

std::string ply(const std::string& image) {
  return "ply\nformat ascii 1.0\ncomment TextureFile " + image +
         "\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "property float s\nproperty float t\nelement face 4\n"
         "property list uchar int vertex_indices\nend_header\n"
         "0 0 0 0 0\n4 0 0 1 0\n0 4 0 0 1\n0 0 4 1 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
}

std::string wrl(const std::string& image, const std::string& inlined) {
  return "#VRML V2.0 utf8\nInline { url " + quoted(inlined) +
         " }\nShape { appearance Appearance { texture ImageTexture { url " + quoted(image) +
         " } } geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 4 0 0, 0 4 0, 0 0 4] }\n"
         "texCoord TextureCoordinate { point [0 0, 1 0, 0 1, 1 1] }\n"
         "coordIndex [0 2 1 -1 0 1 3 -1 0 3 2 -1 1 2 3 -1] } }\n";
}

std::string wrl1(const std::string& image, const std::string& inlined) {
  return "#VRML V1.0 ascii\nSeparator { WWWInline { name " + quoted(inlined) +
         " } Texture2 { filename " + quoted(image) +
         " }\nCoordinate3 { point [0 0 0, 4 0 0, 0 4 0, 0 0 4] }\n"
         "IndexedFaceSet { coordIndex [0, 2, 1, -1, 0, 1, 3, -1, 0, 3, 2, -1, 1, 2, 3, -1] } }\n";
}

std::string model_3mf(const std::string& image, const std::string& model) {
  return package_3mf(
      {.resources = "<m:texture2d id=\"1\" path=\"" + image + R"(" contenttype="image/png"/>
         <m:texture2dgroup id="2" texid="1"><m:tex2coord u="0" v="0"/></m:texture2dgroup>
         <object id="3" type="model" pid="2" pindex="0"><mesh><vertices>
         <vertex x="0" y="0" z="0"/><vertex x="4" y="0" z="0"/><vertex x="0" y="4" z="0"/>
         <vertex x="0" y="0" z="4"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>
         <triangle v1="0" v2="1" v3="3"/><triangle v1="0" v2="3" v3="2"/>
         <triangle v1="1" v2="2" v3="3"/></triangles></mesh></object>)",
       .build = "<item objectid=\"3\"/>",
       .model = model,
       .image = image});
}

// model/ holds a model; outside of it lies what the model must not see.
class Names : public testing::Test {
 protected:
  Names() {
    std::filesystem::create_directories(here_ / "model/sub");
    const std::vector<std::byte> png =
        encode_png_rgb(std::vector<std::byte>(48, std::byte{255}), 4, 4, {1, 1});
    for (const std::string folder : {"", "model/"}) {
      write_file(here_ / (folder + "own.png"), png);
      write(folder + "own.mtl", "newmtl paint\nKd 1 0 0\n");
      write(folder + "own.bin", gltf_numbers());
      write(folder + "own.wrl", wrl("", ""));
    }
    namespace fs = std::filesystem;
    for (const std::string kind : {"png", "mtl", "bin", "wrl"}) {
      fs::create_symlink(here_ / ("own." + kind), here_ / ("model/link." + kind));
    }
    fs::create_symlink(fs::path(here_ / "own.png").parent_path(), here_ / "model/out");
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(here_ / name, std::ios::binary) << text;
  }
  // Names by which a model may try to reach the file outside; the first is for its own.
  std::vector<std::string> ways_to(const std::string& kind) const {
    const std::string file = "own." + kind;
    return {file,          "../" + file,   here_ / file,  "sub/../../" + file,
            "..\\" + file, "link." + kind, "out/" + file, "file://" + (here_ / file)};
  }
  // `model(name)` is a model that names a file of this kind.
  template <class Model>
  void expect_own_folder(const std::string& file, const std::string& kind, Model model,
                         bool takes_its_own = true) const {
    for (const std::string& name : ways_to(kind)) {
      SCOPED_TRACE(file + " names " + name);
      write("model/" + file, model(name));
      const Watch own(here_ / ("model/own." + kind));
      const Watch png(here_ / "own.png"), mtl(here_ / "own.mtl"), bin(here_ / "own.bin"),
          scene(here_ / "own.wrl");
      const Ran ran = here_.run(
          {"slice", here_ / ("model/" + file), "-p", "z450", "-q", "-o", here_ / "a.bjob"}, 60);
      EXPECT_TRUE(ran.status == 0 || ran.status == 3) << ran.err;
      EXPECT_FALSE(png.opened() || mtl.opened() || bin.opened() || scene.opened());
      const bool its_own = takes_its_own && name == "own." + kind;
      EXPECT_TRUE(own.opened() || !its_own) << ran.err;
    }
  }

  Workplace here_;
};

TEST_F(Names, OfMaterialsStayInTheModelsFolder) {
  expect_own_folder("a.obj", "mtl",
                    [](const std::string& name) { return "mtllib " + name + "\n" + kObjShape; });
}

TEST_F(Names, OfAMaterialsImageStayInTheModelsFolder) {
  expect_own_folder("a.obj", "png", [this](const std::string& name) {
    write("model/a.mtl", "newmtl paint\nKd 1 1 1\nmap_Kd " + name + "\n");
    return std::string("mtllib a.mtl\n") + kObjShape;
  });
}

TEST_F(Names, InPlyStayInTheModelsFolder) { expect_own_folder("a.ply", "png", ply); }

// An image, and another scene, which is left out wherever it lies.
TEST_F(Names, InVrmlStayInTheModelsFolder) {
  const auto scene = [](const std::string& image) {
    return image.substr(0, image.size() - 3) + "wrl";
  };
  expect_own_folder("a.wrl", "png",
                    [&](const std::string& name) { return wrl(name, scene(name)); });
  expect_own_folder("b.wrl", "png",
                    [&](const std::string& name) { return wrl1(name, scene(name)); });
}

TEST_F(Names, InGltfStayInTheModelsFolder) {
  expect_own_folder("a.gltf", "png", [](const std::string& name) { return gltf("own.bin", name); });
  expect_own_folder("a.gltf", "bin", [](const std::string& name) { return gltf(name, "own.png"); });
}

TEST_F(Names, In3mfStayInItsArchive) {
  expect_own_folder(
      "a.3mf", "png", [](const std::string& name) { return model_3mf(name, "3D/3dmodel.model"); },
      false);
}

}  // namespace
}  // namespace binderjet
