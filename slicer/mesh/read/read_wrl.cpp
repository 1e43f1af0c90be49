// SPDX-License-Identifier: GPL-3.0-or-later
// VRML 1 and 2 through Coin: the triangles of the scene where its transforms put them, with the
// color of each corner.
#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/VRMLnodes/SoVRMLAppearance.h>
#include <Inventor/VRMLnodes/SoVRMLColor.h>
#include <Inventor/VRMLnodes/SoVRMLCoordinate.h>
#include <Inventor/VRMLnodes/SoVRMLFontStyle.h>
#include <Inventor/VRMLnodes/SoVRMLImageTexture.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedShape.h>
#include <Inventor/VRMLnodes/SoVRMLInline.h>
#include <Inventor/VRMLnodes/SoVRMLNormal.h>
#include <Inventor/VRMLnodes/SoVRMLShape.h>
#include <Inventor/VRMLnodes/SoVRMLTextureCoordinate.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/fields/SoSFNode.h>
#include <Inventor/lists/SoFieldList.h>
#include <Inventor/nodes/SoIndexedShape.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/nodes/SoVertexProperty.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "slicer/base/error.h"
#include "slicer/mesh/read/readers.h"
#include "slicer/mesh/weld.h"

namespace binderjet {
namespace {

// Coin is one state for the whole process, and reports faults through callbacks.
std::mutex coin_mutex;

void keep_first_fault(const SoError* error, void* data) {
  auto& fault = *static_cast<std::string*>(data);
  if (!fault.empty()) return;
  fault = error->getDebugString().getString();
  std::replace(fault.begin(), fault.end(), '\n', ' ');
}

SbBool no_image(const SbString&, SbImage*, void*) { return TRUE; }
void no_fetch(const SbString&, void*, SoVRMLInline*) {}

// Whether the text includes another file as a node outside comments and strings: a model is one
// file, and what it names elsewhere is not ours to open.
bool includes_files(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size()) {
    const char c = text[i];
    if (c == '#') {
      while (i < text.size() && text[i] != '\n' && text[i] != '\r') ++i;
    } else if (c == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i) i += text[i] == '\\' ? 1 : 0;
      ++i;
    } else if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      const std::size_t begin = i;
      while (i < text.size() &&
             (std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_')) {
        ++i;
      }
      const std::string_view word = text.substr(begin, i - begin);
      if (word == "File" || word == "SoFile") return true;
    } else {
      ++i;
    }
  }
  return false;
}

class WrlReader {
 public:
  explicit WrlReader(const std::string& path) : path_(path) {}

  // What Coin would not have survived, or empty; nothing was read behind it.
  const std::string& broken() const { return broken_; }

  MeshFile read(SoNode& root) {
    SoCallbackAction action;
    action.addPreCallback(SoVRMLShape::getClassTypeId(), enter_shape, this);
    action.addPreCallback(SoShape::getClassTypeId(), enter_old_shape, this);
    action.addPreCallback(SoTexture2::getClassTypeId(), meet_texture, this);
    action.addPreCallback(SoSeparator::getClassTypeId(), enter_separator, this);
    action.addPostCallback(SoSeparator::getClassTypeId(), leave_separator, this);
    action.addTriangleCallback(SoShape::getClassTypeId(), take_triangle, this);
    action.apply(&root);
    result_.mesh.points = welder_.take();
    result_.paint = painter_.take(result_.mesh, true);
    return std::move(result_);
  }

 private:
  static WrlReader& self(void* data) { return *static_cast<WrlReader*>(data); }

  static SoCallbackAction::Response enter_shape(void* data, SoCallbackAction*, const SoNode* node) {
    const auto* shape = static_cast<const SoVRMLShape*>(node);
    WrlReader& reader = self(data);
    reader.image_ = -1;
    reader.missing_ = false;
    reader.broken_ = misplaced(*node);
    if (!reader.broken_.empty()) return SoCallbackAction::ABORT;
    const SoNode* look = shape->appearance.getValue();
    if (look == nullptr) return SoCallbackAction::CONTINUE;
    const SoNode* texture = static_cast<const SoVRMLAppearance*>(look)->texture.getValue();
    if (texture != nullptr && texture->isOfType(SoVRMLImageTexture::getClassTypeId())) {
      const auto* image = static_cast<const SoVRMLImageTexture*>(texture);
      std::vector<std::string> urls;
      urls.reserve(static_cast<std::size_t>(image->url.getNum()));
      for (int i = 0; i < image->url.getNum(); ++i) urls.push_back(image->url[i].getString());
      reader.use_image(urls, {image->repeatS.getValue() != 0 ? Tiling::kRepeat : Tiling::kClamp,
                              image->repeatT.getValue() != 0 ? Tiling::kRepeat : Tiling::kClamp});
    }
    return SoCallbackAction::CONTINUE;
  }

  // Coin takes a node for the kind that belongs into its field, whatever stands there.
  static std::string misplaced(const SoNode& node) {
    static const std::map<std::string, SoType> kinds = {
        {"appearance", SoVRMLAppearance::getClassTypeId()},
        {"color", SoVRMLColor::getClassTypeId()},
        {"coord", SoVRMLCoordinate::getClassTypeId()},
        {"fontStyle", SoVRMLFontStyle::getClassTypeId()},
        {"normal", SoVRMLNormal::getClassTypeId()},
        {"texCoord", SoVRMLTextureCoordinate::getClassTypeId()},
        {"vertexProperty", SoVertexProperty::getClassTypeId()}};
    SoFieldList fields;
    node.getFields(fields);
    for (int i = 0; i < fields.getLength(); ++i) {
      SbName name;
      if (!fields[i]->isOfType(SoSFNode::getClassTypeId()) || !node.getFieldName(fields[i], name)) {
        continue;
      }
      const SoNode* held = static_cast<const SoSFNode*>(fields[i])->getValue();
      const auto kind = kinds.find(name.getString());
      if (held != nullptr && kind != kinds.end() && !held->isOfType(kind->second)) {
        return fmt::format("has a {} as the {} of a {}, where another kind of node belongs",
                           held->getTypeId().getName().getString(), name.getString(),
                           node.getTypeId().getName().getString());
      }
    }
    return "";
  }

  // Coin reads the points that a face names without asking whether they are there.
  static bool names_all(const SoMFInt32& index, int points) {
    for (int i = 0; i < index.getNum(); ++i) {
      if (index[i] >= points) return false;
    }
    return true;
  }
  static bool has_its_points(SoCallbackAction& action, const SoNode& node) {
    if (node.isOfType(SoIndexedShape::getClassTypeId())) {
      return names_all(static_cast<const SoIndexedShape&>(node).coordIndex,
                       action.getNumCoordinates());
    }
    if (node.isOfType(SoVRMLIndexedShape::getClassTypeId())) {
      const auto& shape = static_cast<const SoVRMLIndexedShape&>(node);
      const SoNode* points = shape.coord.getValue();
      const bool there = points != nullptr && points->isOfType(SoVRMLCoordinate::getClassTypeId());
      return names_all(shape.coordIndex,
                       there ? static_cast<const SoVRMLCoordinate*>(points)->point.getNum() : 0);
    }
    return true;
  }

  static SoCallbackAction::Response enter_old_shape(void* data, SoCallbackAction* action,
                                                    const SoNode* node) {
    WrlReader& reader = self(data);
    reader.broken_ = misplaced(*node);
    if (!reader.broken_.empty()) return SoCallbackAction::ABORT;
    if (!has_its_points(*action, *node)) {
      reader.broken_ = "has a face that names a point that is not there";
      return SoCallbackAction::ABORT;
    }
    const SbMatrix& matrix = action->getModelMatrix();
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        reader.matrix_[row][column] = static_cast<double>(matrix[row][column]);
      }
    }
    reader.mirrored_ = matrix.det3() < 0;
    return SoCallbackAction::CONTINUE;
  }

  static SoCallbackAction::Response meet_texture(void* data, SoCallbackAction*,
                                                 const SoNode* node) {
    const auto* texture = static_cast<const SoTexture2*>(node);
    WrlReader& reader = self(data);
    reader.image_ = -1;
    reader.missing_ = false;
    const std::string name = texture->filename.getValue().getString();
    const auto tiling = [](int wrap) {
      return wrap == SoTexture2::REPEAT ? Tiling::kRepeat : Tiling::kClamp;
    };
    if (!name.empty()) {
      reader.use_image({name},
                       {tiling(texture->wrapS.getValue()), tiling(texture->wrapT.getValue())});
    }
    return SoCallbackAction::CONTINUE;
  }

  // VRML 1: a texture holds until its Separator ends.
  static SoCallbackAction::Response enter_separator(void* data, SoCallbackAction*, const SoNode*) {
    self(data).outer_.push_back({self(data).image_, self(data).missing_});
    return SoCallbackAction::CONTINUE;
  }
  static SoCallbackAction::Response leave_separator(void* data, SoCallbackAction*, const SoNode*) {
    WrlReader& reader = self(data);
    if (reader.outer_.empty()) return SoCallbackAction::CONTINUE;
    std::tie(reader.image_, reader.missing_) = reader.outer_.back();
    reader.outer_.pop_back();
    return SoCallbackAction::CONTINUE;
  }

  // The first of the names that is there.
  void use_image(const std::vector<std::string>& names, std::array<Tiling, 2> tiling) {
    if (names.empty()) return;
    const auto [known, is_new] = images_.try_emplace(names.front(), -1);
    if (is_new) {
      for (const std::string& name : names) {
        const std::string found = file_beside(path_, name);
        if (found.empty()) continue;
        known->second = static_cast<int>(painter_.textures().size());
        painter_.textures().push_back({name, found, {}, tiling});
        break;
      }
      if (known->second < 0) {
        result_.warnings.push_back(fmt::format(
            "its image \"{}\" is not in its folder; painted in neutral gray", names.front()));
      }
    }
    image_ = known->second;
    missing_ = image_ < 0;
  }

  static void take_triangle(void* data, SoCallbackAction* action, const SoPrimitiveVertex* v1,
                            const SoPrimitiveVertex* v2, const SoPrimitiveVertex* v3) {
    self(data).take(*action, {v1, v2, v3});
  }

  void take(SoCallbackAction& action, std::array<const SoPrimitiveVertex*, 3> vertices) {
    if (mirrored_) std::swap(vertices[1], vertices[2]);
    Triangle triangle{};
    std::array<Rgb, 3> colors{};
    std::array<Uv, 3> uvs{};
    for (std::size_t c = 0; c < 3; ++c) {
      const SoPrimitiveVertex& vertex = *vertices[c];
      triangle[c] = welder_.add(placed(vertex.getPoint()));
      SbColor ambient, diffuse, specular, emission;
      float shininess = 0;
      float transparency = 0;
      action.getMaterial(ambient, diffuse, specular, emission, shininess, transparency,
                         vertex.getMaterialIndex());
      colors[c] = rgb_of(diffuse[0], diffuse[1], diffuse[2]);
      const SbVec4f& uv = vertex.getTextureCoords();
      uvs[c] = {uv[0], uv[1]};
    }
    result_.mesh.triangles.push_back(triangle);
    if (image_ >= 0) {
      painter_.add_textured(image_, uvs, {kWhite, kWhite, kWhite});
    } else if (missing_) {
      painter_.add_plain(1, kNeutral);
    } else {
      painter_.add_corners(colors);
    }
  }

  Point placed(const SbVec3f& p) const {
    Point out{};
    for (std::size_t column = 0; column < 3; ++column) {
      out[column] = matrix_[3][column];
      for (int row = 0; row < 3; ++row) {
        out[column] += static_cast<double>(p[row]) * matrix_[static_cast<std::size_t>(row)][column];
      }
    }
    return out;
  }

  const std::string& path_;
  MeshFile result_;
  Painter painter_;
  PointWelder welder_;
  std::map<std::string, int> images_;  // by the first name; -1 is not there
  std::array<std::array<double, 4>, 4> matrix_{};
  bool mirrored_ = false;
  std::string broken_;
  int image_ = -1;  // of the shape being read
  bool missing_ = false;
  std::vector<std::pair<int, bool>> outer_;
};

// Coin opens what a scene names, if only to see whether it is there: relative names are looked for
// in its directories, of which it has none here, and absolute ones become relative.
void disarm_absolute_names(std::string& text) {
  std::string out;
  out.reserve(text.size());
  char before = ' ';
  for (const char c : text) {
    if (c == '/' && std::string_view(" \t\r\n\",[{").find(before) != std::string_view::npos)
      out += ':';
    out += c;
    before = c;
  }
  text = std::move(out);
}

}  // namespace

MeshFile read_wrl(InputFile& file, const std::string& path) {
  const std::string& name = file.name();
  if (!file.peek(5).starts_with("#VRML")) {
    throw Error(ErrorKind::kBadInput, name,
                "is no VRML text: it does not begin with \"#VRML\"; if it is packed, unpack it");
  }
  if (file.size() > (std::int64_t{1} << 30)) {
    throw Error(ErrorKind::kBadInput, name, "is over 1 GiB of VRML; simplify the model");
  }
  std::string text;
  text.reserve(static_cast<std::size_t>(file.size()));
  while (file.remaining() > 0) {
    const std::string_view piece = file.bytes(InputFile::kBuffer);
    if (piece.empty()) break;
    text.append(piece);
  }
  if (includes_files(text)) {
    throw Error(ErrorKind::kBadInput, name, "takes in other files; save the model as one file");
  }

  disarm_absolute_names(text);

  const std::lock_guard lock(coin_mutex);
  static const bool started = [] {
    SoDB::init();
    // Images are decoded later and elsewhere, and only from the model's own folder.
    SbImage::addReadImageCB(no_image, nullptr);
    SoVRMLInline::setFetchURLCallBack(no_fetch, nullptr);
    SoInput::clearDirectories();
    return true;
  }();
  (void)started;
  std::string fault;
  SoReadError::setHandlerCallback(keep_first_fault, &fault);
  SoDebugError::setHandlerCallback([](const SoError*, void*) {}, nullptr);
  SoInput input;
  input.setBuffer(text.data(), text.size());
  SoSeparator* root = SoDB::readAll(&input);
  SoReadError::setHandlerCallback([](const SoError*, void*) {}, nullptr);
  if (root == nullptr) {
    throw Error(ErrorKind::kBadInput, name,
                fmt::format("is no VRML that can be read ({}); export it again",
                            fault.empty() ? "no reason given" : fault));
  }
  root->ref();
  WrlReader reader(path);
  MeshFile result = reader.read(*root);
  root->unref();
  if (!reader.broken().empty()) {
    throw Error(ErrorKind::kBadInput, name, reader.broken() + "; export the model again");
  }
  if (!fault.empty()) result.warnings.push_back("was read with a fault: " + fault);
  return result;
}

}  // namespace binderjet
