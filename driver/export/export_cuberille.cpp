// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/export/export_cuberille.h"

#include <memory>

#include "slicer/stack/cuberille.h"

namespace binderjet {

GiveName export_cuberille(const MaskSource& job, const std::string& path, const Work& work) {
  const auto writer = std::make_shared<CuberilleWriter>(path, job.header->grid);
  Stage stage(work, "writing squares", job.size_px[2], "layers");
  for (int index = 0; index < job.size_px[2]; ++index) {
    writer->add(job.read(index));
    stage.advance();
  }
  writer->complete();
  return [writer] { writer->finish(); };
}

}  // namespace binderjet
