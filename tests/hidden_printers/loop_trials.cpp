// SPDX-License-Identifier: GPL-3.0-or-later
// binderjet_loop_trials [NAME [MODEL SCALE]]: the closed loop on every hidden printer whose name
// holds NAME, as a table: how far the second print is from the model that was wanted, with plain,
// paper and inverse masks for the calibrated profile. The part is the full coupon, or MODEL.
#include <fmt/format.h>

#include <string>

#include "slicer/coupon/coupon.h"
#include "slicer/mesh/read/read_mesh.h"
#include "slicer/mesh/repair.h"
#include "tests/hidden_printers/second_print.h"

namespace {

using namespace binderjet;
using namespace binderjet::hidden;

const MaskRules kRules{4, 4};
constexpr double kCouponScale = 0.6;

struct Tally {
  int printers = 0;
  int below_none = 0;
  int below_paper = 0;
};

void run(const Printer& printer, const Wanted& coupon, const Wanted& wanted, Tally& tally) {
  const Loop loop = close_loop(printer, coupon, wanted, declared(), kRules);
  std::string effects;
  for (const FoundEffect& effect : loop.found.effects) {
    effects += " " + effect.kind;
    if (!effect.named) effects += "(" + word(effect.covariate.axis) + ")";
  }
  const auto row = [](const PrintScore& score) {
    return fmt::format("{:.4f} {:3}/{:<3}/{:<2}", score.voxels.excess(), score.lost, score.fused,
                       score.spurious);
  };
  const PrintScore& none = loop.second.at("none");
  const PrintScore& paper = loop.second.at("paper");
  const PrintScore& inverse = loop.second.at("inverse");
  fmt::print("{:20} {:18}  {:18}  {:18} {}\n", printer.name, row(none), row(paper), row(inverse),
             effects.empty() ? " nothing" : effects);
  std::fflush(stdout);
  ++tally.printers;
  tally.below_none += inverse.voxels.excess() < none.voxels.excess() ? 1 : 0;
  tally.below_paper += inverse.voxels.excess() < paper.voxels.excess() ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  const Wanted full = scaled(coupon(CouponKind::kFull), kCouponScale);
  Wanted wanted = full;
  if (argc > 3) {
    MeshFile file = read_mesh(argv[2]);
    repair_mesh(file.mesh, argv[2]);
    wanted = scaled(std::move(file.mesh), std::stod(argv[3]) * file.unit_mm);
  }
  fmt::print("excess and lost/fused/spurious of the second print against the model\n");
  fmt::print("{:20} {:18}  {:18}  {:18}  found\n", "hidden printer", "none", "paper", "inverse");
  std::vector<Printer> printers{Printer{}};
  printers.front().name = "nothing hidden";
  for (const auto& set : {catalogue(1), nameless(), pairs()}) {
    printers.insert(printers.end(), set.begin(), set.end());
  }
  Tally tally;
  for (const Printer& printer : printers) {
    if (printer.name.find(name) != std::string::npos) run(printer, full, wanted, tally);
  }
  fmt::print("inverse is below none on {} and below paper on {} of {} printers\n", tally.below_none,
             tally.below_paper, tally.printers);
}
