// N lanes of T on whatever vector registers the target has: one register, several, or emulation. Everything
// that names a vector register is here and in pack_lanes-inl.h (code that moves lanes or changes their type);
// kernels are written in terms of Pack. Included once per target, as Highway's foreach_target asks.
#if defined(TENEBRA_SIMD_PACK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SIMD_PACK_INL_H_
#undef TENEBRA_SIMD_PACK_INL_H_
#else
#define TENEBRA_SIMD_PACK_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

// Small functions are always inlined, but where a pack is a row of scalars: that target is there to compare
// with, and with its loops inlined everywhere one file took five minutes to compile.
#undef SIMD_INLINE
#if HWY_TARGET == HWY_SCALAR
#define SIMD_INLINE inline
#else
#define SIMD_INLINE HWY_INLINE
#endif

HWY_BEFORE_NAMESPACE();
namespace tenebra::simd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class T, int N>
struct Pack {
  using Tag = hn::CappedTag<T, N>;
  static constexpr int width = static_cast<int>(hn::MaxLanes(Tag()));  ///< lanes in a register
  static constexpr int registers = N / width;
  hn::Vec<Tag> r[registers];
};
using Float4 = Pack<float, 4>;
using Float16 = Pack<float, 16>;

template <class P, class T>
SIMD_INLINE P broadcast(T value) {
  P p;
  for (int i = 0; i < P::registers; ++i) p.r[i] = hn::Set(typename P::Tag(), value);
  return p;
}

template <class P, class T>
SIMD_INLINE P load(const T* from) {
  P p;
  for (int i = 0; i < P::registers; ++i) p.r[i] = hn::LoadU(typename P::Tag(), from + i * P::width);
  return p;
}

template <class T, int N>
SIMD_INLINE Pack<T, N> operator+(Pack<T, N> a, Pack<T, N> b) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Add(a.r[i], b.r[i]);
  return a;
}
template <class T, int N>
SIMD_INLINE Pack<T, N> operator-(Pack<T, N> a, Pack<T, N> b) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Sub(a.r[i], b.r[i]);
  return a;
}
template <class T, int N>
SIMD_INLINE Pack<T, N> operator*(Pack<T, N> a, Pack<T, N> b) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Mul(a.r[i], b.r[i]);
  return a;
}
template <class T, int N>
SIMD_INLINE Pack<T, N> operator/(Pack<T, N> a, Pack<T, N> b) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Div(a.r[i], b.r[i]);
  return a;
}
/// a * b + c, fused where the target fuses: callers' bounds hold for both.
template <class T, int N>
SIMD_INLINE Pack<T, N> mul_add(Pack<T, N> a, Pack<T, N> b, Pack<T, N> c) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::MulAdd(a.r[i], b.r[i], c.r[i]);
  return a;
}
template <class T, int N>
SIMD_INLINE Pack<T, N> min(Pack<T, N> a, Pack<T, N> b) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Min(a.r[i], b.r[i]);
  return a;
}
template <class T, int N>
SIMD_INLINE Pack<T, N> sqrt(Pack<T, N> a) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Sqrt(a.r[i]);
  return a;
}

template <class T, int N>
SIMD_INLINE Pack<T, N> max(Pack<T, N> a, Pack<T, N> b) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Max(a.r[i], b.r[i]);
  return a;
}
template <class T, int N>
SIMD_INLINE Pack<T, N> abs(Pack<T, N> a) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Abs(a.r[i]);
  return a;
}
template <class T, int N>
SIMD_INLINE void store(Pack<T, N> a, T* to) {
  for (int i = 0; i < a.registers; ++i) hn::StoreU(a.r[i], typename Pack<T, N>::Tag(), to + i * a.width);
}
/// Least and greatest lane.
template <class T, int N>
SIMD_INLINE T reduce_min(Pack<T, N> a) {
  for (int i = 1; i < a.registers; ++i) a.r[0] = hn::Min(a.r[0], a.r[i]);
  return hn::GetLane(hn::MinOfLanes(typename Pack<T, N>::Tag(), a.r[0]));
}
template <class T, int N>
SIMD_INLINE T reduce_max(Pack<T, N> a) {
  for (int i = 1; i < a.registers; ++i) a.r[0] = hn::Max(a.r[0], a.r[i]);
  return hn::GetLane(hn::MaxOfLanes(typename Pack<T, N>::Tag(), a.r[0]));
}

/// Lanes of `a` where x <= y, of `b` elsewhere.
template <class T, int N>
SIMD_INLINE Pack<T, N> select_le(Pack<float, N> x, Pack<float, N> y, Pack<T, N> a, Pack<T, N> b) {
  for (int i = 0; i < a.registers; ++i) {
    a.r[i] =
        hn::IfThenElse(hn::RebindMask(typename Pack<T, N>::Tag(), hn::Le(x.r[i], y.r[i])), a.r[i], b.r[i]);
  }
  return a;
}

// Whole numbers, for keys.
template <int N>
SIMD_INLINE Pack<std::int32_t, N> truncate(Pack<float, N> a) {
  Pack<std::int32_t, N> r;
  for (int i = 0; i < a.registers; ++i) r.r[i] = hn::ConvertTo(typename Pack<std::int32_t, N>::Tag(), a.r[i]);
  return r;
}
template <int N>
SIMD_INLINE Pack<std::int32_t, N> operator^(Pack<std::int32_t, N> a, Pack<std::int32_t, N> b) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Xor(a.r[i], b.r[i]);
  return a;
}
template <int N>
SIMD_INLINE Pack<std::int32_t, N> operator&(Pack<std::int32_t, N> a, Pack<std::int32_t, N> b) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::And(a.r[i], b.r[i]);
  return a;
}
template <int N>
SIMD_INLINE Pack<std::int32_t, N> operator|(Pack<std::int32_t, N> a, Pack<std::int32_t, N> b) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Or(a.r[i], b.r[i]);
  return a;
}
template <int Bits, int N>
SIMD_INLINE Pack<std::int32_t, N> shift_left(Pack<std::int32_t, N> a) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::ShiftLeft<Bits>(a.r[i]);
  return a;
}
template <int Bits, int N>
SIMD_INLINE Pack<std::int32_t, N> shift_right(Pack<std::int32_t, N> a) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::ShiftRight<Bits>(a.r[i]);
  return a;
}

/// A truth value per lane.
template <class T, int N>
struct Mask {
  hn::Mask<typename Pack<T, N>::Tag> r[Pack<T, N>::registers];
};
using Mask4 = Mask<float, 4>;

/// a < b; false where either is NaN.
template <class T, int N>
SIMD_INLINE Mask<T, N> lt(Pack<T, N> a, Pack<T, N> b) {
  Mask<T, N> t;
  for (int i = 0; i < a.registers; ++i) t.r[i] = hn::Lt(a.r[i], b.r[i]);
  return t;
}
template <class T, int N>
SIMD_INLINE Mask<T, N> operator|(Mask<T, N> a, Mask<T, N> b) {
  for (int i = 0; i < Pack<T, N>::registers; ++i) a.r[i] = hn::Or(a.r[i], b.r[i]);
  return a;
}
template <class T, int N>
SIMD_INLINE Mask<T, N> operator&(Mask<T, N> a, Mask<T, N> b) {
  for (int i = 0; i < Pack<T, N>::registers; ++i) a.r[i] = hn::And(a.r[i], b.r[i]);
  return a;
}
/// Bit i is lane i. Goes through memory on some targets: use it once for each decision, not for each
/// comparison.
template <class T, int N>
SIMD_INLINE std::uint32_t bits(Mask<T, N> a) {
  using P = Pack<T, N>;
  std::uint32_t result = 0;
  for (int i = 0; i < P::registers; ++i) {
#if HWY_TARGET <= HWY_AVX3  // masks are registers of their own there
    result |= static_cast<std::uint32_t>(a.r[i].raw) << (i * P::width);
#else
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(typename P::Tag(), a.r[i], bytes);
    result |= (bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8) << (i * P::width);
#endif
  }
  return result;
}
template <class T, int N>
SIMD_INLINE std::uint32_t lt_bits(Pack<T, N> a, Pack<T, N> b) {
  return bits(lt(a, b));
}

/// Three coordinates of N points or vectors.
template <class P>
struct Pack3 {
  P x, y, z;
};
template <class P>
SIMD_INLINE P dot(const Pack3<P>& a, const Pack3<P>& b) {
  return mul_add(a.z, b.z, mul_add(a.y, b.y, a.x * b.x));
}
template <class P, class T>
SIMD_INLINE Pack3<P> broadcast3(T x, T y, T z) {
  return {broadcast<P>(x), broadcast<P>(y), broadcast<P>(z)};
}
/// a - s b, lane by lane.
template <class P>
SIMD_INLINE Pack3<P> subtract_scaled(const Pack3<P>& a, P s, const Pack3<P>& b) {
  return {a.x - s * b.x, a.y - s * b.y, a.z - s * b.z};
}

/// out[k] = m.p - d for k = 0..3 in double; fused or not.
SIMD_INLINE void four_planes(const double* mx, const double* my, const double* mz, const double* d, double px,
                             double py, double pz, double* out) {
  using Double4 = Pack<double, 4>;
  Double4 e = load<Double4>(mx) * broadcast<Double4>(px) - load<Double4>(d);
  e = mul_add(load<Double4>(my), broadcast<Double4>(py), e);
  e = mul_add(load<Double4>(mz), broadcast<Double4>(pz), e);
  store(e, out);
}

/// a > b, lane by lane, of whole numbers.
template <class T, int N>
SIMD_INLINE Mask<T, N> gt(Pack<T, N> a, Pack<T, N> b) {
  Mask<T, N> t;
  for (int i = 0; i < a.registers; ++i) t.r[i] = hn::Gt(a.r[i], b.r[i]);
  return t;
}
/// a == b, lane by lane.
template <class T, int N>
SIMD_INLINE Mask<T, N> eq(Pack<T, N> a, Pack<T, N> b) {
  Mask<T, N> t;
  for (int i = 0; i < a.registers; ++i) t.r[i] = hn::Eq(a.r[i], b.r[i]);
  return t;
}
/// Lanes of `a` where `t` holds, of `b` elsewhere; `t` may come from lanes of another kind and the same size.
template <class U, class T, int N>
SIMD_INLINE Pack<T, N> select(Mask<U, N> t, Pack<T, N> a, Pack<T, N> b) {
  for (int i = 0; i < a.registers; ++i) {
    a.r[i] = hn::IfThenElse(hn::RebindMask(typename Pack<T, N>::Tag(), t.r[i]), a.r[i], b.r[i]);
  }
  return a;
}

template <class P>
SIMD_INLINE Pack3<P> operator-(const Pack3<P>& a, const Pack3<P>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class P>
SIMD_INLINE Pack3<P> cross(const Pack3<P>& a, const Pack3<P>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// For tables and for rays against boxes and triangles.
using Float8 = Pack<float, 8>;
using Int16 = Pack<std::int32_t, 16>;

/// |a| with the sign of b.
template <int N>
SIMD_INLINE Pack<float, N> copy_sign(Pack<float, N> a, Pack<float, N> b) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::CopySign(a.r[i], b.r[i]);
  return a;
}
template <int N>
SIMD_INLINE Pack<float, N> to_float(Pack<std::int32_t, N> a) {
  Pack<float, N> r;
  for (int i = 0; i < a.registers; ++i) r.r[i] = hn::ConvertTo(typename Pack<float, N>::Tag(), a.r[i]);
  return r;
}
/// Lane by lane, by 0..31.
template <int N>
SIMD_INLINE Pack<std::int32_t, N> shift_right(Pack<std::int32_t, N> a, Pack<std::int32_t, N> by) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Shr(a.r[i], by.r[i]);
  return a;
}
/// a <= b; false where either is NaN.
template <class T, int N>
SIMD_INLINE Mask<T, N> le(Pack<T, N> a, Pack<T, N> b) {
  Mask<T, N> t;
  for (int i = 0; i < a.registers; ++i) t.r[i] = hn::Le(a.r[i], b.r[i]);
  return t;
}
template <class T, int N>
SIMD_INLINE bool any(Mask<T, N> t) {
  for (int i = 0; i < Pack<T, N>::registers; ++i)
    if (!hn::AllFalse(typename Pack<T, N>::Tag(), t.r[i])) return true;
  return false;
}

/// Lanes 0 ... N - 1 of a truth value from the bits of `bits`.
template <class T, int N>
SIMD_INLINE Mask<T, N> mask_of_bits(std::uint32_t bits) {
  using P = Pack<T, N>;
  Mask<T, N> t;
  for (int i = 0; i < P::registers; ++i) {
    const std::uint32_t part = bits >> (i * P::width);
#if HWY_TARGET <= HWY_AVX3
    t.r[i].raw = static_cast<decltype(t.r[i].raw)>(part);
#else
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(part), static_cast<std::uint8_t>(part >> 8)};
    t.r[i] = hn::LoadMaskBits(typename P::Tag(), bytes);
#endif
  }
  return t;
}
/// Sum of the lanes, in the target's order: the same bits everywhere only where all sums are exact.
template <class T, int N>
SIMD_INLINE T reduce_add(Pack<T, N> a) {
  for (int i = 1; i < a.registers; ++i) a.r[0] = hn::Add(a.r[0], a.r[i]);
  return hn::GetLane(hn::SumOfLanes(typename Pack<T, N>::Tag(), a.r[0]));
}

/// Sum of the lanes, in one order: the same bits on every target.
SIMD_INLINE double reduce_add_in_order(Pack<double, 8> a) {
  double v[8];
  store(a, v);
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

/// Bits of the sixteen that equal `value`.
SIMD_INLINE std::uint32_t eq_bits(const std::uint32_t* sixteen, std::uint32_t value) {
  using P = Pack<std::int32_t, 16>;
  return bits(eq(load<P>(reinterpret_cast<const std::int32_t*>(sixteen)),
                 broadcast<P>(static_cast<std::int32_t>(value))));
}

/// a != b, lane by lane.
template <class T, int N>
SIMD_INLINE Mask<T, N> ne(Pack<T, N> a, Pack<T, N> b) {
  Mask<T, N> t;
  for (int i = 0; i < a.registers; ++i) t.r[i] = hn::Ne(a.r[i], b.r[i]);
  return t;
}
/// Lane by lane, by 0..31.
template <int N>
SIMD_INLINE Pack<std::int32_t, N> shift_left(Pack<std::int32_t, N> a, Pack<std::int32_t, N> by) {
  for (int i = 0; i < a.registers; ++i) a.r[i] = hn::Shl(a.r[i], by.r[i]);
  return a;
}

/// The bits of floats as whole numbers, and back.
template <int N>
SIMD_INLINE Pack<std::int32_t, N> bits_of(Pack<float, N> a) {
  Pack<std::int32_t, N> r;
  for (int i = 0; i < a.registers; ++i) r.r[i] = hn::BitCast(typename Pack<std::int32_t, N>::Tag(), a.r[i]);
  return r;
}
template <int N>
SIMD_INLINE Pack<float, N> float_of_bits(Pack<std::int32_t, N> a) {
  Pack<float, N> r;
  for (int i = 0; i < a.registers; ++i) r.r[i] = hn::BitCast(typename Pack<float, N>::Tag(), a.r[i]);
  return r;
}

}  // namespace tenebra::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
