// Masks of points lifted to smooth surfaces, by the definition in tenebra/hard_shadows.h.
#include <gtest/gtest.h>

#include "shadow/mask_case.h"
#include "support/round_bodies.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr int width = 96, height = 80;

/// A body with bumps over a floor, each triangle once more behind all of them, which casts nothing: the
/// oracle leaves out the triangle that a point lies on, so it is asked about that one's double.
RoundBody doubled(double bumps) {
  RoundBody body = round_body(10, 16, {0, 1.2, 0}, bumps);
  add_floor(body, 0, 6);
  const std::size_t count = body.triangles.size();
  for (std::size_t i = 0; i < count; ++i) body.triangles.push_back(body.triangles[i]);
  body.casts.insert(body.casts.end(), count, 0);
  return body;
}

/// What a view sees of the first of them.
VisiblePoints samples_of(const RoundBody& body, const ViewRays& view) {
  TriangleView single = body.flat();
  single.triangles = single.triangles.first(body.triangles.size() / 2);
  single.casts_shadow = {};
  return view_samples(single, view, width, height);
}

/// How far `p` is before the triangle's plane, on the eye's side, times |n|.
long double excess(const RoundBody& body, std::uint32_t id, const ViewRays& view, const dvec3& p) {
  using V = glm::vec<3, long double>;
  const glm::uvec3 t = body.triangles[id];
  const V a(body.positions[t.x]), n = glm::cross(V(body.positions[t.y]) - a, V(body.positions[t.z]) - a);
  const long double eye = view.orthographic ? -glm::dot(n, V(view.d0)) : glm::dot(n, V(view.eye) - a);
  return (eye < 0 ? -1 : 1) * glm::dot(n, V(p) - a);
}

bool is_before_a_vertex(const RoundBody& body, std::uint32_t id, const ViewRays& view,
                        const ShadowLight& light) {
  const glm::uvec3 t = body.triangles[id];
  for (int k = 0; k < 3; ++k) {
    dvec3 n(body.normals[t[k]]);
    const dvec3 a(body.positions[t[k]]);
    if (excess(body, id, view, a + n) < 0) n = -n;
    const dvec3 to = light.directional ? dvec3(light.to_light) : dvec3(light.position) - a;
    if (glm::dot(n, to) > 0) return true;
  }
  return false;
}

struct Counts {
  std::size_t beyond = 0, lit_beyond = 0, stopped_by_own = 0;
};

ShadowMask expected(const RoundBody& body, const VisiblePoints& points, const VisiblePoints& before,
                    const ViewRays& view, const ShadowLight& light, Counts& counts) {
  const auto own = static_cast<std::uint32_t>(body.triangles.size() / 2);
  const oracle::ExactShadow oracle(view, body.flat(), light, {});
  oracle::ExactMaskStats stats;
  ShadowMask mask(points.triangles.size(), 0);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const std::uint32_t id = points.triangles[i];
    if (id == no_triangle) continue;
    const dvec3 p = points.positions[i];
    bool active = oracle.active(p, id);
    if (!active && p != before.positions[i] && is_before_a_vertex(body, id, view, light)) {
      const glm::uvec3 t = body.triangles[id];
      const dvec3 a(body.positions[t.x]), b(body.positions[t.y]), c(body.positions[t.z]);
      const double theta = oracle::contact_height(a, b, c, 2 * oracle::vertex_rounding(a, b, c));
      const bool off = excess(body, id, view, p) > theta;
      const bool stopped = oracle.blocks(id, p, id + own, stats);
      const bool near = light.range_m == 0 || glm::length(p - dvec3(light.position)) <= light.range_m;
      active = off && !stopped && near;
      ++counts.beyond;
      counts.stopped_by_own += off && stopped;
    }
    if (active && oracle.blocker(p, id, stats) == no_triangle) {
      mask[i] = 255;
      counts.lit_beyond += !oracle.active(p, id);
    }
  }
  return mask;
}

TEST(LiftedPoints, HaveTheMaskOfTheDefinitionInAllVariants) {
  Counts counts;
  for (const double bumps : {0.0, 0.15}) {
    const RoundBody body = doubled(bumps);
    for (const bool orthographic : {false, true}) {
      ViewRays view = pinhole({1, 2.5, 5}, {0, 1, 0}, 0.7, width, height);
      if (orthographic) {
        view.eye = {-1.6f, 2.8f, 5};
        view.d0 = {0, 0, -1}, view.dx = {0.035f, 0, 0}, view.dy = {0, -0.035f, 0};
        view.orthographic = true;
      }
      const VisiblePoints ids = samples_of(body, view);
      VisiblePoints before, points, tiles;
      compute_visible_points(ids.triangles, width, height, view, body.flat(), before);
      compute_visible_points(ids.triangles, width, height, view, body.smooth(), points);
      compute_visible_points(ids.triangles, width, height, view, body.smooth(), tiles, PointLayout::tiles);
      for (const ShadowLight& light :
           {ShadowLight{.position = {6, 3, 1}}, ShadowLight{.position = {-2, 2.6f, -3}},
            ShadowLight{.directional = true, .to_light = {-1, 0.4f, -0.3f}},
            ShadowLight{.position = {3, 1.5f, 2}, .range_m = 3.2f}}) {
        const ShadowMask wanted = expected(body, points, before, view, light, counts);
        ShadowTracer tracer;
        ShadowMask mask;
        for (const Variant variant : all_variants) {
          tracer.trace_shadow_mask(seen_from(points, view), body.smooth(), light, {.variant = variant}, mask);
          EXPECT_EQ(mask, wanted) << variant_name(variant) << ' ' << bumps << ' ' << orthographic;
        }
        tracer.trace_shadow_mask(seen_from(tiles, view), body.smooth(), light, {}, mask);
        EXPECT_EQ(mask, wanted) << "tiles alone";
      }
    }
  }
  EXPECT_GT(counts.beyond, 1000u);
  EXPECT_GT(counts.lit_beyond, 300u);
  EXPECT_GT(counts.stopped_by_own, 100u);
}

// Everything that is not smooth-shaded keeps its bits: its points, and so its shadows.
TEST(LiftedPoints, FloorsKeepTheirMask) {
  const RoundBody body = doubled(0);
  const ViewRays view = pinhole({1, 2.5, 5}, {0, 1, 0}, 0.7, width, height);
  const VisiblePoints ids = samples_of(body, view);
  VisiblePoints flat, smooth;
  compute_visible_points(ids.triangles, width, height, view, body.flat(), flat);
  compute_visible_points(ids.triangles, width, height, view, body.smooth(), smooth);
  const auto floor = static_cast<std::uint32_t>(body.triangles.size() / 2 - 2);
  ShadowTracer tracer;
  ShadowMask one, other;
  const ShadowLight light{.position = {6, 3, 1}};
  tracer.trace_shadow_mask(seen_from(flat, view), body.flat(), light, {}, one);
  tracer.trace_shadow_mask(seen_from(smooth, view), body.smooth(), light, {}, other);
  std::size_t dark = 0, changed = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (flat.triangles[i] < floor || flat.triangles[i] == no_triangle) {
      changed += one[i] != other[i];
      continue;
    }
    EXPECT_EQ(one[i], other[i]) << i;
    dark += one[i] == 0;
  }
  EXPECT_GT(dark, 50u);
  EXPECT_GT(changed, 20u) << "the body's own terminator moves";
}

}  // namespace
}  // namespace tenebra::testing
