#include "visibility/setup_kernels.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/setup_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "simd/dispatch.h"
#include "simd/double8-inl.h"
#include "simd/float16-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::visibility::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

struct Placed {
  Double8 x, y, depth;
};

Placed place_eight(const Window& window, const Vector8& q) {
  const Double8 size = l1_norm(q), zero = broadcast8(0.0), one = broadcast8(1.0);
  const Double8 t = dot_unfused(broadcast8(window.t_row), q);
  const Double8 x = dot_unfused(broadcast8(window.x_row), q), y = dot_unfused(broadcast8(window.y_row), q);
  if (window.orthographic) {
    const Double8 depth = (broadcast8(window.far_t) - t) / broadcast8(window.far_t - window.near_t);
    const auto has_place = le(size, broadcast8(window.farthest));
    const Double8 bounded = max(min(depth, broadcast8(double{largest_depth})), zero);
    return {x, y, select(has_place, bounded, broadcast8(double{anywhere}))};
  }
  const auto has_place = lt(broadcast8(window.least_slope) * size, t);
  const Double8 over = one / select(has_place, t, one);
  const Double8 depth = min(broadcast8(window.near_t) * over, broadcast8(double{largest_depth}));
  // t is off by less than 2^-30 least_slope |q|.
  const Double8 slack = broadcast8(window.least_slope * 0x1p-30) * size;
  const auto before = lt(t + slack, broadcast8(window.near_t * (1 - 0x1p-20)));
  const Double8 without = select(before, broadcast8(double{before_near}), broadcast8(double{anywhere}));
  return {x * over, y * over, select(has_place, depth, without)};
}

void place(const Window& window, std::span<const glm::vec3> positions, std::size_t first, std::size_t last,
           WindowVertices& out) {
  const Vector8 eye = broadcast8(window.eye);
  for (std::size_t i = first; i < last; i += 8) {
    float from[3][8] = {};
    const std::size_t count = std::min<std::size_t>(8, last - i);
    for (std::size_t k = 0; k < count; ++k)
      for (int axis = 0; axis < 3; ++axis) from[axis][k] = positions[i + k][axis];
    const Vector8 p{load_widened<Double8>(from[0]), load_widened<Double8>(from[1]),
                    load_widened<Double8>(from[2])};
    const Placed placed = place_eight(window, p - eye);
    float to[3][8];
    store_narrowed(placed.x, to[0]);
    store_narrowed(placed.y, to[1]);
    store_narrowed(placed.depth, to[2]);
    std::copy_n(to[0], count, &out.x[i]);
    std::copy_n(to[1], count, &out.y[i]);
    std::copy_n(to[2], count, &out.depth[i]);
  }
}

/// First and last pixel whose centre is at `low` ... `high`, give or take the margin; last < first: none.
struct PixelRange {
  Int16 first, last;
};
PixelRange pixels_between(Float16 low, Float16 high, float margin, int size) {
  const Float16 zero = broadcast<Float16>(0.0f), most = broadcast<Float16>(static_cast<float>(size));
  // The pixel after the last whose centre is below low - margin; and floor(high + margin - 0.5).
  const Float16 first = low + broadcast<Float16>(0.5f - margin),
                last = high + broadcast<Float16>(0.5f + margin);
  return {truncate(min(max(first, zero), most)),
          truncate(min(max(last, zero), most)) - broadcast<Int16>(std::int32_t{1})};
}

std::size_t choose(const Window& window, const WindowVertices& vertices, const glm::uvec3* triangles,
                   std::uint32_t id, std::uint32_t wanted, std::size_t begin, Candidates& out) {
  const auto corners = load3<Int16>(reinterpret_cast<const std::int32_t*>(triangles));
  const auto of_corners = [&](const std::vector<float>& values) -> Vector16 {
    return {gather<float>(values.data(), shift_left<2>(corners.x)),
            gather<float>(values.data(), shift_left<2>(corners.y)),
            gather<float>(values.data(), shift_left<2>(corners.z))};
  };
  const Vector16 x = of_corners(vertices.x), y = of_corners(vertices.y), depth = of_corners(vertices.depth);
  const Float16 nearest = max(max(depth.x, depth.y), depth.z), farthest = min(min(depth.x, depth.y), depth.z);
  const PixelRange across =
      pixels_between(min(min(x.x, x.y), x.z), max(max(x.x, x.y), x.z), window.margin, window.width);
  const PixelRange down =
      pixels_between(min(min(y.x, y.y), y.z), max(max(y.x, y.y), y.z), window.margin, window.height);
  const Float16 zero = broadcast<Float16>(0.0f);
  const auto unplaced = lt(farthest, zero) | le(broadcast<Float16>(before_near), nearest);
  const Int16 none = broadcast<Int16>(std::int32_t{0});
  const Int16 x0 = select(unplaced, none, across.first), y0 = select(unplaced, none, down.first);
  const Int16 x1 = select(unplaced, broadcast<Int16>(std::int32_t{window.width - 1}), across.last);
  const Int16 y1 = select(unplaced, broadcast<Int16>(std::int32_t{window.height - 1}), down.last);
  const auto empty = gt(x0, x1) | gt(y0, y1) | eq(corners.x, corners.y) | eq(corners.y, corners.z) |
                     eq(corners.z, corners.x);
  // Depths of vertices are off by less than 2^-22 of them (orthographic: of 1).
  const std::uint32_t before = lt_bits(broadcast<Float16>(1 + 0x1p-20f), farthest);
  const auto kept = mask_of_bits<float, 16>(wanted & ~before & ~bits(empty));
  const Float16 slack = broadcast<Float16>(window.orthographic ? 0x1p-21f : 0.0f);
  const Float16 nearer = nearest * broadcast<Float16>(1 + 0x1p-21f) + slack,
                farther = max(farthest * broadcast<Float16>(1 - 0x1p-21f) - slack, zero);
  std::int32_t lanes[16];
  for (std::int32_t k = 0; k < 16; ++k) lanes[k] = static_cast<std::int32_t>(id) + k;
  compress(kept, x0, &out.x0[begin]);
  compress(kept, y0, &out.y0[begin]);
  compress(kept, x1, &out.x1[begin]);
  compress(kept, y1, &out.y1[begin]);
  compress(kept, select(unplaced, broadcast<Float16>(2.0f), nearer), &out.near_depth[begin]);
  compress(kept, select(unplaced, zero, farther), &out.far_depth[begin]);
  return compress(kept, load<Int16>(lanes), reinterpret_cast<std::int32_t*>(&out.ids[begin]));
}

/// Not a number (a plane that rounding left without a height) becomes -most.
Double8 bounded(Double8 value, double most) {
  const Double8 least = broadcast8(-most);
  return select(le(least, value), min(value, broadcast8(most)), least);
}

/// Where the centres of the boxes' first pixels are.
struct BoxCorner {
  Double8 x, y;
};

/// A function of the window's place, times `scale`.
void keep(const Double8& at_origin, const Double8& along_x, const Double8& along_y, const Double8& scale,
          const BoxCorner& corner, int k, TriangleSetup8& out) {
  const double most = k < 3 ? farthest_edge : steepest_depth;
  const Double8 value = at_origin * scale, x = along_x * scale, y = along_y * scale;
  store(value, out.at_origin[k]);
  store(x, out.along_x[k]);
  store(y, out.along_y[k]);
  store_narrowed(bounded((value + corner.x * x) + corner.y * y, most), out.value_at_box[k]);
  store_narrowed(bounded(x, most), out.step_x[k]);
  store_narrowed(bounded(y, most), out.step_y[k]);
}

/// Roundings of an edge's value at a pixel, relative to the sum of all products' sizes: 1 for each of the two
/// vectors from the eye, 2 for their cross product, 3 for the product with d0, dx or dy, 4 for the sum of the
/// three and the product with the place: 11, and 3 for the quotient by the slope: at most 14 u. The bound
/// takes 20 u, which also covers that it is computed in double itself.
void set_up(const Window& window, const float (&corners)[3][3][8], const double (&x0)[8],
            const double (&y0)[8], TriangleSetup8& out) {
  const BoxCorner corner{load<Double8>(x0) + broadcast8(0.5), load<Double8>(y0) + broadcast8(0.5)};
  const Double8 zero = broadcast8(0.0), one = broadcast8(1.0), unit = broadcast8(20 * 0x1p-53);
  const Double8 reach = broadcast8(window.reach), shift = broadcast8(window.shift);
  const Vector8 d0 = broadcast8(window.d0), dx = broadcast8(window.dx), dy = broadcast8(window.dy);
  Vector8 q[3];
  Double8 size[3];
  for (int k = 0; k < 3; ++k) {
    q[k] = Vector8{load_widened<Double8>(corners[k][0]), load_widened<Double8>(corners[k][1]),
                   load_widened<Double8>(corners[k][2])} -
           broadcast8(window.eye);
    size[k] = l1_norm(q[k]) + shift;
  }
  const Vector8 normal = cross(q[1] - q[0], q[2] - q[0]);
  const Double8 facing = window.orthographic ? dot_unfused(d0, normal) : dot_unfused(q[0], cross(q[1], q[2]));
  // The products of the sizes bound those of the differences' coordinates; reach is |d0| in orthographic
  // views.
  const Double8 side_bound = window.orthographic ? unit * reach * (size[0] + size[1]) * (size[0] + size[2])
                                                 : unit * size[0] * size[1] * size[2];
  out.side_unknown = bits(le(abs(facing), side_bound));
  const auto back = lt(facing, zero);
  out.back = bits(back);
  const Double8 turn = select(back, zero - one, one);
  Mask<double, 8> doubtful = lt(one, zero);
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const Vector8 plane = cross(q[a], q[b]);
    const Vector8 slope = window.orthographic ? cross(d0, q[b] - q[a]) : plane;
    const Double8 at_origin = dot_unfused(d0, plane);
    const Double8 along_x = dot_unfused(dx, slope), along_y = dot_unfused(dy, slope);
    const Double8 steepest = max(max(abs(along_x), abs(along_y)), broadcast8(1e-280));
    const Double8 scale = turn / steepest;
    keep(at_origin, along_x, along_y, scale, corner, k, out);
    doubtful = doubtful | lt(broadcast8(most_doubt), unit * size[a] * size[b] * reach / steepest);
  }
  out.doubtful = bits(doubtful);
  const Double8 height = window.orthographic ? dot_unfused(normal, d0) : dot_unfused(normal, q[0]);
  const auto has_plane = lt(zero, abs(height));
  const Double8 over = select(has_plane, one / select(has_plane, height, one), zero);
  const Double8 at_origin = dot_unfused(normal, window.orthographic ? q[0] : d0);
  const Double8 along_x = dot_unfused(normal, dx), along_y = dot_unfused(normal, dy);
  if (window.orthographic) {
    const Double8 range = broadcast8(window.far_t - window.near_t);
    keep(broadcast8(window.far_t) - at_origin * over, along_x * over, along_y * over, one / range, corner, 3,
         out);
  } else {
    keep(at_origin, along_x, along_y, over * broadcast8(window.near_t), corner, 3, out);
  }
}

}  // namespace

SetupKernels own_setup_kernels() {
  return {place, choose, set_up};
}

}  // namespace tenebra::visibility::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tenebra::visibility {

SetupKernels setup_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, own_setup_kernels)();
}

}  // namespace tenebra::visibility
#endif
