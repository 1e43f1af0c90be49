// SPDX-License-Identifier: GPL-3.0-or-later
// The files of the page that shows a job, as they stand beside this one.
#pragma once

namespace binderjet {

extern const char* const kViewerHtml;    // viewer.html
extern const char* const kViewerScript;  // viewer.js

}  // namespace binderjet
