// The baked values: the light that arrives at places on a scene's surfaces, and their openness.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/queries.h>
#include "bake/baked_map.h"
#include "render/renderer.h"

namespace tenebra::bake {

struct LightRequest {
  /// Shadows, area lights, which light, occlusion (AoMode::none: everything is open), threads.
  render::RenderSettings settings;
  bool direct = true;       ///< light of the scene's lights
  glm::vec3 ambient{0.0f};  ///< ambient light, times the openness
};

/// Answers for samples of one instant of a scene, which must live as long. Shadows are exact for the samples'
/// places. A place is lit on the side that its shading normal is on; without normals on the side from which
/// its triangle is counter-clockwise. Samples of one target that follow each other share one openness.
class SurfaceLight {
public:
  /// Fails on lights that the scene does not have. `notes`: what a user should know, one sentence each.
  static Expected<SurfaceLight> create(const Scene& scene, const render::FrameInput& input,
                                       const LightRequest& request, std::vector<std::string>& notes);
  SurfaceLight(SurfaceLight&&) noexcept;
  SurfaceLight& operator=(SurfaceLight&&) noexcept;
  ~SurfaceLight();

  std::size_t lights() const;

  /// One value for each sample. The same bits for any number of threads and any instruction set. Fails with
  /// "stopped" soon after `stop` was requested. `progress`: 0 to 1.
  Expected<void> at(std::span<const Sample> samples, std::span<Light> out, const StopFlag* stop,
                    const QueryProgress& progress);

private:
  struct State;
  explicit SurfaceLight(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tenebra::bake
