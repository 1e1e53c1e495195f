// The public entry of ambient occlusion: a scene and visible points in, one value per pixel out. No OpenGL.
// AoMode::field is after Gaitatzes, Chrysanthou and Papaioannou 2010, "Presampled Visibility for Ambient
// Occlusion".
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

/// Computes ambient occlusion. Keeps what it has made of one scene from frame to frame: fields, surface
/// samples and, by rays, the tree over casters that all stand still. So use one object for all frames of a
/// scene, and another for another scene.
class AmbientOcclusion {
public:
  AmbientOcclusion();
  AmbientOcclusion(AmbientOcclusion&&) noexcept;
  AmbientOcclusion& operator=(AmbientOcclusion&&) noexcept;
  ~AmbientOcclusion();

  /// Fills `out` with the share of the ambient light that reaches each point, one value per pixel: 1 open,
  /// 0 closed, 1 where no triangle is seen; never NaN. `normals`: one per pixel, unit, on the seen side.
  /// Points may be lifted (lift_visible_points): rays that look for other bodies start from the lifted point;
  /// how much a body hides itself is taken from the nearest place on the triangle.
  /// The bits are the same for any number of threads. Builds the fields and samples that the frame needs and
  /// that do not exist yet. Fails, with one sentence, if a setting is out of range, if the mode is `rays` in
  /// a build without a ray caster, and with "stopped" if `stop` was requested.
  Expected<void> compute(const Scene& scene, const FrameGeometry& geometry, const VisiblePoints& points,
                         std::span<const glm::vec3> normals, const AoConfig& config, std::vector<float>& out,
                         const AoProgress& progress = {}, const StopFlag* stop = nullptr);

  const AoStats& stats() const;                   ///< of the last call
  const FrameTimings& timings() const;            ///< of the last call: ao_build_ms, ao_ms
  const std::vector<std::string>& notes() const;  ///< on objects without a field; each sentence once

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tenebra
