// Points and triangles of your own: hard masks, soft shadows and ambient occlusion of plain arrays, without a
// Scene, a camera or a picture. hard_shadows.h, soft_shadows.h and ambient_occlusion.h say what is computed
// and how exactly; this header passes them the triangles and points.
#pragma once

#include <tenebra/ambient_occlusion.h>
#include <tenebra/expected.h>
#include <tenebra/hard_shadows.h>
#include <tenebra/soft_shadows.h>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>

namespace tenebra {

namespace query {
struct GeometryData;
struct TracerState;
}  // namespace query

/// Triangles that are kept while points are asked about, copied from arrays of the caller's. Any number of
/// tracers, on any threads, may use one at once; call move_vertices() only while none does.
class Geometry {
public:
  /// `positions`: vertices, metres, world space, finite, |coordinate| <= 1e18. `triangles`: three indices
  /// each, counter-clockwise seen from the front; a triangle's id is its place in the list. `casts_shadow`:
  /// one for each triangle; empty: all cast. Fails with a sentence that names the first triangle or vertex
  /// that breaks a rule.
  static Expected<Geometry> create(std::span<const glm::vec3> positions,
                                   std::span<const glm::uvec3> triangles,
                                   std::span<const std::uint8_t> casts_shadow = {});
  /// The same from doubles, in map coordinates for instance: origin() is subtracted before they are rounded.
  static Expected<Geometry> create(std::span<const glm::dvec3> positions,
                                   std::span<const glm::uvec3> triangles,
                                   std::span<const std::uint8_t> casts_shadow = {});
  Geometry(Geometry&&) noexcept;
  Geometry& operator=(Geometry&&) noexcept;
  ~Geometry();

  /// The same triangles with other vertices, as many as before. Hard and soft shadows keep their trees and
  /// refit them; ambient occlusion makes its own anew. On failure nothing has changed.
  Expected<void> move_vertices(std::span<const glm::vec3> positions);
  Expected<void> move_vertices(std::span<const glm::dvec3> positions);

  /// What the vertices are relative to, in the caller's coordinates: whole numbers, chosen by create() from
  /// doubles, zero where floats are fine (rounding moves no coordinate by more than 2^-21 of the longest side
  /// of their bounds) and for positions that are given as floats. Points are in the caller's coordinates;
  /// lights with a place are relative to it: subtract it in double.
  glm::dvec3 origin() const;

  /// As the tracers of the other headers take them, relative to origin(); valid until the next change.
  TriangleView view() const;

private:
  friend class PointTracer;
  explicit Geometry(std::shared_ptr<query::GeometryData> data);
  std::shared_ptr<query::GeometryData> data_;
};

/// Points to ask about. Every span but `positions` may be empty; otherwise it has one element for each point.
struct QueryPoints {
  std::span<const glm::dvec3> positions;  ///< metres, in the coordinates of the geometry's vertices, finite;
                                          ///< taken as exact once its origin is subtracted
  /// The triangle that each point lies on, which never blocks it, or no_triangle. A point without a triangle
  /// counts as rounded to float where a triangle may touch it (contact_rule).
  std::span<const std::uint32_t> triangles;
  /// Normals of the lit surface, of any length; zero: none. For a point on a triangle they are for shading;
  /// for one without they say which half of space it sees. Without either a point sees all around.
  std::span<const glm::vec3> normals;
  /// The side of its triangle that a point is on: 1 where the triangle is counter-clockwise, -1 behind, 0 not
  /// given: the side of its normal or, without one, of the light (of an area light's centre; for ambient
  /// occlusion the front). Ignored for points without a triangle.
  std::span<const std::int8_t> sides;
  /// If not 0, the points are a picture with this many columns, row by row, whose neighbours lie close
  /// together, which is quicker. Masks do not depend on it.
  int width = 0;
};

/// Called now and then, on the caller's thread, with the part that is done, 0 to 1. For hard and soft shadows
/// it is called between portions of 2^18 points.
using QueryProgress = std::function<void(double done)>;

/// Answers for points. Keeps buffers and trees from call to call (docs/library.md): use one for many. One
/// caller at a time. Every answer has one value for each point. Calls fail with a sentence (a span of another
/// length, a triangle that is not there, a point that is not finite, a setting out of range), and with
/// "stopped" soon after `stop` was requested: docs/library.md has the times.
class PointTracer {
public:
  PointTracer();
  PointTracer(PointTracer&&) noexcept;
  PointTracer& operator=(PointTracer&&) noexcept;
  ~PointTracer();

  /// 255 where the point sees the light; 0 where it is blocked, on the other side of its triangle or beyond
  /// its normal's plane, or out of range. The same bytes as ShadowTracer's for the same points, and the same
  /// for any width, number of threads and instruction set.
  Expected<void> hard_mask(const Geometry& geometry, const QueryPoints& points, const ShadowLight& light,
                           const HardShadowConfig& config, std::span<std::uint8_t> mask,
                           const StopFlag* stop = nullptr, const QueryProgress& progress = {});

  /// hard_mask() for one light after the other: use(i, mask) gets that of lights[i], before the next is
  /// traced. Points, up to 2^18 of them, are prepared once for all lights but where a light changes the side
  /// that one is on. All lights are checked before the first call of use().
  Expected<void> hard_masks(const Geometry& geometry, const QueryPoints& points,
                            std::span<const ShadowLight> lights, const HardShadowConfig& config,
                            const std::function<void(std::size_t, std::span<const std::uint8_t>)>& use,
                            const StopFlag* stop = nullptr);

  /// The answers of SoftShadowTracer: the visible part of the light's area, 0 to 1, and the irradiance on a
  /// surface with the given normal (else the triangle's; with neither, parallel to the light), W/m2 for
  /// radiance 1. One of the two spans may be empty.
  Expected<void> soft_visibility(const Geometry& geometry, const QueryPoints& points, const AreaLight& light,
                                 const SoftShadowConfig& config, std::span<float> visible_fraction,
                                 std::span<float> irradiance, const StopFlag* stop = nullptr,
                                 const QueryProgress& progress = {});

  /// Openness, 1 open to 0 closed, by AoConfig::mode (`none` counts as `adaptive`, whose error is that of all
  /// the points together). Each point needs a triangle or a normal. distance_m 0: a twentieth of the
  /// geometry's diagonal.
  Expected<void> ambient_occlusion(const Geometry& geometry, const QueryPoints& points,
                                   const AoConfig& config, std::span<float> openness,
                                   const StopFlag* stop = nullptr, const QueryProgress& progress = {});

private:
  std::unique_ptr<query::TracerState> state_;
};

}  // namespace tenebra
