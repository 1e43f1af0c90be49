// SPDX-License-Identifier: GPL-3.0-or-later
// Steps in a row, from what opens the first layers to the layers that are asked for. Each step says
// its name and how far it looks; how many layers that takes from the step before it is computed
// here, backwards from the end, and nowhere else.
//
//   voxelize --> slice --> print --> rule      layers({5, 9}), that is 5 to 8, of a job of 20:
//            0         1         1             the rule asks for 4 to 9, the print for 3 to 10,
//                                              so 3 to 10 are voxelized
//
// Only a list of functions until layers() is called: then the streams are opened, and nothing is
// computed before somebody pulls.
#pragma once

#include <cassert>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <typeindex>
#include <utility>
#include <vector>

#include "slicer/base/work.h"
#include "slicer/layers/blocks.h"
#include "slicer/layers/step.h"
#include "slicer/layers/stream.h"

namespace binderjet {

// What a step says of itself.
struct StepInfo {
  std::string name;
  LayerReach reach;      // in layers, or in blocks of so many
  int block_layers = 0;  // 0: the step works layer by layer
  std::type_index from;  // the kind of layer it takes; void for what opens a pipeline
  std::type_index to;    // and makes
};

template <class T>
class Pipeline {
 public:
  // A stream of exactly these layers.
  using Open = std::function<std::unique_ptr<Stream<T>>(LayerRange)>;

  // Begins with what opens the layers of a range of `job`. `work` is asked before each layer of
  // each step that follows whether to go on.
  Pipeline(std::string name, LayerRange job, Open open, const Work& work = {})
      : Pipeline(job, std::move(open), {{std::move(name), {}, 0, typeid(void), typeid(T)}}, work) {}
  // Begins with a stream that is there already and holds all layers of `job`: layers() can be
  // called once.
  Pipeline(std::string name, LayerRange job, std::unique_ptr<Stream<T>> stream)
      : Pipeline(
            std::move(name), job,
            [stream = std::make_shared<std::unique_ptr<Stream<T>>>(std::move(stream))](LayerRange) {
              assert(*stream != nullptr);
              return std::move(*stream);
            }) {}

  // Appends a step: Out(k) = make(k, window), the window reaching so far and null beyond the job.
  template <class Make>
  auto then(std::string name, LayerReach reach, Make make) const {
    using Out = std::invoke_result_t<Make, int, const Window<T>&>;
    auto open = [before = open_, job = job_, reach, work = work_,
                 make = std::move(make)](LayerRange layers) -> std::unique_ptr<Stream<Out>> {
      return std::make_unique<Step<T, Out>>(before(grown(layers, reach, job)), layers, reach, job,
                                            [work, make](int layer, const Window<T>& window) {
                                              work.check();
                                              return make(layer, window);
                                            });
    };
    return Pipeline<Out>(job_, std::move(open),
                         with({std::move(name), reach, 0, typeid(T), typeid(Out)}), work_);
  }

  // Appends a step that changes blocks of layers: make(b, window) is block b, from the blocks
  // around it. The job must begin with layer 0.
  template <class Make>
  Pipeline then_in_blocks(std::string name, BlockForm form, LayerReach reach, Make make) const {
    assert(job_.first == 0);
    auto open = [before = open_, job = job_, form, reach, work = work_,
                 make = std::move(make)](LayerRange layers) -> std::unique_ptr<Stream<T>> {
      const LayerRange blocks = form.blocks_of(layers);
      const LayerRange all_blocks = form.blocks_of(job);
      auto taken = before(form.layers_of(grown(blocks, reach, all_blocks), job.last));
      auto changed = std::make_unique<Step<Block<T>, Block<T>>>(
          std::make_unique<ToBlocks<T>>(std::move(taken), form, job.last), blocks, reach,
          all_blocks, [work, make](int block, const Window<Block<T>>& window) {
            work.check();
            return make(block, window);
          });
      return std::make_unique<FromBlocks<T>>(std::move(changed), form, layers, job.last);
    };
    return Pipeline(job_, std::move(open),
                    with({std::move(name), reach, form.size, typeid(T), typeid(T)}), work_);
  }

  // The layers of `layers`, which lie in the job, as they are pulled.
  std::unique_ptr<Stream<T>> layers(LayerRange layers) const { return open_(layers); }
  std::unique_ptr<Stream<T>> all_layers() const { return open_(job_); }

  LayerRange job() const { return job_; }
  // From the first on.
  const std::vector<StepInfo>& steps() const { return steps_; }

 private:
  template <class Other>
  friend class Pipeline;

  Pipeline(LayerRange job, Open open, std::vector<StepInfo> steps, const Work& work)
      : job_(job), open_(std::move(open)), steps_(std::move(steps)), work_(work) {}

  std::vector<StepInfo> with(StepInfo step) const {
    std::vector<StepInfo> steps = steps_;
    steps.push_back(std::move(step));
    return steps;
  }

  LayerRange job_;
  Open open_;
  std::vector<StepInfo> steps_;
  Work work_;
};

}  // namespace binderjet
