// The hashes of what Tenebra computes for the frames of a scene.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <tenebra/ambient_occlusion.h>
#include <tenebra/hard_shadows.h>
#include <tenebra/soft_shadows.h>
#include "bench/common/bench_frame.h"
#include "bench/hash/hash_frame.h"
#include "render/light_points.h"
#include "support/soft_precision.h"

namespace tenebra::bench {

struct HashItem {
  std::string what;  ///< "hard.0.Tiles"
  std::uint64_t hash = 0;
};

/// One scene at one setting. Buffers are kept from frame to frame, as in the renderer.
class SceneHasher {
public:
  SceneHasher(const Scene& scene, HashSetting setting) : scene_(scene), setting_(setting) {}

  Expected<std::vector<HashItem>> hash(const HashFrame& frame);

private:
  void see(const HashFrame& frame, HashPicture picture);
  void add(std::string what, std::uint64_t hash) { items_.push_back({std::move(what), hash}); }
  void add_points(const char* prefix);
  void hash_geometry(const HashFrame& frame);
  void hash_masks(const std::string& name, const ShadowLight& light, std::span<const Variant> traced);
  void hash_lights(const char* prefix, std::span<const Variant> traced);
  void hash_hard(const HashFrame& frame);
  Expected<AreaLight> area_light() const;
  Expected<void> hash_soft(const HashFrame& frame);
  Expected<void> hash_ambient(const HashFrame& frame);
  Expected<void> hash_all(const HashFrame& frame);

  const Scene& scene_;
  HashSetting setting_;
  BenchFrame frame_;
  std::vector<HashItem> items_;
  ShadowTracer hard_;
  ShadowMask mask_;
  SoftShadowTracer soft_, precise_soft_{soft::precise_solvers};
  render::LightPointShadows light_points_;
  SoftMask soft_mask_;
  AmbientOcclusion ambient_;
  std::vector<float> open_;
};

}  // namespace tenebra::bench
