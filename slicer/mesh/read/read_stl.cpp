// SPDX-License-Identifier: GPL-3.0-or-later
// STL, binary and text: triangles without shared points, welded while they are read.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "slicer/base/error.h"
#include "slicer/mesh/boundary.h"
#include "slicer/mesh/read/readers.h"
#include "slicer/mesh/weld.h"

namespace binderjet {
namespace {

constexpr std::int64_t kHeader = 84;  // 80 bytes of anything, then the count
constexpr std::size_t kFacet = 50;    // normal, three corners, two attribute bytes

std::int64_t declared_facets(InputFile& file) {
  const std::string_view head = file.peek(static_cast<std::size_t>(kHeader));
  std::uint32_t count = 0;  // little-endian, as this program's machines are
  if (head.size() == kHeader) std::memcpy(&count, head.data() + 80, sizeof count);
  return count;
}

[[noreturn]] void refuse_coordinate(const std::string& where) {
  throw Error(ErrorKind::kBadInput, where,
              "has a coordinate that is no finite number; export the model again");
}

// The color in a facet's two attribute bytes, in the two dialects there are. Magics: the header
// says COLOR= and the part's color, bit 15 clear is a color of the facet's own, red lowest.
// VisCAM and SolidView: bit 15 set is a color, blue lowest.
class FacetColors {
 public:
  explicit FacetColors(std::string_view header) {
    const std::size_t word = header.substr(0, 80).find("COLOR=");
    if (word == header.npos || word + 10 > 80) return;
    Rgb color{};
    std::memcpy(color.data(), header.data() + word + 6, 3);
    part_ = color;
  }

  std::optional<Rgb> color(std::uint16_t bits) const {
    const bool flag = (bits & 0x8000) != 0;
    const Rgb low_first = {level(bits), level(bits >> 5), level(bits >> 10)};
    if (part_) return flag ? *part_ : low_first;
    if (!flag) return std::nullopt;
    return Rgb{low_first[2], low_first[1], low_first[0]};
  }
  const std::optional<Rgb>& part() const { return part_; }

 private:
  static std::uint8_t level(int bits) {
    return static_cast<std::uint8_t>(((bits & 31) * 255 + 15) / 31);
  }

  std::optional<Rgb> part_;
};

// Facets as a header of the Magics dialect declares them, all attribute bytes 0, are of the part's
// color: a writer that knows facet colors would not make the whole part black.
void paint_facets(const FacetColors& colors, const std::vector<std::uint16_t>& bits,
                  Painter& painter) {
  const bool all_zero = std::all_of(bits.begin(), bits.end(), [](auto b) { return b == 0; });
  if (all_zero) {
    painter.add_plain(bits.size(), colors.part());
    return;
  }
  for (const std::uint16_t b : bits) painter.add_plain(1, colors.color(b));
}

MeshFile read_binary(InputFile& file) {
  MeshFile result;
  const std::int64_t declared = declared_facets(file);
  const std::int64_t held = (file.size() - kHeader) / static_cast<std::int64_t>(kFacet);
  // Programs that stream their output leave the count at 0.
  const std::int64_t count = declared == 0 ? held : std::min(declared, held);
  if (declared != held) {
    result.warnings.push_back(fmt::format("its header declares {}, the file holds {}; read {}",
                                          counted(declared, "triangle", "triangles"), held, count));
  }
  if (file.peek(5) == "solid") {
    result.warnings.push_back("begins with \"solid\" as text does, but is binary; read as binary");
  }
  check_claim(file, file.name(), count, kFacet, "triangles");

  const FacetColors colors(file.bytes(static_cast<std::size_t>(kHeader)));
  std::vector<std::uint16_t> attributes;
  attributes.reserve(static_cast<std::size_t>(count));
  PointWelder welder;
  result.mesh.triangles.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    const std::string_view facet = file.bytes(kFacet);
    if (facet.size() < kFacet) {
      throw Error(ErrorKind::kBadInput, file.name(), "became shorter while it was read; try again");
    }
    std::array<float, 9> corners{};
    std::memcpy(corners.data(), facet.data() + 12, sizeof corners);
    Triangle triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      const Point point{corners[3 * c], corners[3 * c + 1], corners[3 * c + 2]};
      if (!std::isfinite(point[0] + point[1] + point[2])) {
        refuse_coordinate(fmt::format("{}: triangle {}", file.name(), i + 1));
      }
      triangle[c] = welder.add(point);
    }
    result.mesh.triangles.push_back(triangle);
    std::uint16_t bits = 0;
    std::memcpy(&bits, facet.data() + 48, sizeof bits);
    attributes.push_back(bits);
  }
  result.mesh.points = welder.take();
  Painter painter;
  paint_facets(colors, attributes, painter);
  result.paint = painter.take(result.mesh);
  // A file that was cut short lacks a part of the surface; a count that lies does not.
  if (count < declared && !is_closed(result.mesh)) {
    throw Error(ErrorKind::kBadInput, file.name(),
                fmt::format("declares {} triangles but is cut off after {}; export it again",
                            declared, count));
  }
  return result;
}

class TextReader {
 public:
  explicit TextReader(InputFile& file) : file_(file) {}

  MeshFile read() {
    std::string_view text;
    while (file_.line(text)) {
      Words words(text);
      while (take(words)) continue;
    }
    if (in_facet_) {
      throw Error(ErrorKind::kBadInput, file_.here(),
                  "the file ends inside a facet; export it again");
    }
    result_.mesh.points = welder_.take();
    if (!ended_) result_.warnings.push_back("ends without \"endsolid\"; read to its end");
    if (odd_normals_ > 0) {
      result_.warnings.push_back(counted(odd_normals_, "normal is", "normals are") +
                                 " no numbers; ignored");
    }
    if (polygons_ > 0) {
      result_.warnings.push_back(counted(polygons_, "facet has", "facets have") +
                                 " more than three corners; cut into triangles");
    }
    return std::move(result_);
  }

 private:
  // Takes one statement; false at the end of the line.
  bool take(Words& words) {
    std::string word(words.next());
    for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (word.empty()) return false;
    if (word == "vertex") {
      take_corner(words);
    } else if (word == "facet") {
      in_facet_ = true;
      ended_ = false;
    } else if (word == "normal") {
      take_normal(words);
    } else if (word == "endfacet") {
      finish_facet();
    } else if (word == "solid" || word == "endsolid") {
      ended_ = word == "endsolid";
      return false;  // the rest of the line is a name
    } else if (word != "outer" && word != "loop" && word != "endloop") {
      throw Error(
          ErrorKind::kBadInput, file_.here(),
          fmt::format("\"{}\" is no word of an STL file; export it again", word.substr(0, 40)));
    }
    return true;
  }

  void take_normal(Words& words) {
    // The corners' order says what is outside; the normal is only read past.
    double value = 0;
    bool odd = false;
    for (int i = 0; i < 3; ++i) odd |= !parse_number(words.next(), value) || std::isnan(value);
    odd_normals_ += odd ? 1 : 0;
  }

  void take_corner(Words& words) {
    Point point{};
    for (double& value : point) {
      const std::string_view word = words.next();
      if (!parse_number(word, value)) {
        throw Error(ErrorKind::kBadInput, file_.here(),
                    fmt::format("\"{}\" is no number; export the model again", word.substr(0, 40)));
      }
      if (!std::isfinite(value)) refuse_coordinate(file_.here());
    }
    corners_.push_back(welder_.add(point));
  }

  void finish_facet() {
    if (corners_.size() < 3) {
      throw Error(
          ErrorKind::kBadInput, file_.here(),
          fmt::format("the facet that ends here has {} instead of three; export the model "
                      "again",
                      counted(static_cast<std::int64_t>(corners_.size()), "corner", "corners")));
    }
    if (corners_.size() > 3) ++polygons_;
    add_polygon(result_.mesh, corners_);
    corners_.clear();
    in_facet_ = false;
  }

  InputFile& file_;
  MeshFile result_;
  PointWelder welder_;
  std::vector<int> corners_;
  bool in_facet_ = false;
  bool ended_ = false;
  std::int64_t odd_normals_ = 0;
  std::int64_t polygons_ = 0;
};

}  // namespace

MeshFile read_stl(InputFile& file) {
  // Only the length tells binary from text: many binary files begin with "solid".
  const std::int64_t length = kHeader + 50 * declared_facets(file);
  if (file.size() == length && file.size() > kHeader) return read_binary(file);
  std::string_view start = file.peek(4096);
  const bool is_text = start.find('\0') == start.npos && start.find("facet") != start.npos;
  if (start.starts_with("\xEF\xBB\xBF")) file.bytes(3);  // a byte order mark
  if (is_text) return TextReader(file).read();
  if (file.size() >= kHeader + static_cast<std::int64_t>(kFacet)) return read_binary(file);
  throw Error(ErrorKind::kBadInput, file.name(),
              "is no STL file: neither text with facets nor long enough for one binary triangle");
}

}  // namespace binderjet
