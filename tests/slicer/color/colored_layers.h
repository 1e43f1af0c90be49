// SPDX-License-Identifier: GPL-3.0-or-later
// Colored layers of models that the tests paint themselves, as the program makes them.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "slicer/color/color.h"
#include "slicer/color/shell.h"
#include "slicer/color/skin.h"
#include "slicer/enhance/masks.h"
#include "slicer/mesh/mesh.h"
#include "tests/support/models.h"

namespace binderjet::colored {

inline Grid z450_grid() { return {{25.4 / 300, 25.4 / 450, 0.102}, {2, 2, 2}}; }

struct Layers {
  Grid grid;
  JobBox box;
  std::vector<RunLayer> masks;
  std::vector<Shared<VoxelLayer>> targets;
  std::vector<std::vector<std::byte>> bitmaps;

  Rgb at(int x, int y, int k) const {
    const std::size_t i =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(box.size_px[0]) +
             static_cast<std::size_t>(x));
    const std::vector<std::byte>& b = bitmaps[static_cast<std::size_t>(k)];
    return {std::to_integer<std::uint8_t>(b[i]), std::to_integer<std::uint8_t>(b[i + 1]),
            std::to_integer<std::uint8_t>(b[i + 2])};
  }
  bool mask(int x, int y, int k) const {
    return k >= 0 && k < box.size_px[2] && masks[static_cast<std::size_t>(k)].at(x, y);
  }
  bool on_boundary(int x, int y, int k) const {
    return mask(x, y, k) && !(mask(x - 1, y, k) && mask(x + 1, y, k) && mask(x, y - 1, k) &&
                              mask(x, y + 1, k) && mask(x, y, k - 1) && mask(x, y, k + 1));
  }
};

// `mesh` has its lower corner at (0, 0, 0). Without passes the masks are the plain target's.
inline Layers paint(const Mesh& mesh, const std::shared_ptr<const ColorField>& field,
                    int passes = 0, double depth_mm = 0.6, LayerRange range = {0, 0},
                    std::array<int, 2> margin_vx = {4, 4}) {
  Layers out;
  out.grid = z450_grid();
  const auto shared = std::make_shared<const Mesh>(mesh);
  EffectSpec spread;
  spread.kind = "spread";
  spread.words["shape"] = "box";
  spread.numbers["width_mm"] = {0.7, 0.3};
  EffectSpec threshold;
  threshold.kind = "threshold";
  threshold.numbers["level"] = {0.5};
  const auto model =
      std::make_shared<const PrinterModel>(std::vector<EffectSpec>{spread, threshold}, out.grid);
  out.box = job_box(bounding_box(mesh).max, out.grid, {0, 0},
                    passes > 0 ? model->reach().xy_vx : margin_vx);
  const int count = out.box.size_px[2];
  if (range.size() == 0) range = {0, count};
  const Shell shell(out.grid, out.box, depth_mm, field);
  const Pipeline<MaskLayer> masks =
      paper_masks(voxel_layers(shared, out.grid, out.box), out.grid, model, passes);
  struct Painted {
    std::vector<std::byte> bitmap;
    Shared<MaskLayer> masks;
  };
  const auto stream = skin(masks, out.grid, out.box, field)
                          .then("paint", LayerReach::both_sides(shell.reach()),
                                [&](int layer, const Window<SkinLayer>& window) {
                                  return Painted{shell.paint(layer, window), window.middle().masks};
                                })
                          .layers(range);
  while (stream->rest().size() > 0) {
    for (const auto& layer : stream->next(kBlockLayers)) {
      out.bitmaps.push_back(layer->bitmap);
      out.masks.push_back(layer->masks->mask);
      out.targets.push_back(layer->masks->target);
    }
  }
  return out;
}

// A scratch folder of its own for each test, gone with it.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "color-test-XXXXXX").string();
    path_ = mkdtemp(name.data()) == nullptr ? "" : name;
  }
  ~Folder() {
    std::error_code error;
    if (!path_.empty()) std::filesystem::remove_all(path_, error);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }

 private:
  std::string path_;
};

}  // namespace binderjet::colored
