// SPDX-License-Identifier: GPL-3.0-or-later
// Outputs that would replace each other, or what they are made from.
#pragma once

#include <string>
#include <vector>

namespace binderjet {

// Error{kUsage} if an output and another output, or an output and an input, are one place or one
// lies in the other: a folder is replaced with all that is in it. Links and ".." are followed.
void demand_apart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

}  // namespace binderjet
