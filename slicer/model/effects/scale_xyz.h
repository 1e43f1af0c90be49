// SPDX-License-Identifier: GPL-3.0-or-later
// Scale: the print shrinks or grows about the middle of the job.
//
//   by = [x, y]: relative, 0.01 is one per cent larger. (Along z a stack of layers shows nothing.)
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind scale_xyz_kind();

}  // namespace binderjet
