// The public entry of ambient occlusion from displacement fields: objects and visible points in, one value a
// pixel out. No OpenGL.
// Gaitatzes, Chrysanthou and Papaioannou 2010, "Presampled Visibility for Ambient Occlusion".
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/expected.h"
#include "base/frame_timings.h"
#include "parallel/stop_flag.h"
#include "points/visible_points.h"
#include "scene/scene.h"
#include "simd/simd_level.h"

namespace tenebra {

enum class AoMode { none, field, rays };
enum class AoPlace { pixels, vertices };
enum class FieldLayout {
  positions_directions,  ///< the paper's: positions on the sphere x inward directions
  chords,                ///< entry x exit points
};

struct AoConfig {
  AoMode mode = AoMode::none;
  AoPlace place = AoPlace::pixels;
  FieldLayout layout = FieldLayout::chords;
  int rays = 64;  ///< a point, cosine-weighted
  int downscale =
      1;  ///< pixels: computed at one of so many squared, the rest blurred from those that resemble it
  double distance_m =
      0;  ///< where occlusion has fallen off to nothing; 0: a twentieth of the scene's diagonal
  int positions = 4225;   ///< samples on the bounding sphere, rounded to what the map offers
  int directions = 1024;  ///< inward directions a position, rounded to a square
  int bits = 8;           ///< of a stored distance: 1, 8 or 32
  bool deforming =
      true;  ///< objects that deform have no field: true: rays meet them as they are; false: left out
  std::filesystem::path cache;  ///< folder of built fields; empty: none is kept
  SimdLevel simd = SimdLevel::automatic;
};

/// Called now and then with 0..1 while something long is built.
using AoProgress = std::function<void(std::string_view what, double done)>;

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
