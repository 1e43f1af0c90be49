// SPDX-License-Identifier: GPL-3.0-or-later
// The cuberille of a stack of masks (paper, 4.3): every face between a 1 and a 0 as a square.
//
// The paper had to take this detour, because the vendor's software took only meshes; it is here
// for comparison, and for printers that still demand a mesh.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"

namespace binderjet {

// Writes a binary PLY of quads, layer by layer; memory is two layers. Coordinates are millimeters
// from the job box's lower corner, as doubles.
class CuberilleWriter {
 public:
  CuberilleWriter(const std::string& path, const Grid& grid);
  ~CuberilleWriter();  // removes an unfinished file
  CuberilleWriter(const CuberilleWriter&) = delete;
  CuberilleWriter& operator=(const CuberilleWriter&) = delete;

  void add(const RunLayer& mask);  // the next layer up
  // Writes what is left; then only the file's name is missing.
  void complete();
  // Gives the file its name, complete() before that if need be.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace binderjet
