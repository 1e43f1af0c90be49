// SPDX-License-Identifier: GPL-3.0-or-later
// glTF and whatever else assimp knows: all meshes of the scene where its nodes put them.
#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "slicer/base/error.h"
#include "slicer/mesh/read/readers.h"

namespace binderjet {
namespace {

using Matrix = aiMatrix4x4t<double>;

// The model and what lies beside it; anything else is not there for assimp, which would follow the
// names in a model wherever they lead.
class OwnFolder : public Assimp::DefaultIOSystem {
 public:
  explicit OwnFolder(std::string model) : model_(std::move(model)) {}
  bool Exists(const char* file) const override {
    return is_own(file) && Assimp::DefaultIOSystem::Exists(file);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return is_own(file) ? Assimp::DefaultIOSystem::Open(file, mode) : nullptr;
  }

 private:
  bool is_own(const std::string& file) const {
    if (file == model_) return true;
    const std::filesystem::path folder = std::filesystem::path(model_).parent_path();
    const std::filesystem::path name(file);
    return !file_beside(model_, folder.empty() ? file : name.lexically_relative(folder).string())
                .empty();
  }

  std::string model_;
};

class AssimpReader {
 public:
  AssimpReader(const aiScene& scene, const std::string& path, const std::string& name)
      : scene_(scene), path_(path), name_(name) {
    for (unsigned i = 0; i < scene.mNumMaterials; ++i) take_material(*scene.mMaterials[i]);
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) textured_ |= is_textured(*scene.mMeshes[i]);
  }

  MeshFile read() {
    if (scene_.mRootNode != nullptr) take_node(*scene_.mRootNode, Matrix(), 0);
    if (left_out_ > 0) {
      result_.warnings.push_back(counted(left_out_, "point or line", "points and lines") +
                                 " without area left out");
    }
    result_.paint = painter_.take(result_.mesh);
    return std::move(result_);
  }

 private:
  void take_node(const aiNode& node, const Matrix& parent, int depth) {
    if (depth > 256) {
      throw Error(ErrorKind::kBadInput, name_, "nests its nodes over 256 deep; flatten the scene");
    }
    const Matrix matrix = parent * Matrix(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] < scene_.mNumMeshes) take_mesh(*scene_.mMeshes[node.mMeshes[i]], matrix);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      take_node(*node.mChildren[i], matrix, depth + 1);
    }
  }

  void take_mesh(const aiMesh& mesh, const Matrix& matrix) {
    Mesh& out = result_.mesh;
    const std::size_t first = out.points.size();
    if (first + mesh.mNumVertices > kMost || out.triangles.size() + mesh.mNumFaces > kMost) {
      throw Error(ErrorKind::kBadInput, name_,
                  "its scene has over 100 million triangles; put fewer copies into it");
    }
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      aiVector3t<double> point(mesh.mVertices[i].x, mesh.mVertices[i].y, mesh.mVertices[i].z);
      if (!matrix.IsIdentity()) point = matrix * point;
      out.points.push_back({point.x, point.y, point.z});
      // Without images the vertices carry all the color there is.
      if (!textured_ && mesh.mColors[0] != nullptr) {
        painter_.add_sample(out.points.back(), color_at(mesh, i));
      }
    }
    const bool mirrored = matrix.Determinant() < 0;
    std::vector<int> corners;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices < 3) ++left_out_;
      corners.clear();
      for (unsigned c = 0; c < face.mNumIndices; ++c) {
        if (face.mIndices[c] >= mesh.mNumVertices) {
          throw Error(ErrorKind::kBadInput, fmt::format("{}: face {}", name_, i + 1),
                      "names a point that is not there; export the model again");
        }
        corners.push_back(static_cast<int>(first + face.mIndices[c]));
      }
      std::vector<unsigned> vertices(face.mIndices, face.mIndices + face.mNumIndices);
      if (mirrored) {
        std::reverse(corners.begin(), corners.end());
        std::reverse(vertices.begin(), vertices.end());
      }
      add_polygon(out, corners);
      paint_face(mesh, vertices);
    }
  }

  struct Look {
    std::optional<Rgb> color;
    int image = -1;
    unsigned uv_channel = 0;
  };

  void take_material(const aiMaterial& material) {
    Look look;
    aiString text;
    const bool named = material.Get(AI_MATKEY_NAME, text) == aiReturn_SUCCESS;
    const std::string name = named ? text.C_Str() : "";
    aiColor4D color;
    // Materials that assimp makes up for files without any have a color nobody chose.
    if (name != "DefaultMaterial" &&
        (material.Get(AI_MATKEY_BASE_COLOR, color) == aiReturn_SUCCESS ||
         material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS)) {
      look.color = rgb_of(color.r, color.g, color.b);
    }
    for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
      aiString file;
      std::array<aiTextureMapMode, 3> modes{};
      if (material.GetTexture(type, 0, &file, nullptr, &look.uv_channel, nullptr, nullptr,
                              modes.data()) != aiReturn_SUCCESS) {
        continue;
      }
      look.image = image_of(file.C_Str(), {tiling(modes[0]), tiling(modes[1])});
      if (look.image < 0) look.color = kNeutral;
      break;
    }
    looks_.push_back(look);
  }

  static Tiling tiling(aiTextureMapMode mode) {
    if (mode == aiTextureMapMode_Mirror) return Tiling::kMirror;
    return mode == aiTextureMapMode_Wrap ? Tiling::kRepeat : Tiling::kClamp;
  }

  int image_of(const std::string& file, std::array<Tiling, 2> tiling) {
    TextureSource source{file, "", {}, tiling};
    if (const aiTexture* inside = scene_.GetEmbeddedTexture(file.c_str())) {
      if (inside->mHeight != 0) return missing(file);  // raw texels: no format we read makes them
      const auto* bytes = reinterpret_cast<const std::byte*>(inside->pcData);
      source.bytes.assign(bytes, bytes + inside->mWidth);
    } else {
      source.path = file_beside(path_, file);
      if (source.path.empty()) return missing(file);
    }
    painter_.textures().push_back(std::move(source));
    return static_cast<int>(painter_.textures().size()) - 1;
  }

  int missing(const std::string& file) {
    result_.warnings.push_back(
        fmt::format("its image \"{}\" is not in its folder; painted in neutral gray", file));
    return -1;
  }

  const Look& look_of(const aiMesh& mesh) const {
    static const Look kNone;
    return mesh.mMaterialIndex < looks_.size() ? looks_[mesh.mMaterialIndex] : kNone;
  }
  bool is_textured(const aiMesh& mesh) const {
    const Look& look = look_of(mesh);
    return look.image >= 0 && look.uv_channel < AI_MAX_NUMBER_OF_TEXTURECOORDS &&
           mesh.mTextureCoords[look.uv_channel] != nullptr;
  }

  // The vertex's own color times the material's, as glTF has it.
  Rgb color_at(const aiMesh& mesh, unsigned vertex) const {
    const Rgb base = look_of(mesh).color.value_or(kWhite);
    if (mesh.mColors[0] == nullptr) return base;
    const aiColor4D& c = mesh.mColors[0][vertex];
    if (!std::isfinite(c.r + c.g + c.b)) return base;
    return rgb_of(c.r * base[0] / 255.0, c.g * base[1] / 255.0, c.b * base[2] / 255.0);
  }

  void paint_face(const aiMesh& mesh, std::span<const unsigned> vertices) {
    const Look& look = look_of(mesh);
    for (std::size_t i = 2; i < vertices.size(); ++i) {
      const std::array<unsigned, 3> v = {vertices[0], vertices[i - 1], vertices[i]};
      const std::array<Rgb, 3> colors = {color_at(mesh, v[0]), color_at(mesh, v[1]),
                                         color_at(mesh, v[2])};
      if (is_textured(mesh)) {
        std::array<Uv, 3> uvs{};
        for (std::size_t c = 0; c < 3; ++c) {
          const aiVector3D& uv = mesh.mTextureCoords[look.uv_channel][v[c]];
          uvs[c] = {static_cast<float>(uv.x), static_cast<float>(uv.y)};
        }
        painter_.add_textured(look.image, uvs, colors);
      } else if (mesh.mColors[0] != nullptr) {
        painter_.add_corners(colors);
      } else {
        painter_.add_plain(1, look.color);
      }
    }
  }

  static constexpr std::size_t kMost = 100'000'000;

  const aiScene& scene_;
  const std::string& path_;
  const std::string& name_;
  MeshFile result_;
  Painter painter_;
  std::vector<Look> looks_;  // by material
  bool textured_ = false;    // some mesh has an image
  std::int64_t left_out_ = 0;
};

// Keeps of assimp's readers those for this extension, and none for a format that we read ourselves:
// assimp would ask the others too whether they know what a broken file is, and some crash on it.
void keep_readers_of(const std::string& extension, Assimp::Importer& importer) {
  const std::string ours = " obj stl ply off 3mf ";
  const std::string wanted = " " + extension + " ";
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const std::string known = fmt::format(" {} ", importer.GetImporterInfo(i)->mFileExtensions);
    if (known.find(wanted) != known.npos && ours.find(wanted) == ours.npos) continue;
    const std::unique_ptr<Assimp::BaseImporter> reader(importer.GetImporter(i));
    importer.UnregisterLoader(reader.get());
  }
}

}  // namespace

MeshFile read_with_assimp(const std::string& path, const std::string& name) {
  Assimp::Importer importer;
  std::string dot = path.substr(std::min(path.size(), path.find_last_of("./")));
  for (char& c : dot) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (dot.starts_with('.')) keep_readers_of(dot.substr(1), importer);
  if (!dot.starts_with('.') || importer.GetImporterCount() == 0) {
    throw Error(ErrorKind::kBadInput, name,
                "is of no known format; save the model as STL, PLY, OBJ, OFF, 3MF or glTF");
  }
  importer.SetIOHandler(new OwnFolder(path));  // which the importer takes over
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr) {
    std::string reason = importer.GetErrorString();
    for (char& c : reason) c = c == '\n' ? ' ' : c;
    throw Error(
        ErrorKind::kBadInput, name,
        fmt::format("cannot be read ({}); export it again as STL, PLY, OBJ or 3MF", reason));
  }
  MeshFile result = AssimpReader(*scene, path, name).read();
  if (dot == ".gltf" || dot == ".glb") {
    result.warnings.push_back(
        "glTF is in meters and y-up by its specification, but is read as it is: one unit is 1 mm "
        "and z is up; use --units m and --rotate 90,0,0 if the part comes out small or lying");
  }
  return result;
}

}  // namespace binderjet
