// SPDX-License-Identifier: GPL-3.0-or-later
// Density: binder goes where powder is already wet, so massive neighbourhoods get more of it.
//
//   strength: the dose is multiplied by 1 + strength (share - reference), where share is the solid
//   share of the masks within radius_mm (a box in x, y and z)
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind density_kind();

}  // namespace binderjet
