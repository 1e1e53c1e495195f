// The public entry of ambient occlusion from displacement fields: objects and visible points in, one value a
// pixel out. No OpenGL.
// Gaitatzes, Chrysanthou and Papaioannou 2010, "Presampled Visibility for Ambient Occlusion".
#pragma once

#include <tenebra/ao_config.h>
#include <tenebra/expected.h>
#include <tenebra/frame_timings.h>
#include <tenebra/scene.h>
#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tenebra {

/// Fields, baked self-occlusion and the cache of static surroundings of one scene, kept from frame to frame.
class AmbientOcclusion {
public:
  AmbientOcclusion();
  AmbientOcclusion(AmbientOcclusion&&) noexcept;
  AmbientOcclusion& operator=(AmbientOcclusion&&) noexcept;
  ~AmbientOcclusion();

  /// Ambient light that reaches each point: 1 open .. 0 closed, one a pixel; 1 where no triangle is seen.
  /// `normals`: one a pixel, unit, on the seen side. The same bits for any thread count; never NaN.
  /// Builds what the frame needs and lacks. Fails, with one sentence, on settings out of range, on `rays`
  /// in a build without a ray caster, and with "stopped" if `stop` was requested.
  Expected<void> compute(const Scene& scene, const FrameGeometry& geometry, const VisiblePoints& points,
                         std::span<const glm::vec3> normals, const AoConfig& config, std::vector<float>& out,
                         const AoProgress& progress = {}, const StopFlag* stop = nullptr);

  const AoStats& stats() const;                   ///< of the last call
  const FrameTimings& timings() const;            ///< of the last call: ao_build_ms, ao_ms
  const std::vector<std::string>& notes() const;  ///< sentences on objects without a field, new since create

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tenebra
