// SPDX-License-Identifier: GPL-3.0-or-later
// STL, binary and text: triangles without shared points, welded while they are read.
#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <string>

#include "slicer/error.h"
#include "slicer/mesh/boundary.h"
#include "slicer/mesh/readers.h"
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

  file.bytes(static_cast<std::size_t>(kHeader));
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
  }
  result.mesh.points = welder.take();
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
