// SPDX-License-Identifier: GPL-3.0-or-later
// PLY, text and binary of either byte order: a header that describes the numbers, then the numbers.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slicer/base/error.h"
#include "slicer/mesh/read/readers.h"

namespace binderjet {
namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

std::optional<Type> type_of(std::string_view word) {
  constexpr std::array<std::array<std::string_view, 2>, 8> kNames = {{{"char", "int8"},
                                                                      {"uchar", "uint8"},
                                                                      {"short", "int16"},
                                                                      {"ushort", "uint16"},
                                                                      {"int", "int32"},
                                                                      {"uint", "uint32"},
                                                                      {"float", "float32"},
                                                                      {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (word == kNames[i][0] || word == kNames[i][1]) return static_cast<Type>(i);
  }
  return std::nullopt;
}

std::size_t bytes_of(Type type) {
  constexpr std::array<std::size_t, 8> kBytes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

struct Property {
  std::string name;
  Type type = Type::kFloat;
  std::optional<Type> length;  // the type of a list's length; none: one number
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  PlyReader(InputFile& file, const std::string& path) : file_(file), path_(path) {}

  MeshFile read() {
    read_header();
    for (const Element& element : elements_) {
      for (std::int64_t i = 0; i < element.count; ++i) read_item(element, i);
    }
    result_.paint = painter_.take(result_.mesh);
    return std::move(result_);
  }

 private:
  [[noreturn]] void refuse_header() const {
    throw Error(ErrorKind::kBadInput, file_.here(),
                "is no line of a PLY header; export the model again");
  }

  void read_header() {
    std::string_view text;
    bool has_format = false;
    while (true) {
      if (!file_.line(text)) {
        throw Error(ErrorKind::kBadInput, file_.name(), "ends inside its header; export it again");
      }
      Words words(text);
      const std::string_view keyword = words.next();
      if (keyword == "end_header") break;
      if (keyword == "format") {
        const std::string_view format = words.next();
        is_text_ = format == "ascii";
        swap_ = format == "binary_big_endian";
        has_format = is_text_ || swap_ || format == "binary_little_endian";
      } else if (keyword == "element") {
        Element element;
        element.name = words.next();
        if (!parse_number(words.next(), element.count)) refuse_header();
        elements_.push_back(std::move(element));
        element_lines_.push_back(file_.here());
      } else if (keyword == "property") {
        take_property(words);
      } else if (keyword == "comment") {
        take_comment(words);
      } else if (keyword != "ply" && keyword != "obj_info" && !keyword.empty()) {
        refuse_header();
      }
    }
    if (!has_format) throw Error(ErrorKind::kBadInput, file_.name(), "declares no known format");
    check_header();
  }

  void take_property(Words& words) {
    if (elements_.empty()) refuse_header();
    Property property;
    std::string_view word = words.next();
    if (word == "list") {
      property.length = type_of(words.next());
      if (!property.length) refuse_header();
      word = words.next();
    }
    const std::optional<Type> type = type_of(word);
    if (!type) refuse_header();
    property.type = *type;
    property.name = words.next();
    elements_.back().properties.push_back(std::move(property));
  }

  // "comment TextureFile name" is how MeshLab names images.
  void take_comment(Words words) {
    if (words.next() != "TextureFile") return;
    std::string_view name = words.rest();
    while (name.starts_with(' ')) name.remove_prefix(1);
    const std::string found = file_beside(path_, std::string(name));
    if (found.empty()) {
      result_.warnings.push_back(
          fmt::format("its image \"{}\" is not in its folder; painted in neutral gray", name));
      image_of_.push_back(-1);
      return;
    }
    image_of_.push_back(static_cast<int>(painter_.textures().size()));
    painter_.textures().push_back({std::string(name), found, {}, {}});
  }

  // Which number of an item a property's value is: red, green, blue, or u, v.
  static int place_in(std::string_view name, std::span<const std::string_view> names) {
    if (name.starts_with("diffuse_")) name.remove_prefix(8);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (name == names[i]) return static_cast<int>(i);
    }
    return -1;
  }

  // A color's number as 0 to 1: whole numbers count up to the type's largest.
  static double share(Type type, double number) {
    switch (type) {
      case Type::kInt8:
      case Type::kUint8:
        return number / 255;
      case Type::kInt16:
      case Type::kUint16:
        return number / 65535;
      case Type::kInt32:
      case Type::kUint32:
        return number / 255;  // text files: an int that means a byte
      case Type::kFloat:
      case Type::kDouble:
        break;
    }
    return number;
  }

  void take_extra(const Property& property, std::int64_t index, double number) {
    constexpr std::array<std::string_view, 3> kColor = {"red", "green", "blue"};
    constexpr std::array<std::string_view, 3> kShort = {"r", "g", "b"};
    constexpr std::array<std::string_view, 2> kSt = {"s", "t"};
    constexpr std::array<std::string_view, 2> kUv = {"u", "v"};
    constexpr std::array<std::string_view, 2> kTextureUv = {"texture_u", "texture_v"};
    if (property.length) {
      if (property.name == "texcoord") item_uvs_.push_back(static_cast<float>(number));
      return;
    }
    if (property.name == "texnumber") item_image_ = static_cast<int>(number);
    int color = place_in(property.name, kColor);
    if (color < 0) color = place_in(property.name, kShort);
    if (color >= 0 && index == 0) {
      item_color_[static_cast<std::size_t>(color)] = share(property.type, number);
      color_seen_ |= 1 << color;
    }
    for (const auto& names : {kSt, kUv, kTextureUv}) {
      const int place = place_in(property.name, names);
      if (place >= 0) {
        item_uv_[static_cast<std::size_t>(place)] = static_cast<float>(number);
        uv_seen_ |= 1 << place;
      }
    }
  }

  void paint_point(const Point& point) {
    if (color_seen_ == 7 && std::isfinite(item_color_[0] + item_color_[1] + item_color_[2])) {
      painter_.add_sample(point, rgb_of(item_color_[0], item_color_[1], item_color_[2]));
    }
    if (uv_seen_ == 3) point_uvs_.push_back(item_uv_);
  }

  void paint_face() {
    const std::size_t triangles = corners_.size() < 3 ? 0 : corners_.size() - 2;
    std::optional<Rgb> color;
    if (color_seen_ == 7) color = rgb_of(item_color_[0], item_color_[1], item_color_[2]);
    std::vector<Uv> uvs;
    if (item_uvs_.size() == 2 * corners_.size()) {
      for (std::size_t i = 0; i < corners_.size(); ++i) {
        uvs.push_back({item_uvs_[2 * i], item_uvs_[2 * i + 1]});
      }
    } else if (!point_uvs_.empty()) {
      for (const int corner : corners_) {
        if (static_cast<std::size_t>(corner) < point_uvs_.size()) {
          uvs.push_back(point_uvs_[static_cast<std::size_t>(corner)]);
        }
      }
    }
    if (uvs.size() != corners_.size() || painter_.has_samples()) {
      painter_.add_plain(triangles, color);
      return;
    }
    const auto image = static_cast<std::size_t>(std::max(0, item_image_));
    const bool named = image < image_of_.size();
    const int index = named ? image_of_[image] : -1;
    const Rgb base = named && index < 0 ? kNeutral : index >= 0 ? kWhite : color.value_or(kWhite);
    for (std::size_t i = 2; i < corners_.size(); ++i) {
      painter_.add_textured(index, {uvs[0], uvs[i - 1], uvs[i]}, {base, base, base});
    }
  }

  void check_header() {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const Element& element = elements_[i];
      std::int64_t bytes = 0;
      for (const Property& property : element.properties) {
        // As text, a digit and what ends it.
        bytes += is_text_ ? 2
                          : static_cast<std::int64_t>(
                                bytes_of(property.length ? *property.length : property.type));
      }
      check_claim(file_, element_lines_[i], element.count, std::max<std::int64_t>(bytes, 1),
                  element.name == "vertex" ? "points" : element.name + " items");
      if (element.name == "vertex") {
        result_.mesh.points.reserve(static_cast<std::size_t>(element.count));
      } else if (element.name == "face") {
        result_.mesh.triangles.reserve(static_cast<std::size_t>(element.count));
      }
    }
  }

  void read_item(const Element& element, std::int64_t item) {
    const auto where = [&] {
      return is_text_ ? file_.here() : fmt::format("{}: {} {}", file_.name(), element.name, item);
    };
    Point point{};
    corners_.clear();
    item_uvs_.clear();
    color_seen_ = uv_seen_ = 0;
    item_image_ = 0;
    for (const Property& property : element.properties) {
      const bool is_corners =
          property.name.starts_with("vertex_ind") && element.name == "face" && property.length;
      std::int64_t count = 1;
      if (property.length) {
        count = static_cast<std::int64_t>(value(*property.length, where));
        if (count < 0 || count > file_.size()) {
          throw Error(
              ErrorKind::kBadInput, where(),
              fmt::format("declares a list of {}; the file is damaged, export it again", count));
        }
      }
      for (std::int64_t i = 0; i < count; ++i) {
        const double number = value(property.type, where);
        if (is_corners) {
          take_corner(number, where);
        } else if (element.name == "vertex" && property.name.size() == 1) {
          const int axis = property.name[0] - 'x';
          if (axis >= 0 && axis < 3) {
            point[static_cast<std::size_t>(axis)] = number;
          } else {
            take_extra(property, i, number);
          }
        } else {
          take_extra(property, i, number);
        }
      }
    }
    if (element.name == "vertex") {
      if (!std::isfinite(point[0] + point[1] + point[2])) {
        throw Error(ErrorKind::kBadInput, where(),
                    "has a coordinate that is no finite number; export the model again");
      }
      result_.mesh.points.push_back(point);
      paint_point(point);
    } else if (element.name == "face") {
      paint_face();
    }
    add_polygon(result_.mesh, corners_);
  }

  template <typename Where>
  void take_corner(double number, const Where& where) {
    const bool fits = number >= 0 && number < 2147483647.0 && number == std::floor(number);
    if (!fits) {
      throw Error(ErrorKind::kBadInput, where(),
                  fmt::format("names point {}; export the model again", number));
    }
    corners_.push_back(static_cast<int>(number));
  }

  // Every PLY number, up to 32-bit integers and doubles, is exact in a double.
  template <typename Where>
  double value(Type type, const Where& where) {
    if (is_text_) return text_value();
    const std::size_t size = bytes_of(type);
    const std::string_view raw = file_.bytes(size);
    if (raw.size() < size) {
      throw Error(ErrorKind::kBadInput, where(), "is cut off here; export the file again");
    }
    std::array<char, 8> b{};
    std::copy(raw.begin(), raw.end(), b.begin());
    if (swap_) std::reverse(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(size));
    switch (type) {
      case Type::kInt8:
        return decode<std::int8_t>(b);
      case Type::kUint8:
        return decode<std::uint8_t>(b);
      case Type::kInt16:
        return decode<std::int16_t>(b);
      case Type::kUint16:
        return decode<std::uint16_t>(b);
      case Type::kInt32:
        return decode<std::int32_t>(b);
      case Type::kUint32:
        return decode<std::uint32_t>(b);
      case Type::kFloat:
        return static_cast<double>(decode<float>(b));
      case Type::kDouble:
        break;
    }
    return decode<double>(b);
  }

  template <typename T>
  static T decode(const std::array<char, 8>& raw) {
    T result;
    std::memcpy(&result, raw.data(), sizeof result);
    return result;
  }

  double text_value() {
    std::string_view word = words_.next();
    while (word.empty()) {
      std::string_view text;
      if (!file_.line(text)) {
        throw Error(ErrorKind::kBadInput, file_.name(),
                    "ends before all that its header declares; export it again");
      }
      words_ = Words(text);
      word = words_.next();
    }
    double number = 0;
    if (!parse_number(word, number)) {
      throw Error(ErrorKind::kBadInput, file_.here(),
                  fmt::format("\"{}\" is no number; export the model again", word.substr(0, 40)));
    }
    return number;
  }

  InputFile& file_;
  const std::string& path_;
  MeshFile result_;
  Painter painter_;
  std::vector<int> image_of_;  // by the number that faces use; -1 is not there
  std::vector<Uv> point_uvs_;
  // Of the item being read:
  std::array<double, 3> item_color_{};
  Uv item_uv_{};
  std::vector<float> item_uvs_;
  int item_image_ = 0;
  int color_seen_ = 0;  // bits: which of red, green, blue were there
  int uv_seen_ = 0;
  std::vector<Element> elements_;
  std::vector<std::string> element_lines_;
  bool is_text_ = false;
  bool swap_ = false;
  Words words_{{}};
  std::vector<int> corners_;
};

}  // namespace

MeshFile read_ply(InputFile& file, const std::string& path) { return PlyReader(file, path).read(); }

}  // namespace binderjet
