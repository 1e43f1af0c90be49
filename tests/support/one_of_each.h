// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of effect that stands beside spread and threshold, for tests of all of them.
#pragma once

#include <vector>

#include "slicer/model/effects/effect.h"

namespace binderjet::whole {

// With numbers that show on a part of 3 x 2 mm.
inline std::vector<EffectSpec> one_of_each() {
  return {{"tail", {}, {{"share", {0.3}}, {"width_mm", {0.8, 1.2}}}},
          {"z_bleed_down", {}, {{"share", {0.4}}}},
          {"z_wick_up", {}, {{"share", {0.3}}}},
          {"density", {}, {{"strength", {0.5}}, {"radius_mm", {0.4}}, {"reference", {0.3}}}},
          {"shift", {}, {{"by_mm", {0.07, -0.13}}}},
          {"registration_drift", {}, {{"per_mm", {0.3, -0.2}}}},
          {"layer_shift_low", {}, {{"by_mm", {0.2, 0.1}}, {"height_mm", {0.3}}}},
          {"parity", {}, {{"by_mm", {0.11, 0.03}}}},
          {"scale_xyz", {}, {{"by", {0.05, -0.04}}}},
          {"grad_bed", {}, {{"per_mm", {0.05, -0.1}}, {"per_mm2", {0.02}}, {"center_mm", {1, 2}}}},
          {"grad_z", {}, {{"per_mm", {-0.2}}, {"from_mm", {0}}}},
          {"pause", {}, {{"at_mm", {0.25}}, {"amount", {0.3}}}},
          {"first_layers", {}, {{"amount", {0.5}}, {"height_mm", {0.2}}}},
          {"band_swath", {}, {{"direction_deg", {30}}, {"period_mm", {1.3}}, {"wave", {0.2, 0.1}}}},
          {"jet_out", {}, {{"from_mm", {0.8}}, {"to_mm", {1.2}}, {"amount", {-0.5}}}},
          {"recoat_streak",
           {{"across", "y"}},
           {{"from_mm", {5.8}}, {"to_mm", {6.2}}, {"at_mm", {0.2}}, {"amount", {-0.5}}}},
          {"first_drops", {{"after", "line"}}, {{"amount", {0.7}}, {"length_mm", {0.2}}}},
          {"first_drops", {{"after", "gap"}}, {{"amount", {0.4}}, {"length_mm", {0.5}}}},
          {"slice_dropout", {}, {{"at_mm", {0.2}}, {"layers", {1}}}},
          {"recoat_compress", {}, {{"share", {0.15}}}},
          {"empirical",
           {{"acts", "shift_x"}, {"axis", "y"}, {"form", "periodic"}},
           {{"period", {0.9}}, {"wave", {0.1, 0.05}}}},
          {"empirical",
           {{"acts", "dose"}, {"axis", "layer"}, {"form", "pulse"}},
           {{"period", {3}}, {"at", {1}}, {"width", {1}}, {"amount", {-0.4}}}},
          {"empirical",
           {{"acts", "dose"}, {"axis", "position"}, {"form", "local"}},
           {{"center_mm", {1.5, 1}}, {"at", {0}}, {"width", {0.5}}, {"amount", {0.4}}}}};
}

}  // namespace binderjet::whole
