// SPDX-License-Identifier: GPL-3.0-or-later
// A job's masks as a ZIP of pictures that programs for resin printers open.
//
// UVtools reads 1.png, 2.png ... without leading zeros and, if it is there, manifest.uvtools for
// pitch and size (its GenericZIPFile). NanoDLP reads the same names, asks for 8-bit sRGB, and shows
// what meta.json says of the program (its manual, "NanoDLP / ZIP File Format").
#pragma once

#include <string>

#include "driver/base/give_name.h"
#include "driver/job/mask_source.h"
#include "slicer/base/work.h"

namespace binderjet {

// White is binder; a picture's first row is the back of the bed. Writes the archive layer by layer,
// and returns what gives it its name.
[[nodiscard]] GiveName export_zip(const MaskSource& job, const std::string& path, bool full_bed,
                                  const Work& work);

}  // namespace binderjet
