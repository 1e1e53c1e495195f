#include "shade/triangle_setup.h"

#include <cmath>

#include "math/l1_norm.h"

namespace tenebra::shade {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr float least_normal = 1e-6f;  // L1 norm below which an interpolated normal has no direction

Plane scaled(double value, double dx, double dy, double factor) {
  return {static_cast<float>(value * factor), static_cast<float>(dx * factor),
          static_cast<float>(dy * factor)};
}

/// The plane of the triangle in view coordinates; needs a and the edges.
void set_planes(const dvec3& a, const dvec3& e1, const dvec3& e2, const dvec3& n, const ViewRays& view,
                TriangleSetup& out) {
  const double area2 = glm::dot(n, n), offset = glm::dot(n, a);
  const dvec3 du = glm::cross(e2, n) / area2, dv = glm::cross(n, e1) / area2;
  const dvec3 d0(view.d0), dx(view.dx), dy(view.dy);
  const dvec3 across = static_cast<double>(out.origin.x) * dx + static_cast<double>(out.origin.y) * dy;
  if (view.orthographic) {
    // t = n.(a - across) / n.d0, and u = du.(across + t d0 - a): linear in the place.
    const double speed = glm::dot(n, d0);
    const auto weight = [&](const dvec3& g) {
      const auto change = [&](const dvec3& step) {
        return glm::dot(g, step) - glm::dot(n, step) / speed * glm::dot(g, d0);
      };
      return scaled(glm::dot(g, across - a) + glm::dot(n, a - across) / speed * glm::dot(g, d0), change(dx),
                    change(dy), 1.0);
    };
    out.depth = {1.0f, 0.0f, 0.0f};
    out.u = weight(du);
    out.v = weight(dv);
    out.flat = !std::isfinite(1.0 / speed);
    return;
  }
  // 1 / t = n.d / n.a, and u / t = du.d - du.a / t: linear in the place; scaled to 1 / t = 1 at the origin.
  const dvec3 d = d0 + across;
  const double at_origin = glm::dot(n, d) / offset;
  out.flat = !(at_origin > 0) || !std::isfinite(1.0 / at_origin);
  if (out.flat) return;
  const auto weight = [&](const dvec3& g) {
    const auto along = [&](const dvec3& w) {
      return glm::dot(g, w) - glm::dot(g, a) * (glm::dot(n, w) / offset);
    };
    return scaled(along(d), along(dx), along(dy), 1.0 / at_origin);
  };
  out.depth = scaled(at_origin, glm::dot(n, dx) / offset, glm::dot(n, dy) / offset, 1.0 / at_origin);
  out.u = weight(du);
  out.v = weight(dv);
}

/// Whether all normals are on one side of `face`; zero is on any.
bool are_on_one_side(const std::array<vec3, 3>& normals, const vec3& face) {
  bool one = true, other = true;
  for (const vec3& n : normals) {
    const float along = glm::dot(n, face);
    if (n == vec3(0.0f)) continue;
    one &= along > 0, other &= along < 0;
  }
  return one || other;
}

void set_normals(const FrameGeometry& geometry, const glm::uvec3& t, TriangleSetup& out) {
  out.normal = out.face;
  if (geometry.normals.empty()) return;
  const vec3 n0 = geometry.normals[t.x], n1 = geometry.normals[t.y], n2 = geometry.normals[t.z];
  out.smooth = n0 != n1 || n0 != n2;
  if (out.smooth) {
    out.normal = n0;
    out.to_second = n1 - n0;
    out.to_third = n2 - n0;
    out.rounded = are_on_one_side({n0, n1, n2}, out.face);
  } else if (const float length = glm::length(n0); math::l1_norm(n0) > least_normal) {
    out.normal = n0 / (glm::dot(n0, out.face) < 0 ? -length : length);
  }
}

bool is_finite(const Plane& plane) {
  return std::isfinite(plane.value) && std::isfinite(plane.dx) && std::isfinite(plane.dy);
}

}  // namespace

TriangleSetup set_up(const FrameGeometry& geometry, const ViewRays& view, std::uint32_t id,
                     const glm::vec2& origin) {
  const glm::uvec3 t = geometry.triangles[id];
  // In double: the cross product of a sliver's floats would lose its direction.
  const dvec3 first(geometry.positions[t.x]), a = first - dvec3(view.eye);
  const dvec3 e1 = dvec3(geometry.positions[t.y]) - first, e2 = dvec3(geometry.positions[t.z]) - first;
  const dvec3 n = glm::cross(e1, e2);
  TriangleSetup out;
  out.id = id;
  out.origin = origin;
  out.in_perspective = !view.orthographic;
  out.a = a;
  out.e1 = e1;
  out.e2 = e2;
  const double area2 = glm::dot(n, n);
  if (area2 > 0 && std::isfinite(area2)) {
    const double away = view.orthographic ? glm::dot(n, dvec3(view.d0)) : glm::dot(n, a);
    out.face = n / (away > 0 ? -std::sqrt(area2) : std::sqrt(area2));
    set_planes(a, e1, e2, n, view, out);
  }
  out.flat = out.flat || !is_finite(out.depth) || !is_finite(out.u) || !is_finite(out.v);
  set_normals(geometry, t, out);
  return out;
}

const TriangleSetup& SetupCache::find(const FrameGeometry& geometry, const ViewRays& view, std::uint32_t id,
                                      const glm::vec2& place) {
  std::uint16_t& slot = slots_[id % size];
  if (slot == 0) {
    setups_.emplace_back();
    slot = static_cast<std::uint16_t>(setups_.size());
  }
  TriangleSetup& setup = setups_[slot - std::size_t{1}];
  // A first sample that just misses the triangle's plane makes its setup flat, but not those that follow.
  if (setup.id != id || setup.flat) setup = set_up(geometry, view, id, place);
  return setup;
}

}  // namespace tenebra::shade
