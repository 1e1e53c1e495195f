// Which triangles may meet a shaft, eight at a time. Included once per target.
#if defined(TENEBRA_SOFT_SHAFT_CULL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_SHAFT_CULL_INL_H_
#undef TENEBRA_SOFT_SHAFT_CULL_INL_H_
#else
#define TENEBRA_SOFT_SHAFT_CULL_INL_H_
#endif

#include <algorithm>
#include <span>
#include <tuple>

#include "simd/pack_lanes-inl.h"
#include "simd/prefetch.h"
#include "soft/shafts/shaft.h"
#include "soft/shafts/triangle_blocks.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

// A shaft in T, wider by a margin for the rounding of its own numbers. The rounding of a triangle, with R its
// reach, is in the margin of the triangle's block: in double 5 u R for m.v, as |m|_1 <= 1. In float (u =
// 2^-24) that and 2 u R for v off by the light's centre and its own rounding, u R for m, u R for the sum with
// the limit.
template <class T>
struct CullingShaft {
  static constexpr bool is_float = sizeof(T) == sizeof(float);
  static constexpr double own_margin = is_float ? 0x1p-21 : 0, block_margin = is_float ? 0x1p-20 : 0x1p-50;
  struct Plane {
    T m[3], limit;
  };
  T origin[3], low[3], high[3], origin_size;
  Plane planes[std::tuple_size_v<decltype(Shaft::planes)>];
  int plane_count;

  explicit CullingShaft(const Shaft& shaft) : plane_count(shaft.plane_count) {
    const auto as = [](double value) { return static_cast<T>(value); };
    const glm::dvec3& o = shaft.light->origin;
    const double margin = own_margin * (shaft.cell.reach + shaft.light->place_reach());
    for (int c = 0; c < 3; ++c) {
      origin[c] = as(o[c]), low[c] = as(shaft.low[c] - margin), high[c] = as(shaft.high[c] + margin);
    }
    origin_size = as(largest(o));
    for (int k = 0; k < plane_count; ++k) {
      const ShaftPlane& p = shaft.planes[static_cast<std::size_t>(k)];
      planes[k] = {{as(p.m.x), as(p.m.y), as(p.m.z)}, as(p.limit + margin)};
    }
  }
};

template <class T>
SIMD_INLINE Pack<T, block_size> eight_as(const float* from) {
  if constexpr (sizeof(T) == sizeof(float)) {
    return load<Pack<T, block_size>>(from);
  } else {
    return load_widened<Pack<T, block_size>>(from);
  }
}

// Lanes of triangles that may meet the shaft's box and the inner sides of its planes.
template <class T>
SIMD_INLINE std::uint32_t inside(const CullingShaft<T>& shaft, const TriangleBlock& block,
                                 std::uint32_t lanes) {
  using Lanes = Pack<T, block_size>;
  const Lanes margin = (eight_as<T>(block.largest) + broadcast<Lanes>(shaft.origin_size)) *
                       broadcast<Lanes>(static_cast<T>(CullingShaft<T>::block_margin));
  Lanes v[3][3];  // axis, corner
  const auto beyond = [&](int axis) {
    for (int k = 0; k < 3; ++k)
      v[axis][k] = eight_as<T>(block.v[k][axis]) - broadcast<Lanes>(shaft.origin[axis]);
    const auto& [a, b, c] = v[axis];
    return lt(broadcast<Lanes>(shaft.high[axis]) + margin, min(a, min(b, c))) |
           lt(max(a, max(b, c)) + margin, broadcast<Lanes>(shaft.low[axis]));
  };
  const auto outside = beyond(0) | beyond(1) | beyond(2);
  lanes &= ~bits(outside);
  for (int i = 0; i < shaft.plane_count && lanes != 0; ++i) {
    const auto& plane = shaft.planes[i];
    const auto along = [&](int k) {
      return broadcast<Lanes>(plane.m[0]) * v[0][k] + broadcast<Lanes>(plane.m[1]) * v[1][k] +
             broadcast<Lanes>(plane.m[2]) * v[2][k];
    };
    const Lanes nearest = min(along(0), min(along(1), along(2)));
    lanes &= ~lt_bits(broadcast<Lanes>(plane.limit) + margin, nearest);
  }
  return lanes;
}

// Prefetches the block of a reference some places ahead: lists of many triangles do not stay in the caches.
SIMD_INLINE void prefetch_ahead(const TriangleBlock* blocks, std::span<const BlockRef> in, std::size_t i) {
  constexpr std::size_t ahead = 4, line = 64;
  if (i + ahead >= in.size()) return;
  const auto* const block = reinterpret_cast<const unsigned char*>(&blocks[in[i + ahead].block]);
  for (std::size_t at = 0; at < sizeof(TriangleBlock::v); at += line) simd::prefetch(block + at);
}

template <class T>
std::size_t cull_in(const Shaft& shaft, const TriangleBlock* blocks, std::span<const BlockRef> in,
                    BlockRef* out) {
  const CullingShaft<T> converted(shaft);
  std::size_t count = 0;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const BlockRef ref = in[i];
    prefetch_ahead(blocks, in, i);
    const std::uint32_t lanes = inside(converted, blocks[ref.block], ref.lanes);
    if (lanes != 0) out[count++] = {ref.block, lanes};
  }
  return count;
}

// In float where its margins are negligible compared with the light or the cell.
inline std::size_t cull(const Shaft& shaft, const TriangleBlock* blocks, std::span<const BlockRef> in,
                        BlockRef* out) {
  const Cell& cell = shaft.cell;
  const double light = shaft.light->place_reach();
  const double reach = cell.reach + light + 2 * largest(shaft.light->origin);
  const double size = std::max({light, largest(cell.axis[0]), largest(cell.axis[1])});
  return (0x1p-12 * reach < size ? cull_in<float> : cull_in<double>)(shaft, blocks, in, out);
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
