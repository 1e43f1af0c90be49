// SPDX-License-Identifier: GPL-3.0-or-later
// Weak jets: a row of the head gives less binder, along all of the fast axis.
//
//   from_mm, to_mm: the jets' place on the bed along y
//   amount: these jets give 1 + amount of their binder
//
// Binder spreads, so a row beyond the jets lacks what it would have got from them. The spread is
// that of the effects before this one in the model.
#pragma once

#include <functional>

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind jet_out_kind();

// The share of its binder that a place at y_mm gets from the jets in [from_mm, to_mm), where all
// around is printed.
std::function<double(double y_mm)> share_from_jets(const AssembledModel& form, const Grid& grid,
                                                   double from_mm, double to_mm);

}  // namespace binderjet
