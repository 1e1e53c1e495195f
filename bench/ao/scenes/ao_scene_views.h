// The views of whole scenes that ambient occlusion is measured on, as each contestant gets them.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "bench/common/bench_frame.h"

namespace tenebra::bench {

/// A frame of a scene, and the frame before it: what moves has moved in between. Glass is opaque (its share
/// is taken by rays of its own, which an opponent would need likewise).
struct AoSceneView {
  std::string name;  ///< "robots 100"
  Scene scene;
  BenchFrame before, now;
  float reach_m = 0;  ///< where occlusion has fallen off to nothing
};

/// Of all views, in their order.
std::vector<std::string> ao_scene_names();

/// Null, with a sentence in `notes`, where the scene's files are missing. `size`: pixels each way. `walkers`:
/// objects of a crowd. `data`: as of BenchOptions.
Expected<std::unique_ptr<AoSceneView>> load_ao_scene(const std::string& name, int size, int walkers,
                                                     const std::filesystem::path& data,
                                                     std::vector<std::string>& notes);

/// The library's default: a twentieth of the diagonal of what is drawn when the first clip starts.
float default_reach(const Scene& scene);

}  // namespace tenebra::bench
