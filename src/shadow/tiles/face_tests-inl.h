// Boxes and triangles against nodes of rays on a face, sixteen at a time, in float; and what is done to them
// on a cube's face (of the distant one: distant_tests-inl.h). Conservative: what is rejected can block no ray
// of the node. u = 2^-24 below. Included once per target.
#if defined(TENEBRA_FACE_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_FACE_TESTS_INL_H_
#undef TENEBRA_FACE_TESTS_INL_H_
#else
#define TENEBRA_FACE_TESTS_INL_H_
#endif

#include "shadow/tiles/descent.h"
#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

constexpr float u = 0x1p-24f;
constexpr float off_the_face = 1e30f;  // beyond face_limit, and its products with anything sane are finite
constexpr float next_to_the_light = 1e-30f;

/// The face: its axes in the order u, v, z.
struct Face {
  int axes[3];
  float sign;  ///< of z along its axis
};
SIMD_INLINE Face face_axes(int face) {
  const int axis = face / 2;
  return {{(axis + 1) % 3, (axis + 2) % 3, axis}, face % 2 == 0 ? 1.0f : -1.0f};
}

/// Sixteen boxes on a face: u, v ranges and largest w. Each is off by at most 5u of its value.
struct FaceBoxes {
  Float16 u0, u1, v0, v1, w;
};

/// Bits of the boxes that meet `rays`; NaN counts as meeting.
SIMD_INLINE std::uint32_t boxes_met(const FaceBoxes& b, const FaceBox& rays) {
  const auto missed = lt(broadcast<Float16>(rays.u1), b.u0) | lt(b.u1, broadcast<Float16>(rays.u0)) |
                      lt(broadcast<Float16>(rays.v1), b.v0) | lt(b.v1, broadcast<Float16>(rays.v0)) |
                      lt(b.w, broadcast<Float16>(rays.w));
  return 0xffffu & ~bits(missed);
}

/// Bits of the node's children that a box meets and that have rays left.
SIMD_INLINE std::uint32_t children_met(const RayNode& n, const FaceBox& box) {
  const auto missed = lt(broadcast<Float16>(box.u1), load<Float16>(n.u0)) |
                      lt(load<Float16>(n.u1), broadcast<Float16>(box.u0)) |
                      lt(broadcast<Float16>(box.v1), load<Float16>(n.v0)) |
                      lt(load<Float16>(n.v1), broadcast<Float16>(box.v0)) |
                      lt(broadcast<Float16>(box.w), load<Float16>(n.w));
  return n.live & ~bits(missed);
}

/// Lower end of x/z for x >= low and z in (z0, z1], given 1/z0 and 1/z1; `pull` is off_the_face where z0 <=
/// 0.
SIMD_INLINE Float16 lower_end(Float16 low, Float16 near_inverse, Float16 far_inverse, Float16 pull) {
  return select_le(broadcast<Float16>(0.0f), low, low * far_inverse, low * near_inverse - pull);
}
SIMD_INLINE Float16 upper_end(Float16 high, Float16 near_inverse, Float16 far_inverse, Float16 pull) {
  return select_le(high, broadcast<Float16>(0.0f), high * far_inverse, high * near_inverse + pull);
}

/// World-space boxes on a face of the cube around `light`; returns the bits of those that reach in front of
/// it. Differences of floats are off by u, quotients and products by 4u more.
SIMD_INLINE std::uint32_t project_boxes(const BoxNode& node, const glm::vec3& light, const Face& face,
                                        FaceBoxes& out) {
  Float16 low[3], high[3];
  for (int k = 0; k < 3; ++k) {
    const int axis = face.axes[k];
    low[k] = load<Float16>(node.low[axis]) - broadcast<Float16>(light[axis]);
    high[k] = load<Float16>(node.high[axis]) - broadcast<Float16>(light[axis]);
  }
  const Float16 zero = broadcast<Float16>(0.0f);
  const Float16 z0 = face.sign > 0 ? low[2] : zero - high[2], z1 = face.sign > 0 ? high[2] : zero - low[2];
  const Float16 closest = broadcast<Float16>(next_to_the_light), one = broadcast<Float16>(1.0f);
  const Float16 near_inverse = one / max(z0, closest), far_inverse = one / z1;
  const Float16 pull = select_le(z0, closest, broadcast<Float16>(off_the_face), zero);
  out.u0 = lower_end(low[0], near_inverse, far_inverse, pull);
  out.u1 = upper_end(high[0], near_inverse, far_inverse, pull);
  out.v0 = lower_end(low[1], near_inverse, far_inverse, pull);
  out.v1 = upper_end(high[1], near_inverse, far_inverse, pull);
  out.w = near_inverse;
  return lt_bits(zero, z1);
}

/// Boxes of a cluster's triangles themselves: tighter than its box by far. Triangles that reach behind the
/// face's plane get `all`. Returns the bits of those that reach in front of it. Errors as project_boxes.
SIMD_INLINE std::uint32_t project_triangles(const TriangleCluster& c, const glm::vec3& light,
                                            const Face& face, const FaceBox& all, FaceBoxes& out) {
  const float(*const corners[3])[16] = {c.x, c.y, c.z};
  const Float16 one = broadcast<Float16>(1.0f), sign = broadcast<Float16>(face.sign);
  const Pack3<Float16> origin =
      broadcast3<Float16>(light[face.axes[0]], light[face.axes[1]], light[face.axes[2]]);
  Float16 z0, z1;
  for (int k = 0; k < 3; ++k) {
    const Float16 z = (load<Float16>(corners[face.axes[2]][k]) - origin.z) * sign;
    const Float16 w = one / z;
    const Float16 pu = (load<Float16>(corners[face.axes[0]][k]) - origin.x) * w,
                  pv = (load<Float16>(corners[face.axes[1]][k]) - origin.y) * w;
    z0 = k == 0 ? z : min(z0, z), z1 = k == 0 ? z : max(z1, z);
    out.u0 = k == 0 ? pu : min(out.u0, pu), out.u1 = k == 0 ? pu : max(out.u1, pu);
    out.v0 = k == 0 ? pv : min(out.v0, pv), out.v1 = k == 0 ? pv : max(out.v1, pv);
  }
  const Float16 closest = broadcast<Float16>(next_to_the_light);
  out.u0 = select_le(z0, closest, broadcast<Float16>(all.u0), out.u0);
  out.u1 = select_le(z0, closest, broadcast<Float16>(all.u1), out.u1);
  out.v0 = select_le(z0, closest, broadcast<Float16>(all.v0), out.v0);
  out.v1 = select_le(z0, closest, broadcast<Float16>(all.v1), out.v1);
  out.w = select_le(z0, closest, broadcast<Float16>(all.w), one / max(z0, closest));
  return c.used & lt_bits(broadcast<Float16>(0.0f), z1);
}

/// A cluster's triangles on a face. Plane k at the point (u, v, w) of a ray: m.(u, v, 1) - d w, the plane's
/// value over z. |p| / z <= 4.4 on a face of +-3, so rho (|p| + reach) becomes rho (4.4 + reach w); floats
/// and roundings add 5.1u (|mx| 3 + |my| 3 + |mz|) <= 23u for the edges, 28u and 6.1u d w for the own plane.
struct FaceCluster {
  alignas(64) float mx[4][16], my[4][16], mz[4][16];
  float edge_slack[16], own_slack[16];
  float d[16];            ///< rounded down
  float cover[16];        ///< d and the rays' own tolerance, rounded up
  float cover_slack[16];  ///< goes with `cover`
};

SIMD_INLINE void face_cluster(const ClusterPlanes& c, const Face& face, float tau, FaceCluster& out) {
  const float(*const m[3])[16] = {c.fx, c.fy, c.fz};
  for (int k = 0; k < 4; ++k) {
    store(load<Float16>(m[face.axes[0]][k]), out.mx[k]);
    store(load<Float16>(m[face.axes[1]][k]), out.my[k]);
    store(load<Float16>(m[face.axes[2]][k]) * broadcast<Float16>(face.sign), out.mz[k]);
  }
  const Float16 d = load<Float16>(c.fd[3]), rho = load<Float16>(c.rho), far = rho * load<Float16>(c.reach);
  store(mul_add(broadcast<Float16>(4.5f), rho, broadcast<Float16>(23 * u)), out.edge_slack);
  const Float16 own_slack = mul_add(broadcast<Float16>(4.5f), rho, broadcast<Float16>(28 * u));
  store(own_slack, out.own_slack), store(own_slack, out.cover_slack);
  store(d - abs(d) * broadcast<Float16>(8 * u) - far * broadcast<Float16>(1 + 8 * u), out.d);
  store((d + far + broadcast<Float16>(tau)) * broadcast<Float16>(1 + 16 * u), out.cover);
}

/// Bits of the triangles that may block rays of a box: its corner that is farthest inside each plane.
SIMD_INLINE std::uint32_t triangles_met(const FaceCluster& c, const FaceBox& box) {
  const auto most = [&](int k) HWY_ATTR {
    const Float16 mx = load<Float16>(c.mx[k]), my = load<Float16>(c.my[k]);
    return max(mx * broadcast<Float16>(box.u0), mx * broadcast<Float16>(box.u1)) +
           (max(my * broadcast<Float16>(box.v0), my * broadcast<Float16>(box.v1)) + load<Float16>(c.mz[k]));
  };
  const Float16 edges = min(most(0), min(most(1), most(2))) + load<Float16>(c.edge_slack);
  const Float16 own = most(3) + load<Float16>(c.own_slack);
  return 0xffffu &
         ~bits(lt(edges, broadcast<Float16>(0.0f)) | lt(own, load<Float16>(c.d) * broadcast<Float16>(box.w)));
}

/// Plane k of triangle i over the boxes of a node: its largest value.
SIMD_INLINE Float16 most(const RayNode& n, const FaceCluster& c, int k, int i) {
  const Float16 mx = broadcast<Float16>(c.mx[k][i]), my = broadcast<Float16>(c.my[k][i]);
  return max(mx * load<Float16>(n.u0), mx * load<Float16>(n.u1)) +
         (max(my * load<Float16>(n.v0), my * load<Float16>(n.v1)) + broadcast<Float16>(c.mz[k][i]));
}
/// Its smallest.
SIMD_INLINE Float16 fewest(const RayNode& n, const FaceCluster& c, int k, int i) {
  const Float16 mx = broadcast<Float16>(c.mx[k][i]), my = broadcast<Float16>(c.my[k][i]);
  return min(mx * load<Float16>(n.u0), mx * load<Float16>(n.u1)) +
         (min(my * load<Float16>(n.v0), my * load<Float16>(n.v1)) + broadcast<Float16>(c.mz[k][i]));
}

/// Bits of the node's children that triangle i, whose box is `box`, may block rays of.
SIMD_INLINE std::uint32_t children_met(const RayNode& n, const FaceCluster& c, int i, const FaceBox& box) {
  const std::uint32_t met = children_met(n, box);
  if (met == 0) return 0;
  const Float16 edges = min(most(n, c, 0, i), min(most(n, c, 1, i), most(n, c, 2, i)));
  const Float16 own = most(n, c, 3, i) + broadcast<Float16>(c.own_slack[i]);
  const auto missed = lt(edges, broadcast<Float16>(-c.edge_slack[i])) |
                      lt(own, broadcast<Float16>(c.d[i]) * load<Float16>(n.w));
  return met & ~bits(missed);
}

/// Bits of the node's children all of whose rays triangle i blocks for sure, but for its own.
SIMD_INLINE std::uint32_t children_covered(const RayNode& n, const FaceCluster& c, int i) {
  const Float16 edges = min(fewest(n, c, 0, i), min(fewest(n, c, 1, i), fewest(n, c, 2, i)));
  const Float16 own = fewest(n, c, 3, i) - broadcast<Float16>(c.cover_slack[i]);
  return bits(lt(broadcast<Float16>(c.edge_slack[i]), edges) &
              lt(broadcast<Float16>(c.cover[i]) * load<Float16>(n.w1), own));
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
