// sphere_maps.h for packs of sixteen: the same operations in the same order, hence the same bits.
#if defined(TENEBRA_AO_SPHERE_MAPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_AO_SPHERE_MAPS_INL_H_
#undef TENEBRA_AO_SPHERE_MAPS_INL_H_
#else
#define TENEBRA_AO_SPHERE_MAPS_INL_H_
#endif

#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

struct Square16 {
  Float16 u, v;
};

HWY_INLINE Float16 octant_angle(Float16 t) {
  const Float16 s = t * t;
  Float16 p = splat<Float16>(0.00973818667f);
  p = p * s + splat<Float16>(-0.0462955384f);
  p = p * s + splat<Float16>(0.105839887f);
  p = p * s + splat<Float16>(-0.171223523f);
  p = p * s + splat<Float16>(0.253018675f);
  p = p * s + splat<Float16>(-0.424315711f);
  p = p * s + splat<Float16>(1.27323856f);
  return p * t;
}

HWY_INLINE Square16 square_from_direction(const Pack3<Float16>& d) {
  const Float16 zero = splat<Float16>(0.0f), one = splat<Float16>(1.0f), tiny = splat<Float16>(1e-37f);
  const Float16 x = absolute(d.x), y = absolute(d.y), z = absolute(d.z);
  const Float16 plane = x * x + y * y, length = square_root(plane + z * z);
  const Float16 r = square_root(plane / max(length * (length + z), tiny));
  const Float16 larger = max(x, y), smaller = min(x, y);
  const Float16 angle = splat<Float16>(0.5f) * octant_angle(smaller / max(larger, tiny));
  const Float16 v = where_not_above(y, x, angle, one - angle) * r;
  const Float16 u = r - v;
  return {copy_sign(where_not_above(zero, d.z, u, one - v), d.x),
          copy_sign(where_not_above(zero, d.z, v, one - u), d.y)};
}

HWY_INLINE Square16 square_from_disk(Float16 dx, Float16 dy) {
  const Float16 x = absolute(dx), y = absolute(dy);
  const Float16 larger = max(x, y), smaller = min(x, y);
  const Float16 r = square_root(dx * dx + dy * dy);
  const Float16 across = r * octant_angle(smaller / max(larger, splat<Float16>(1e-37f)));
  return {copy_sign(where_not_above(y, x, r, across), dx), copy_sign(where_not_above(y, x, across, r), dy)};
}

HWY_INLINE Int16 cell_index(const Square16& square, int side) {
  const Float16 half = splat<Float16>(0.5f * static_cast<float>(side)), zero = splat<Float16>(0.0f);
  const Float16 last = splat<Float16>(static_cast<float>(side - 1));
  const Int16 column = truncate(min(max(square.u * half + half, zero), last));
  const Int16 row = truncate(min(max(square.v * half + half, zero), last));
  return row * splat<Int16>(side) + column;
}

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
