// SPDX-License-Identifier: GPL-3.0-or-later
// What becomes of each file in the folder of nasty models: a closed mesh and a word, or an error.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "slicer/base/error.h"
#include "slicer/mesh/boundary.h"
#include "slicer/mesh/place.h"
#include "slicer/mesh/read/read_mesh.h"
#include "slicer/mesh/repair.h"

namespace binderjet {
namespace {

struct Outcome {
  bool prints;
  std::string word;  // in a warning, note or remark if it prints, else in the error
};

const std::map<std::string, Outcome> kTable = {
    {"20mmbox-CR.stl", {true, "end in CR alone"}},
    {"ADIS16480_metres.stl", {true, "--units m"}},
    {"OutOfMemory.off", {false, "declares 353535235358 points"}},
    {"admesh_block_nearby-bad.stl", {true, "closed 1 hole (4 edges"}},
    {"binary_count_too_large.stl", {true, "declares 66 triangles"}},
    {"binary_starts_with_solid.stl", {true, "read as binary"}},
    {"conrod.stl", {true, "turned 2167 faces against their neighbors"}},
    {"cube_binary_header_with_RN_newline.ply", {true, "lines end in different ways"}},
    {"degenerated.obj", {false, "encloses no volume"}},
    {"elephant-with-holes.off", {true, "closed 171 holes"}},
    {"empty_0_bytes.stl", {false, "is empty"}},
    {"featuretype_inch.3mf", {true, "closed 3 holes"}},
    {"fourVertices.ascii.stl", {true, "dropped 1 duplicate face"}},
    {"holed_cube_inch.3mf", {false, "does not fit the bed"}},
    {"huge_coordinates_Cray_right.obj", {false, "beyond any printer"}},
    {"inf_nan.obj", {false, "line 1: \"inf\" is no finite number"}},
    {"large_block_4572mm.stl", {false, "does not fit the bed"}},
    {"malformed.obj", {false, "line 28 (face 6): names point 0"}},
    {"many_small_holes.ply", {false, "is no closed surface: 556 of its edges are open"}},
    {"missingEndsolid.ascii.stl", {true, "without \"endsolid\""}},
    {"nancolor.obj", {true, "color that is no number"}},
    {"notANumberNormal.ascii.stl", {true, "normal"}},
    {"oblong-shuffled.off", {true, "turned 397 faces against their neighbors"}},
    {"self_intersectA.obj", {true, "goes through itself at 338 pairs"}},
    {"slic3r_4486_150m.stl", {false, "does not fit the bed"}},
    {"soup.stl", {false, "is no closed surface: 300 of its edges are open"}},
    {"t10k_138207_duplicate_faces.stl", {true, "dropped 104 duplicate faces"}},
    {"t10k_42722_holes_nonmanifold.stl", {true, "closed 2 holes"}},
    {"t10k_50736_holes_binsolid.stl", {true, "merged 68 nearly equal points"}},
    {"t10k_65778_fragmented.stl", {true, "10 pieces"}},
    {"t10k_679615_zero_area.stl", {true, "9 faces without area"}},
    {"t10k_68246_selfint.stl", {true, "1 face without area"}},
    {"t10k_68256_insideout.stl", {true, "turned the part inside in -> out"}},
    {"t10k_97171_holes_binsolid.stl", {true, "merged 10 nearly equal points"}},
    {"two-boxes-bad-self-union.ply", {true, "merged 26 nearly equal points"}},
};

std::filesystem::path data_folder() {
  const char* given = std::getenv("BINDERJET_DATA");
  return given != nullptr ? std::filesystem::path(given)
                          : std::filesystem::path(BINDERJET_SOURCE_DIR) / "../shared/data";
}

// All that is said about a file that prints; throws Error for one that does not.
std::string words_about(const std::string& path, bool& is_closed_now) {
  MeshFile file = read_mesh(path);
  const std::string where = std::filesystem::path(path).filename().string();
  const Repair repair = repair_mesh(file.mesh, where);
  is_closed_now = is_closed(file.mesh) && signed_volume(file.mesh) > 0;
  Placement placement;
  placement.unit_mm = file.unit_mm;
  const Bed bed{{203, 254, 204}, {25.4 / 300, 25.4 / 450}};
  BedRequest request{where, transform_part(file.mesh, placement, where), {}, file.unit_declared, 1};
  place_parts({request}, bed, 2);
  std::string words = doubtful_size(request);
  for (const auto& list : {file.warnings, repair.notes, repair.remarks}) {
    for (const std::string& word : list) words += "\n" + word;
  }
  return words;
}

TEST(Nasty, EveryFileEndsInAClosedMeshWithAWordOrInOneLine) {
  const std::filesystem::path folder = data_folder() / "models" / "nasty";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no folder of nasty models here";
  std::set<std::string> seen;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    SCOPED_TRACE(name);
    const auto start = std::chrono::steady_clock::now();
    bool prints = false;
    bool is_closed_now = false;
    std::string words;
    try {
      words = words_about(entry.path().string(), is_closed_now);
      prints = true;
      EXPECT_TRUE(is_closed_now);
    } catch (const Error& error) {
      words = error.what();
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_EQ(words.find('\n'), words.npos);
      EXPECT_EQ(words.find(name), 0u);  // an error begins with the place
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 10);
    // A file that the table does not know must only not crash.
    const auto expected = kTable.find(name);
    if (expected == kTable.end()) continue;
    seen.insert(name);
    EXPECT_EQ(prints, expected->second.prints) << words;
    EXPECT_NE(words.find(expected->second.word), words.npos) << words;
  }
  EXPECT_EQ(seen.size(), kTable.size());
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss, 1 << 20);  // KiB
}

TEST(Nasty, CleanModelsNeedNoRepair) {
  const std::filesystem::path folder = data_folder() / "models" / "clean";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no folder of clean models here";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().filename().string());
    MeshFile file = read_mesh(entry.path().string());
    const Mesh before = file.mesh;
    EXPECT_TRUE(repair_mesh(file.mesh, "x").notes.empty());
    EXPECT_EQ(file.mesh.points, before.points);
    EXPECT_EQ(file.mesh.triangles, before.triangles);
    EXPECT_GT(signed_volume(file.mesh), 0);
  }
}

}  // namespace
}  // namespace binderjet
