// SPDX-License-Identifier: GPL-3.0-or-later
// Effects of the catalogue that depend on the place on the bed.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "slicer/calibrate/candidates/candidate_list.h"
#include "slicer/model/effects/jet_out.h"
#include "slicer/model/printer_model.h"

namespace binderjet {
namespace {

using Basis = Column::Basis;
using Coefficients = std::span<const double>;

void add_bed_effects(CandidateList& list) {
  const std::array<double, 2> center{list.job().place.center_mm(0), list.job().place.center_mm(1)};
  const Column x{Basis::kDose, [center](const Spot& s) { return s.x_mm - center[0]; }, {}, 1};
  const Column y{Basis::kDose, [center](const Spot& s) { return s.y_mm - center[1]; }, {}, 1};
  const Column bowl{Basis::kDose,
                    [center](const Spot& s) {
                      const double dx = s.x_mm - center[0];
                      const double dy = s.y_mm - center[1];
                      return dx * dx + dy * dy;
                    },
                    {},
                    1};
  const Column all{Basis::kDose, {}, {}, 1};
  const auto effect = [model = list.model(), center](double per_x, double per_y, double per2,
                                                     double gain) {
    const double g = 1 + gain;
    return with_effect(with_level_gain(model, gain), {"grad_bed",
                                                      {},
                                                      {{"per_mm", {per_x / g, per_y / g}},
                                                       {"per_mm2", {per2 / g}},
                                                       {"center_mm", {center[0], center[1]}}}});
  };
  list.add("grad_bed", {"x", "trend", {}}, {x, all}, kAlongX,
           [effect](Coefficients c) { return effect(c[0], 0, 0, c[1]); });
  list.add("grad_bed", {"y", "trend", {}}, {y, all}, kAlongY,
           [effect](Coefficients c) { return effect(0, c[0], 0, c[1]); });
  list.add("grad_bed", {"position", "trend", {}}, {x, y, all}, kAlongX | kAlongY,
           [effect](Coefficients c) { return effect(c[0], c[1], 0, c[2]); });
  list.add("grad_bed", {"position", "local", {}}, {bowl, x, y, all}, kAlongX | kAlongY,
           [effect](Coefficients c) { return effect(c[1], c[2], c[0], c[3]); });
}

void add_bands(CandidateList& list) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    constexpr double kShortestMm = 0.9;
    for (const double f : frequencies(list.job().place.size_mm[axis], kShortestMm)) {
      const double turn = 2 * std::numbers::pi * f;
      const auto along = [axis](const Spot& s) { return axis == 0 ? s.x_mm : s.y_mm; };
      const double period = 1 / f;
      list.add("band_swath", {axis == 0 ? "x" : "y", "periodic", {{"period_mm", {period}}}},
               {{Basis::kDose, [=](const Spot& s) { return std::cos(turn * along(s)); }, {}, 1},
                {Basis::kDose, [=](const Spot& s) { return std::sin(turn * along(s)); }, {}, 1}},
               axis == 0 ? kAlongX : kAlongY, [model = list.model(), axis, period](Coefficients c) {
                 return with_effect(model, {"band_swath",
                                            {},
                                            {{"direction_deg", {axis == 0 ? 0.0 : 90.0}},
                                             {"period_mm", {period}},
                                             {"wave", {c[0], c[1]}}}});
               });
    }
  }
}

void add_jets(CandidateList& list) {
  const MeasuredJob& job = list.job();
  const AssembledModel form = PrinterModel(list.model(), job.grid, job.place).form();
  const double pixel = job.grid.pitch_mm[1];
  const double end = job.place.origin_mm[1] + job.place.size_mm[1];
  for (const int width_px : {1, 2, 4, 8, 16, 24}) {
    const double width = width_px * pixel;
    const double step = std::max(1, width_px / 4) * pixel;
    for (double from = job.place.origin_mm[1]; from + width <= end; from += step) {
      const double to = from + width;
      list.add("jet_out", {"y", "window", {{"from_mm", {from}}, {"to_mm", {to}}}},
               {{Basis::kDose,
                 [share = share_from_jets(form, job.grid, from, to)](const Spot& s) {
                   return share(s.y_mm);
                 },
                 {},
                 1}},
               kAlongY, [model = list.model(), from, to](Coefficients c) {
                 return with_effect(model, {"jet_out",
                                            {},
                                            {{"from_mm", {from}},
                                             {"to_mm", {to}},
                                             {"amount", {std::clamp(c[0], -0.99, 1.9)}}}});
               });
    }
  }
}

void add_streaks(CandidateList& list) {
  const MeasuredJob& job = list.job();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string across = axis == 0 ? "x" : "y";
    const double end = job.place.origin_mm[axis] + job.place.size_mm[axis];
    for (const double width : {0.3, 0.6, 1.2}) {
      for (double from = job.place.origin_mm[axis]; from + width <= end; from += width / 2) {
        // Where a streak begins is found to a layer by the fit.
        for (int fifth = 1; fifth < 5; ++fifth) {
          const double to = from + width;
          const int layer = job.first_layer + fifth * job.layers() / 5;
          const double at = layer * job.grid.pitch_mm[2];
          list.add("recoat_streak", {across, "window", {{"from_mm", {from}}, {"to_mm", {to}}}},
                   {{Basis::kDose,
                     [axis, from, to, at](const Spot& s) {
                       const double place = axis == 0 ? s.x_mm : s.y_mm;
                       return place >= from && place < to && s.z_mm >= at ? 1.0 : 0.0;
                     },
                     {},
                     1}},
                   (axis == 0 ? kAlongX : kAlongY) | kAlongZ,
                   [model = list.model(), across, from, to, at](Coefficients c) {
                     return with_effect(model, {"recoat_streak",
                                                {{"across", across}},
                                                {{"from_mm", {from}},
                                                 {"to_mm", {to}},
                                                 {"at_mm", {at}},
                                                 {"amount", {std::clamp(c[0], -0.99, 1.9)}}}});
                   });
        }
      }
    }
  }
}

}  // namespace

void add_bed_candidates(CandidateList& list) {
  add_bed_effects(list);
  add_bands(list);
  add_jets(list);
  add_streaks(list);
}

}  // namespace binderjet
