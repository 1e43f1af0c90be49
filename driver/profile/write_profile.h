// SPDX-License-Identifier: GPL-3.0-or-later
// A calibrated profile: the declared one's own text with other effects and where they come from.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "driver/profile/profile.h"
#include "slicer/model/effects/effect.h"

namespace binderjet {

// One line of a calibrated profile's provenance goes to `notes`, which stand as # lines above the
// effects. Everything but name, source and effects stays as it was, comments too. What is returned
// parses to exactly these effects (asserted by parsing it; Error{kBadInput} if the declared text
// spells its effects in a way that this cannot replace, such as an inline array).
std::string calibrated_profile(const Profile& declared, const std::string& name,
                               const std::string& source, std::span<const std::string> notes,
                               const std::vector<EffectSpec>& effects);

// What such a profile's file is called: "z450.calibrated.toml".
std::string calibrated_file_name(const Profile& declared);

}  // namespace binderjet
