// sphere_maps.h for packs of sixteen: the same operations in the same order, hence the same bits.
#if defined(TENEBRA_AO_SPHERE_MAPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_AO_SPHERE_MAPS_INL_H_
#undef TENEBRA_AO_SPHERE_MAPS_INL_H_
#else
#define TENEBRA_AO_SPHERE_MAPS_INL_H_
#endif

#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::ao::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

struct Square16 {
  Float16 u, v;
};

SIMD_INLINE Float16 octant_angle(Float16 t) {
  const Float16 s = t * t;
  Float16 p = broadcast<Float16>(0.00973818667f);
  p = p * s + broadcast<Float16>(-0.0462955384f);
  p = p * s + broadcast<Float16>(0.105839887f);
  p = p * s + broadcast<Float16>(-0.171223523f);
  p = p * s + broadcast<Float16>(0.253018675f);
  p = p * s + broadcast<Float16>(-0.424315711f);
  p = p * s + broadcast<Float16>(1.27323856f);
  return p * t;
}

SIMD_INLINE Square16 square_from_direction(const Pack3<Float16>& d) {
  const Float16 zero = broadcast<Float16>(0.0f), one = broadcast<Float16>(1.0f),
                tiny = broadcast<Float16>(1e-37f);
  const Float16 x = abs(d.x), y = abs(d.y);
  const Float16 r = sqrt(max(one - abs(d.z), zero));
  const Float16 larger = max(x, y), smaller = min(x, y);
  const Float16 angle = broadcast<Float16>(0.5f) * octant_angle(smaller / max(larger, tiny));
  const Float16 v = select_le(y, x, angle, one - angle) * r;
  const Float16 u = r - v;
  return {copy_sign(select_le(zero, d.z, u, one - v), d.x), copy_sign(select_le(zero, d.z, v, one - u), d.y)};
}

SIMD_INLINE Pack3<Float16> direction_from_square(const Square16& square) {
  const auto constant = [](float x) { return broadcast<Float16>(x); };
  const Float16 one = constant(1.0f), u = abs(square.u), v = abs(square.v);
  const Float16 above = one - (u + v), r = one - abs(above);
  const Float16 q = (v - u) / max(r, constant(1e-37f)), s = q * q;
  const Float16 sine =
      (((constant(-2.54235228e-05f) * s + constant(0.00176070069f)) * s + constant(-0.0570956444f)) * s +
       constant(0.555360366f)) *
      q;
  const Float16 cosine =
      ((constant(-0.000225480425f) * s + constant(0.0112075793f)) * s + constant(-0.21808888f)) * s +
      constant(0.707106762f);
  const Float16 out = r * sqrt(constant(2.0f) - r * r);
  return {copy_sign((cosine - sine) * out, square.u), copy_sign((cosine + sine) * out, square.v),
          copy_sign(one - r * r, above)};
}

SIMD_INLINE Square16 square_from_disk(Float16 dx, Float16 dy) {
  const Float16 x = abs(dx), y = abs(dy);
  const Float16 larger = max(x, y), smaller = min(x, y);
  const Float16 r = sqrt(dx * dx + dy * dy);
  const Float16 across = r * octant_angle(smaller / max(larger, broadcast<Float16>(1e-37f)));
  return {copy_sign(select_le(y, x, r, across), dx), copy_sign(select_le(y, x, across, r), dy)};
}

struct Cell16 {
  Int16 column, row;
};

SIMD_INLINE Cell16 cell_of(const Square16& square, int side) {
  const Float16 half = broadcast<Float16>(0.5f * static_cast<float>(side)), zero = broadcast<Float16>(0.0f);
  const Float16 last = broadcast<Float16>(static_cast<float>(side - 1));
  return {truncate(min(max(square.u * half + half, zero), last)),
          truncate(min(max(square.v * half + half, zero), last))};
}
SIMD_INLINE Int16 cell_index(const Cell16& cell, int side) {
  return cell.row * broadcast<Int16>(side) + cell.column;
}
/// Its centre.
SIMD_INLINE Square16 cell_point(const Cell16& cell, int side) {
  const Float16 scale = broadcast<Float16>(2 / static_cast<float>(side)), half = broadcast<Float16>(0.5f),
                one = broadcast<Float16>(1.0f);
  return {(to_float(cell.column) + half) * scale - one, (to_float(cell.row) + half) * scale - one};
}

}  // namespace tenebra::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
