// SPDX-License-Identifier: GPL-3.0-or-later
// coupon --kind KIND -o FILE.stl: a test part that shows what a printer loses.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "driver/base/console.h"
#include "driver/verbs/verbs.h"
#include "slicer/coupon/coupon.h"

namespace binderjet {

void add_coupon_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("coupon", "make a test part that shows what is lost");
  auto kind = std::make_shared<std::string>(word(CouponKind::kSlots));
  auto out = std::make_shared<std::string>();
  verb->add_option("--kind", *kind, "slots, walls, full or golfball")
      ->check(CLI::IsMember(coupon_kinds()))
      ->capture_default_str();
  verb->add_option("-o,--output", *out, "the STL file to write")->required();
  verb->callback([kind, out, console = add_console_options(*verb)] {
    const Mesh mesh = coupon(coupon_kind(*kind).value());
    write_stl(mesh, *out);
    const Box box = bounding_box(mesh);
    console->result({{"out", *out}, {"triangles", mesh.triangles.size()}},
                    fmt::format("{}: {}, {} triangles, {:.1f} x {:.1f} x {:.1f} mm", *out, *kind,
                                mesh.triangles.size(), box.size(0), box.size(1), box.size(2)));
  });
}

}  // namespace binderjet
