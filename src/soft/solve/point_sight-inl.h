// What the solvers of single points share: how a point sees the unoccluded light, and the integrals over what
// it sees in the end. Included once per target.
#if defined(TENEBRA_SOFT_POINT_SIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_POINT_SIGHT_INL_H_
#undef TENEBRA_SOFT_POINT_SIGHT_INL_H_
#else
#define TENEBRA_SOFT_POINT_SIGHT_INL_H_
#endif

#include "points/smooth_surface.h"
#include "soft/polygon/light_fragments-inl.h"
#include "soft/polygon/receiver_plane-inl.h"
#include "soft/polygon/whole_light-inl.h"
#include "soft/solve/pixel_writer.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Whether part of the light is not above the line.
inline bool cuts(const LightFrame& light, const glm::dvec3& line) {
  for (const glm::dvec2& at : light.polygon) {
    if (!(line.x * at.x + line.y * at.y + line.z > 0)) return true;
  }
  return false;
}

template <class T>
double area_of(const FragmentList<T>& fragments) {
  double area = 0;
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    const StoredPolygon<T>& f = fragments[i];
    for (int k = 0; k < f.count; ++k) {
      const int next = k + 1 < f.count ? k + 1 : 0;
      area += (double(f.x[k]) * double(f.y[next]) - double(f.x[next]) * double(f.y[k])) / 2;
    }
  }
  return area;
}

/// The receiver at hand and the part of the light above its plane, the same for all its points. To points
/// lifted off the plane by more than the contact rule's tolerance all of the light is above, and the triangle
/// is one like the others: it has no id then.
template <class T>
struct ReceiverSight {
  ReceiverPlane plane;
  FragmentList<T> light;
  double above = 0;  ///< area of `light`

  void forget() { of_ = no_triangle; }
  void take_up(const SoftFrame& frame, std::uint32_t pixel) {
    const std::uint32_t receiver = frame.points.triangles[pixel];
    if (receiver == free_point) return start_on_free(frame, pixel);
    const bool stored = !frame.points.sides.empty();
    if (receiver != of_ || (stored && frame.points.sides[pixel] != side_))
      start_on(frame, receiver, visible_side(frame.points, frame.triangles, pixel));
    if (!lifts_) return;
    const double height = glm::dot(plane.face, frame.points.positions[pixel]) - plane.level;
    if (const bool lifted = height > 2 * plane.tau; lifted != is_lifted_) set_lifted(frame, lifted);
  }
  glm::dvec3 normal_at(const SoftFrame& frame, std::uint32_t pixel) const {
    return frame.normals.empty() ? plane.face : glm::dvec3(frame.normals[pixel]);
  }

private:
  HWY_NOINLINE void start_on(const SoftFrame& frame, std::uint32_t receiver, int side) {
    of_ = receiver, side_ = side;
    plane = receiver_plane(frame.light, frame.triangles, receiver, side);
    lifts_ = is_lifted_ = false;
    see_above(frame);
    lifts_ = plane.cuts_light && plane.face != glm::dvec3(0.0) &&
             points::smooth_surface(frame.triangles, receiver, side).lifts;
    below_ = plane.horizon;
  }
  HWY_NOINLINE void start_on_free(const SoftFrame& frame, std::uint32_t pixel) {
    of_ = free_point;
    lifts_ = is_lifted_ = false;
    plane = free_plane(frame.light, frame.triangles, frame.points.positions[pixel], frame.free_normal(pixel),
                       frame.sees_half(pixel));
    see_above(frame);
  }
  HWY_NOINLINE void set_lifted(const SoftFrame& frame, bool lifted) {
    is_lifted_ = lifted;
    plane.id = lifted ? no_triangle : of_;
    plane.horizon = lifted ? glm::dvec3(0, 0, 1) : below_;
    see_above(frame);
  }
  void see_above(const SoftFrame& frame) {
    light.clear();
    light.push(polygon_of<T>(frame.light.polygon));
    keep_positive(light, line_of<T>(plane.horizon), scratch_);
    plane.line = line_of<float>(plane.horizon);
    plane.cuts_light = cuts(frame.light, plane.horizon);
    above = plane.face == glm::dvec3(0.0) ? 0.0 : area_of(light);
  }

  FragmentList<T> scratch_;
  std::uint32_t of_ = no_triangle;
  int side_ = 0;
  bool lifts_ = false;      ///< points of it may be lifted, and the light sinks below its plane
  bool is_lifted_ = false;  ///< `plane` and `light` are for such points
  glm::dvec3 below_{0.0};   ///< the horizon of the others
};

/// A point and its horizons.
struct PointSight {
  std::uint32_t pixel = 0;
  Receiver3 at;
  double above = 0;  ///< area of the light above its receiver's plane; 0 from behind the light
  glm::dvec3 horizon{0.0};
  bool horizon_cuts = false;  ///< whether that of its shading normal cuts the light
};

template <class T>
PointSight sight_of(const SoftFrame& frame, const ReceiverSight<T>& receiver, std::uint32_t pixel) {
  const glm::dvec3 point = frame.points.positions[pixel];
  const glm::dvec3 way = frame.light.way_from(point);
  const bool in_front = glm::dot(way, frame.light.normal) < 0;
  PointSight sight;
  sight.pixel = pixel;
  sight.at = {way, receiver.normal_at(frame, pixel)};
  sight.above = in_front ? receiver.above : 0.0;
  sight.horizon = line_of_plane(frame.light, sight.at.normal, sight.at.to_origin);
  sight.horizon_cuts = cuts(frame.light, sight.horizon);
  return sight;
}

/// The visible part of the light for a point: convex fragments, and edges of the boundary of other parts.
template <class T>
struct VisibleLight {
  FragmentList<T> fragments, scratch;
  LightEdges edges;

  void clear() {
    fragments.clear();
    edges.count = 0;
  }

  /// Integrates over it. Where the horizon cuts the light, all of it must be fragments.
  HWY_NOINLINE void integrate(const SoftFrame& frame, const PointSight& sight, PixelWriter& writer) {
    append_edges(fragments, edges);
    EdgeSums sums = sum_edges(edges, frame.light, sight.at);
    const double area = sums.area;
    if (sight.horizon_cuts) {
      keep_positive(fragments, line_of<T>(sight.horizon), scratch);
      edges.count = 0;
      append_edges(fragments, edges);
      sums = sum_edges(edges, frame.light, sight.at);
    }
    writer.stats().fragments += fragments.size();
    writer.write(sight.pixel, area, sums.irradiance, sight.above);
  }
};

/// Writes the points put aside that see the whole light, and forgets them all; returns the bits of those
/// that see it.
inline std::uint32_t finish_whole(const SoftFrame& frame, WholePoints& whole, PixelWriter& writer) {
  if (whole.count == 0) return 0;
  double irradiance[8];
  const std::uint32_t seen = irradiance_of_whole(frame.light, whole, irradiance);
  for (std::size_t k = 0; k < whole.count; ++k)
    if ((seen >> k & 1u) != 0) writer.write_whole(whole.pixels[k], irradiance[k]);
  whole.count = 0;
  return seen;
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
