// SPDX-License-Identifier: GPL-3.0-or-later
// 3MF through lib3mf: what the build names, with the transforms of items and components, in its
// unit.
#include <Model/COM/NMR_DLLInterfaces.h>
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slicer/base/error.h"
#include "slicer/mesh/read/readers.h"

namespace binderjet {
namespace {

using Affine = std::array<std::array<double, 3>, 4>;  // rows as in 3MF: a point is a row vector

struct Release {
  void operator()(NMR::PLib3MFBase* object) const {
    if (object != nullptr) NMR::lib3mf_release(object);
  }
};
template <typename T>
using Handle = std::unique_ptr<T, Release>;

// lib3mf keeps the file's decimal numbers as float. The shortest decimal that reads as that float
// is the file's own number wherever it has up to six digits, which most have; so 0.1 is 0.1 here
// and not 0.100000001.
double as_written(float value) {
  std::array<char, 64> text{};
  const auto [end, problem] = std::to_chars(text.data(), text.data() + text.size(), value);
  double result = static_cast<double>(value);
  if (problem == std::errc{}) std::from_chars(text.data(), end, result);
  return result;
}

Affine affine(const NMR::MODELTRANSFORM& transform) {
  Affine result{};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      result[row][column] = as_written(transform.m_fFields[column][row]);
    }
  }
  return result;
}

Point transformed(const Affine& matrix, const Point& p) {
  Point result = matrix[3];
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column)
      result[column] += p[row] * matrix[row][column];
  }
  return result;
}

bool is_identity(const Affine& m) {
  return m == Affine{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};
}

double determinant(const Affine& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

class Reader3mf {
 public:
  Reader3mf(const std::string& path, const std::string& name) : name_(name) {
    NMR::PLib3MFModel* model = nullptr;
    if (NMR::lib3mf_createmodel(&model) != LIB3MF_OK) fail(nullptr);
    model_.reset(model);
    NMR::PLib3MFModelReader* reader = nullptr;
    demand(NMR::lib3mf_model_queryreader(model, "3mf", &reader), model);
    const Handle<NMR::PLib3MFModelReader> owner(reader);
    demand(NMR::lib3mf_reader_readfromfileutf8(reader, path.c_str()), reader);
  }

  MeshFile read() {
    DWORD unit = 0;
    demand(NMR::lib3mf_model_getunit(model_.get(), &unit), model_.get());
    // microns, millimeters, centimeters, inches, feet, meters: lib3mf's order
    constexpr std::array<double, 6> kUnits = {0.001, 1.0, 10.0, 25.4, 304.8, 1000.0};
    constexpr std::array<const char*, 6> kNames = {"micron", "millimeter", "centimeter",
                                                   "inch",   "foot",       "meter"};
    result_.unit_mm = unit < kUnits.size() ? kUnits[unit] : 1.0;
    result_.unit_declared = true;
    if (unit < kUnits.size() && result_.unit_mm != 1.0) {
      result_.warnings.push_back(
          fmt::format("declares the unit {}; read as {:g} mm each", kNames[unit], result_.unit_mm));
    }

    NMR::PLib3MFModelBuildItemIterator* items = nullptr;
    demand(NMR::lib3mf_model_getbuilditems(model_.get(), &items), model_.get());
    const Handle<NMR::PLib3MFModelBuildItemIterator> items_owner(items);
    BOOL more = 0;
    demand(NMR::lib3mf_builditemiterator_movenext(items, &more), items);
    while (more) {
      take_item(items);
      demand(NMR::lib3mf_builditemiterator_movenext(items, &more), items);
    }
    if (result_.mesh.triangles.empty()) {
      throw Error(ErrorKind::kBadInput, name_,
                  "its build names no model; add an item to the build");
    }
    result_.paint = painter_.take(result_.mesh, true);
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(NMR::PLib3MFBase* object) const {
    DWORD code = 0;
    LPCSTR message = nullptr;
    if (object != nullptr) NMR::lib3mf_getlasterror(object, &code, &message);
    throw Error(ErrorKind::kBadInput, name_,
                fmt::format("is no 3MF file that can be read ({}); export it again",
                            message != nullptr ? message : "no reason given"));
  }

  void demand(LIB3MFRESULT result, NMR::PLib3MFBase* object) const {
    if (result != LIB3MF_OK) fail(object);
  }

  void take_item(NMR::PLib3MFModelBuildItemIterator* items) {
    NMR::PLib3MFModelBuildItem* item = nullptr;
    demand(NMR::lib3mf_builditemiterator_getcurrent(items, &item), items);
    const Handle<NMR::PLib3MFModelBuildItem> item_owner(item);
    NMR::PLib3MFModelObjectResource* object = nullptr;
    demand(NMR::lib3mf_builditem_getobjectresource(item, &object), item);
    const Handle<NMR::PLib3MFModelObjectResource> object_owner(object);
    DWORD type = 0;
    demand(NMR::lib3mf_object_gettype(object, &type), object);
    if (type != NMR::MODELOBJECTTYPE_MODEL) {
      result_.warnings.push_back("an item of its build that is no model (a support) is left out");
      return;
    }
    NMR::MODELTRANSFORM transform{};
    demand(NMR::lib3mf_builditem_getobjecttransform(item, &transform), item);
    path_.push_back(affine(transform));
    take_object(object);
    path_.pop_back();
  }

  void take_object(NMR::PLib3MFModelObjectResource* object) {
    BOOL is_mesh = 0;
    demand(NMR::lib3mf_object_ismeshobject(object, &is_mesh), object);
    if (is_mesh) {
      take_mesh(object);
      return;
    }
    BOOL is_components = 0;
    demand(NMR::lib3mf_object_iscomponentsobject(object, &is_components), object);
    if (!is_components) return;
    // Components of components double with each level: a small file can ask for any amount.
    if (path_.size() > 32) {
      throw Error(ErrorKind::kBadInput, name_, "nests its components over 32 deep; flatten it");
    }
    DWORD count = 0;
    demand(NMR::lib3mf_componentsobject_getcomponentcount(object, &count), object);
    for (DWORD i = 0; i < count; ++i) {
      NMR::PLib3MFModelComponent* component = nullptr;
      demand(NMR::lib3mf_componentsobject_getcomponent(object, i, &component), object);
      const Handle<NMR::PLib3MFModelComponent> component_owner(component);
      NMR::MODELTRANSFORM transform{};
      demand(NMR::lib3mf_component_gettransform(component, &transform), component);
      NMR::PLib3MFModelObjectResource* child = nullptr;
      demand(NMR::lib3mf_component_getobjectresource(component, &child), component);
      const Handle<NMR::PLib3MFModelObjectResource> child_owner(child);
      path_.push_back(affine(transform));
      take_object(child);
      path_.pop_back();
    }
  }

  void take_mesh(NMR::PLib3MFModelObjectResource* object) {
    DWORD point_count = 0;
    DWORD triangle_count = 0;
    demand(NMR::lib3mf_meshobject_getvertexcount(object, &point_count), object);
    demand(NMR::lib3mf_meshobject_gettrianglecount(object, &triangle_count), object);
    Mesh& mesh = result_.mesh;
    const std::size_t first = mesh.points.size();
    if (first + point_count > kMost || mesh.triangles.size() + triangle_count > kMost ||
        ++meshes_ > 100'000) {
      throw Error(ErrorKind::kBadInput, name_,
                  "its build has over 100 million triangles; put fewer copies into it");
    }
    std::vector<NMR::MODELMESHVERTEX> points(point_count);
    std::vector<NMR::MODELMESHTRIANGLE> triangles(triangle_count);
    if (point_count == 0 || triangle_count == 0) return;
    demand(NMR::lib3mf_meshobject_getvertices(object, points.data(), point_count, nullptr), object);
    demand(NMR::lib3mf_meshobject_gettriangleindices(object, triangles.data(), triangle_count,
                                                     nullptr),
           object);
    bool mirrored = false;
    for (const Affine& matrix : path_) mirrored ^= determinant(matrix) < 0;
    for (const NMR::MODELMESHVERTEX& vertex : points) {
      Point point{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        point[axis] = as_written(vertex.m_fPosition[axis]);
      for (auto matrix = path_.rbegin(); matrix != path_.rend(); ++matrix) {
        if (!is_identity(*matrix)) point = transformed(*matrix, point);
      }
      mesh.points.push_back(point);
    }
    NMR::PLib3MFPropertyHandler* handler = nullptr;
    demand(NMR::lib3mf_meshobject_createpropertyhandler(object, &handler), object);
    const Handle<NMR::PLib3MFPropertyHandler> handler_owner(handler);
    for (const NMR::MODELMESHTRIANGLE& triangle : triangles) {
      paint(handler, static_cast<DWORD>(&triangle - triangles.data()), mirrored);
      Triangle corners{};
      for (std::size_t c = 0; c < 3; ++c) {
        if (triangle.m_nIndices[c] >= point_count) {
          throw Error(ErrorKind::kBadInput, name_, "a triangle names a point that is not there");
        }
        corners[c] = static_cast<int>(first + triangle.m_nIndices[c]);
      }
      if (mirrored) std::swap(corners[1], corners[2]);
      mesh.triangles.push_back(corners);
    }
  }

  void paint(NMR::PLib3MFPropertyHandler* handler, DWORD index, bool mirrored) {
    NMR::eModelPropertyType type = NMR::MODELPROPERTYTYPE_NONE;
    NMR::lib3mf_propertyhandler_getpropertytype(handler, index, &type);
    if (type == NMR::MODELPROPERTYTYPE_COLOR) {
      NMR::MODELMESH_TRIANGLECOLOR_SRGB color{};
      demand(NMR::lib3mf_propertyhandler_getcolor(handler, index, &color), handler);
      std::array<Rgb, 3> corners{};
      for (std::size_t c = 0; c < 3; ++c) {
        corners[c] = {color.m_Colors[c].m_Red, color.m_Colors[c].m_Green, color.m_Colors[c].m_Blue};
      }
      if (mirrored) std::swap(corners[1], corners[2]);
      painter_.add_corners(corners);
    } else if (type == NMR::MODELPROPERTYTYPE_TEXCOORD2D) {
      NMR::MODELMESHTEXTURE2D texture{};
      demand(NMR::lib3mf_propertyhandler_gettexture(handler, index, &texture), handler);
      std::array<Uv, 3> uvs{};
      for (std::size_t c = 0; c < 3; ++c) uvs[c] = {texture.m_fU[c], texture.m_fV[c]};
      if (mirrored) std::swap(uvs[1], uvs[2]);
      const int image = image_of(texture.m_nTextureID);
      const Rgb base = image < 0 ? kNeutral : kWhite;
      painter_.add_textured(image, uvs, {base, base, base});
    } else if (type == NMR::MODELPROPERTYTYPE_BASEMATERIALS) {
      DWORD group = 0;
      DWORD material = 0;
      demand(NMR::lib3mf_propertyhandler_getbasematerial(handler, index, &group, &material),
             handler);
      painter_.add_plain(1, material_color(group, material));
    } else {
      painter_.add_plain(1, std::nullopt);
    }
  }

  std::optional<Rgb> material_color(DWORD group, DWORD index) {
    const auto [known, is_new] = materials_.try_emplace({group, index});
    if (!is_new) return known->second;
    NMR::PLib3MFModelBaseMaterial* material = nullptr;
    if (NMR::lib3mf_model_getbasematerialbyid(model_.get(), group, &material) != LIB3MF_OK) {
      return std::nullopt;
    }
    const Handle<NMR::PLib3MFModelBaseMaterial> owner(material);
    std::array<BYTE, 4> c{};
    // The id of a material stands one above its place.
    if (NMR::lib3mf_basematerial_getdisplaycolor(material, index == 0 ? 0 : index - 1, &c[0], &c[1],
                                                 &c[2], &c[3]) == LIB3MF_OK) {
      known->second = Rgb{c[0], c[1], c[2]};
    }
    return known->second;
  }

  // The image with this resource id, taken from the archive once; -1 if it is not there.
  int image_of(DWORD id) {
    const auto [known, is_new] = images_.try_emplace(id, -1);
    if (!is_new) return known->second;
    NMR::PLib3MFModelTexture2D* texture = nullptr;
    NMR::PLib3MFModelAttachment* attachment = nullptr;
    const bool found = NMR::lib3mf_model_gettexture2dbyid(model_.get(), id, &texture) == LIB3MF_OK;
    const Handle<NMR::PLib3MFModelTexture2D> texture_owner(texture);
    const bool attached =
        found && NMR::lib3mf_texture2d_getattachment(texture, &attachment) == LIB3MF_OK;
    const Handle<NMR::PLib3MFModelAttachment> attachment_owner(attachment);
    ULONG64 size = 0;
    if (!attached || NMR::lib3mf_attachment_getstreamsize(attachment, &size) != LIB3MF_OK ||
        size == 0 || size > (ULONG64{1} << 30)) {
      result_.warnings.push_back("one of its images is missing; painted in neutral gray");
      return -1;
    }
    TextureSource source{fmt::format("image {}", id), "", {}, {}};
    source.bytes.resize(size);
    demand(NMR::lib3mf_attachment_writetobuffer(attachment,
                                                reinterpret_cast<BYTE*>(source.bytes.data()), size),
           attachment);
    NMR::eModelTextureTileStyle u = NMR::MODELTEXTURETILESTYLE_WRAP;
    NMR::eModelTextureTileStyle v = NMR::MODELTEXTURETILESTYLE_WRAP;
    NMR::lib3mf_texture2d_gettilestyleuv(texture, &u, &v);
    source.tiling = {tiling(u), tiling(v)};
    known->second = static_cast<int>(painter_.textures().size());
    painter_.textures().push_back(std::move(source));
    return known->second;
  }

  static Tiling tiling(NMR::eModelTextureTileStyle style) {
    if (style == NMR::MODELTEXTURETILESTYLE_WRAP) return Tiling::kRepeat;
    return style == NMR::MODELTEXTURETILESTYLE_MIRROR ? Tiling::kMirror : Tiling::kClamp;
  }

  static constexpr std::size_t kMost = 100'000'000;

  std::string name_;
  Handle<NMR::PLib3MFModel> model_;
  MeshFile result_;
  Painter painter_;
  std::map<DWORD, int> images_;
  std::map<std::pair<DWORD, DWORD>, std::optional<Rgb>> materials_;
  std::vector<Affine> path_;  // of the item and the components, outermost first
  int meshes_ = 0;
};

}  // namespace

MeshFile read_3mf(const std::string& path, const std::string& name) {
  return Reader3mf(path, name).read();
}

}  // namespace binderjet
