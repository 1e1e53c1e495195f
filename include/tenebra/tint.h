// The public entry of coloured shadows: how much of a light see-through surfaces (glass, alpha blending) let
// pass, in addition to the masks, which count opaque casters alone. Nothing refracts. No OpenGL.
#pragma once

#include <tenebra/area_light.h>
#include <tenebra/hard_config.h>
#include <tenebra/scene.h>
#include <tenebra/soft_config.h>
#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace tenebra {

/// What see-through surfaces do to light.
enum class SeeThrough {
  tint,   ///< each lets its transmittance pass
  cast,   ///< they cast shadows as if they were opaque
  ignore  ///< they cast no shadow at all
};
std::string_view see_through_name(SeeThrough see_through);  ///< "tint", "cast", "ignore"
/// The choice of that name; none if there is no such name.
std::optional<SeeThrough> see_through_from_name(std::string_view name);

/// Makes the see-through triangles of an instant cast as `see_through` says (evaluate_frame: tint).
void cast_see_through(SeeThrough see_through, FrameGeometry& geometry);

/// The see-through triangles of a TriangleView and their materials. Lists of vertices and triangles are
/// as long as the TriangleView's, or empty.
struct SeeThroughSurfaces {
  const Scene* scene = nullptr;               ///< its materials and images
  std::span<const std::uint8_t> see_through;  ///< for each triangle; 1: it lets light pass. Others cast as
                                              ///< TriangleView::casts_shadow says. Empty: there is none.
  std::span<const std::uint32_t> materials;   ///< for each triangle
  std::array<std::span<const glm::vec2>, 2> texture_coordinates;  ///< for each vertex
  std::span<const glm::vec4> colors;                              ///< for each vertex
};
/// The surfaces of one instant: views into the arguments, which must live as long.
SeeThroughSurfaces see_through_surfaces(const Scene& scene, const FrameGeometry& geometry,
                                        const SurfaceCoordinates& coordinates);

/// The light of some pixels, coloured on its way: the mask times `factors`. Pixels that are not listed have
/// factor 1. Each pixel is listed once, in an order that does not depend on threads.
struct TintMask {
  std::vector<std::uint32_t> pixels;  ///< places in the lists of VisiblePoints
  std::vector<glm::vec3> factors;     ///< 0 to 1, red, green and blue; one for each of `pixels`
};

/// How tint is computed.
struct TintConfig {
  ContactRule contact = ContactRule::triangle_ids;  ///< hard: the mask's
  SimdLevel simd = SimdLevel::automatic;            ///< factors do not depend on it
  bool own_irradiance = false;  ///< soft: the mask's irradiance is an estimate; find it again, exactly
  double error_255 =
      0;  ///< soft: error of the irradiance that is allowed, 1/255 of white; 0: as small as it gets
  bool same_surfaces = false;  ///< triangles and surfaces are those of the last call and have not moved
};

/// The work of the last call.
struct TintStats {
  std::uint64_t triangles = 0;  ///< see-through triangles that let light pass
  std::uint64_t tests = 0;      ///< hard: tests of a tile of 16 samples with a triangle; soft: shadows tested
  std::uint64_t crossings = 0;  ///< hard: samples times see-through triangles between them and the light
  std::uint64_t exact = 0;      ///< hard: tests that double left open
  std::uint64_t numeric = 0;    ///< soft: points answered by places of the light
  double ms = 0;                ///< wall-clock time
};

/// Finds how much light see-through surfaces let pass. Keeps its buffers from frame to frame.
class TintTracer {
public:
  TintTracer();
  TintTracer(TintTracer&&) noexcept;
  TintTracer& operator=(TintTracer&&) noexcept;
  ~TintTracer();

  /// A light without an area. For each pixel whose `mask` (ShadowTracer's, of the same light) is not 0: the
  /// product of the transmittances, at the crossing, of all see-through triangles that the way from the
  /// sample to the light crosses, by channel; transmittances are multiplied in the order of their size, so
  /// that neither the triangles' order nor threads nor instruction sets change a bit.
  ///
  /// A triangle is crossed iff it would block by the rule of ShadowTracer::trace_shadow_mask, with one
  /// change: where the ray meets an edge or a vertex exactly (sign 0), it counts as moved from P by (e, e^2,
  /// e^3) for an infinitely small e. So of the triangles that share an edge or a vertex a ray crosses as many
  /// as a ray beside it: through a pane one, in and out of a closed body two. All signs are of real numbers;
  /// transmittances are float, at the crossing found in double. Returns false, with `out` unspecified, if
  /// `stop` was requested before the end.
  bool trace(const VisiblePoints& points, const TriangleView& triangles, const SeeThroughSurfaces& surfaces,
             const ShadowLight& light, const ShadowMask& mask, const TintConfig& config, TintMask& out,
             const StopFlag* stop = nullptr);

  /// An area light. For each pixel whose `mask` (SoftShadowTracer's, of the same light and normals) has
  /// irradiance: the share of that irradiance that passes, by channel: the product of the transmittances
  /// integrated over the light's visible part with the same weight. See-through triangles cast by the rule of
  /// SoftShadowTracer::trace.
  ///
  /// Up to 24 triangles of constant transmittance before a point: the visible part is cut along their shadows
  /// and each piece is integrated exactly, in float. More of them, or textures
  /// and vertex colours that vary: 4,096 places of the light, one in each cell of a 64 x 64 grid around it
  /// (docs/see_through.md says how exact that is), or fewer where config.error_255 allows it.
  ///
  /// The bits are the same for any number of threads. Returns false, with `out` unspecified, if `stop` was
  /// requested before the end.
  bool trace(const VisiblePoints& points, std::span<const glm::vec3> normals, const TriangleView& triangles,
             const SeeThroughSurfaces& surfaces, const AreaLight& light, const SoftMask& mask,
             const TintConfig& config, TintMask& out, const StopFlag* stop = nullptr);

  const TintStats& stats() const;  ///< of the last call

private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tenebra
