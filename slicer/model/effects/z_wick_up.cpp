// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/z_wick_up.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

void add(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  for (DoseTerm term : std::vector<DoseTerm>(form.terms)) {
    term.layer -= 1;
    term.gain *= spec.number("share");
    form.terms.push_back(term);
  }
}

}  // namespace

EffectKind z_wick_up_kind() { return {"z_wick_up", {}, {{"share", 1, 0, 0.9}}, add}; }

}  // namespace binderjet
