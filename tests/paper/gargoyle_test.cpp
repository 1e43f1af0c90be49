// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's Figs 6 to 8: the gargoyle at a small scale, ideal, plain and enhanced, as scores and
// as shaded pictures of the whole and of wing, ear and mouth.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>

#include "driver/job/parts.h"
#include "slicer/enhance/masks.h"
#include "slicer/model/printer_model.h"
#include "slicer/score/score.h"
#include "tests/paper/relief.h"
#include "tests/support/vector_stream.h"

namespace binderjet {
namespace {

constexpr double kScale = 0.15;

std::optional<std::string> gargoyle() {
  const char* given = std::getenv("BINDERJET_DATA");
  const std::filesystem::path data =
      given != nullptr ? std::filesystem::path(given)
                       : std::filesystem::path(BINDERJET_SOURCE_DIR) / "../shared/data";
  const std::filesystem::path file = data / "models/clean/gargoyle.obj";
  if (!std::filesystem::exists(file)) return std::nullopt;
  return file.string();
}

// What the program does with one part, in memory.
struct Print {
  std::vector<Shared<RunLayer>> layers;
  std::vector<Shared<VoxelLayer>> target;
};

class PaperGargoyle : public testing::Test {
 protected:
  void SetUp() override {
    const auto file = gargoyle();
    if (!file) GTEST_SKIP() << "no gargoyle here; see BINDERJET_DATA";
    Placement placement;
    placement.scale = kScale;
    mesh_ = std::make_shared<const Mesh>(load_part(*file, std::nullopt, placement).mesh);
  }

  Print printed(const PrinterModel& model, int passes, const JobBox& box) const {
    const auto shared = std::make_shared<const PrinterModel>(model);
    const auto masks =
        paper_masks(voxel_layers(mesh_, grid_, box), grid_, shared, passes).all_layers();
    Print out;
    while (masks->rest().size() > 0) {
      for (const auto& layer : masks->next(kBlockLayers)) {
        out.target.push_back(layer->target);
        out.layers.push_back(std::make_shared<const RunLayer>(model.print(layer->mask)));
      }
    }
    return out;
  }

  JobScore score(const Print& print) const {
    const LayerRange layers{0, static_cast<int>(print.layers.size())};
    const auto stream =
        score_layers(stream_of(print.target), stream_of(print.layers), grid_, layers);
    Scorer scorer(grid_, 0);
    while (stream->rest().size() > 0) {
      for (const auto& layer : stream->next(kBlockLayers)) scorer.add(*layer);
    }
    return scorer.finish();
  }
  static void tell(const std::string& name, const JobScore& sum) {
    std::cout << fmt::format("{:<22} {:.4f}   {:.4f}    {:.3f}     {:.3f}   {:5} {:6} {:9}\n", name,
                             sum.voxels.wrong(), sum.voxels.excess(), sum.edges.mean_mm(),
                             sum.edges.p95_mm(), sum.faults[FaultKind::kLost],
                             sum.faults[FaultKind::kFused], sum.faults[FaultKind::kSpurious]);
  }
  static void tell_head() {
    std::cout
        << "                       wrong    excess    epe mean  epe p95   lost  fused  spurious\n";
  }

  // Ideal, plain, once and twice enhanced; checks `wrong` against known figures and draws them.
  void compare(const PrinterModel& model, const std::string& name,
               const std::vector<double>& known_wrong) const {
    const PrinterModel ideal({{"threshold", {}, {{"level", {0.5}}}}}, grid_);
    std::cout << name << '\n';
    tell_head();
    const JobBox box = job_box(bounding_box(*mesh_).max, grid_, {0, 0}, model.reach().xy_vx);
    const Print perfect = printed(ideal, 0, box);
    tell("ideal", score(perfect));
    draw_reliefs(perfect.layers, grid_, name, "a_ideal");
    for (std::size_t passes = 0; passes < known_wrong.size(); ++passes) {
      const Print print = printed(model, static_cast<int>(passes), box);
      const JobScore sum = score(print);
      tell(passes == 0 ? "plain" : fmt::format("enhanced, {} passes", passes), sum);
      // Known to four digits from an independent implementation.
      EXPECT_NEAR(sum.voxels.floor(), 0.0131, 5e-5);
      EXPECT_NEAR(sum.voxels.wrong(), known_wrong[passes], 5e-5) << passes;
      draw_reliefs(print.layers, grid_, name, fmt::format("{}_{}_passes", "bcd"[passes], passes));
    }
  }

  Profile profile_ = load_profile("z450");
  Grid grid_ = profile_.grid(std::nullopt);
  std::shared_ptr<const Mesh> mesh_;
};

TEST_F(PaperGargoyle, IsNoBetterForTheRuleAtHalfWithSixteenByTenVoxels) {
  const PrinterModel model({{"spread",
                             {{"shape", "box"}},
                             {{"width_mm", {16 * grid_.voxel_mm(0), 10 * grid_.voxel_mm(1)}}}},
                            {"threshold", {}, {{"level", {0.5}}}}},
                           grid_);
  compare(model, "gargoyle_level_0.50", {0.0202, 0.0225, 0.0229});
}

TEST_F(PaperGargoyle, IsMuchBetterForTheRuleAtAQuarter) {
  const PrinterModel model({{"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.3}}}},
                            {"threshold", {}, {{"level", {0.25}}}}},
                           grid_);
  compare(model, "gargoyle_level_0.25", {0.1166, 0.0822, 0.0623});
}

}  // namespace
}  // namespace binderjet
