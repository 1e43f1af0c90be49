// SPDX-License-Identifier: GPL-3.0-or-later
// glTF and whatever else assimp knows: all meshes of the scene where its nodes put them.
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "slicer/error.h"
#include "slicer/mesh/readers.h"

namespace binderjet {
namespace {

using Matrix = aiMatrix4x4t<double>;

class SceneReader {
 public:
  SceneReader(const aiScene& scene, const std::string& name) : scene_(scene), name_(name) {}

  MeshFile read() {
    if (scene_.mRootNode != nullptr) take_node(*scene_.mRootNode, Matrix(), 0);
    if (left_out_ > 0) {
      result_.warnings.push_back(counted(left_out_, "point or line", "points and lines") +
                                 " without area left out");
    }
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
      if (mirrored) std::reverse(corners.begin(), corners.end());
      add_polygon(out, corners);
    }
  }

  static constexpr std::size_t kMost = 100'000'000;

  const aiScene& scene_;
  const std::string& name_;
  MeshFile result_;
  std::int64_t left_out_ = 0;
};

}  // namespace

MeshFile read_with_assimp(const std::string& path, const std::string& name) {
  Assimp::Importer importer;
  const std::string dot = path.substr(std::min(path.size(), path.find_last_of("./")));
  if (name.find('.') == name.npos || !importer.IsExtensionSupported(dot)) {
    throw Error(ErrorKind::kBadInput, name,
                "is of no known format; save the model as STL, PLY, OBJ, OFF, 3MF or glTF");
  }
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr) {
    std::string reason = importer.GetErrorString();
    for (char& c : reason) c = c == '\n' ? ' ' : c;
    throw Error(
        ErrorKind::kBadInput, name,
        fmt::format("cannot be read ({}); export it again as STL, PLY, OBJ or 3MF", reason));
  }
  MeshFile result = SceneReader(*scene, name).read();
  if (dot == ".gltf" || dot == ".glb") {
    result.warnings.push_back(
        "glTF is in metres and y-up by its specification, but is read as it is: one unit is 1 mm "
        "and z is up; use --units m and --rotate 90,0,0 if the part comes out small or lying");
  }
  return result;
}

}  // namespace binderjet
