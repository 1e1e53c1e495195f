// Code that moves the lanes of packs or changes their type: permute, gather, compress, interleave, widen,
// narrow. Included once per target.
#if defined(TENEBRA_SIMD_PACK_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SIMD_PACK_LANES_INL_H_
#undef TENEBRA_SIMD_PACK_LANES_INL_H_
#else
#define TENEBRA_SIMD_PACK_LANES_INL_H_
#endif

#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::simd::HWY_NAMESPACE {

/// Lane numbers for `permute`: as wide as T.
template <class T>
using LaneIndex = hwy::MakeSigned<T>;

/// Lane k is a's lane index[k]; 0 <= index < N.
template <class T, int N>
SIMD_INLINE Pack<T, N> permute(Pack<T, N> a, Pack<LaneIndex<T>, N> index) {
  using P = Pack<T, N>;
  using I = Pack<LaneIndex<T>, N>;
  P p;
  if constexpr (P::registers == 1) {
    p.r[0] = hn::TableLookupLanes(a.r[0], hn::IndicesFromVec(typename P::Tag(), index.r[0]));
  } else if constexpr (P::registers == 2) {
    const typename I::Tag d;
    for (int i = 0; i < 2; ++i) {
      const auto within = hn::And(index.r[i], hn::Set(d, static_cast<LaneIndex<T>>(P::width - 1)));
      const auto places = hn::IndicesFromVec(typename P::Tag(), within);
      const auto upper = hn::Gt(index.r[i], hn::Set(d, static_cast<LaneIndex<T>>(P::width - 1)));
      p.r[i] = hn::IfThenElse(hn::RebindMask(typename P::Tag(), upper), hn::TableLookupLanes(a.r[1], places),
                              hn::TableLookupLanes(a.r[0], places));
    }
  } else {
    T from[N], to[N];
    LaneIndex<T> places[N];
    store(a, from);
    store(index, places);
    for (int i = 0; i < N; ++i) to[i] = from[places[i]];
    p = load<P>(to);
  }
  return p;
}

/// N floats as doubles.
template <class P>
SIMD_INLINE P load_widened(const float* from) {
  const hn::Rebind<float, typename P::Tag> narrow;
  P p;
  for (int i = 0; i < P::registers; ++i)
    p.r[i] = hn::PromoteTo(typename P::Tag(), hn::LoadU(narrow, from + i * P::width));
  return p;
}
template <class P>
SIMD_INLINE P load_widened(const double* from) {
  return load<P>(from);
}

/// The T that starts `bytes` bytes after `from`, lane by lane; any alignment.
template <class T, int N>
SIMD_INLINE Pack<T, N> gather(const void* from, Pack<std::int32_t, N> bytes) {
  Pack<T, N> r;
  for (int i = 0; i < r.registers; ++i)
    r.r[i] = hn::GatherOffset(typename Pack<T, N>::Tag(), static_cast<const T*>(from), bytes.r[i]);
  return r;
}

/// For every set of lanes of a register the numbers of its lanes, one after another.
template <class T, int Width>
struct CompressTable {
  LaneIndex<T> rows[1 << Width][Width] = {};

  constexpr CompressTable() {
    for (int set = 0; set < (1 << Width); ++set) {
      int count = 0;
      for (int lane = 0; lane < Width; ++lane)
        if ((set >> lane & 1) != 0) rows[set][count++] = static_cast<LaneIndex<T>>(lane);
    }
  }
};
template <class T, int Width>
inline constexpr CompressTable<T, Width> compress_table;

/// Writes the lanes where t is true one after another; returns their number. `to` has room for all N. (Where
/// the target has no instruction for it, Highway's tables are copied to the stack at each use by GCC 12.)
template <class T, int N, class U>
SIMD_INLINE std::size_t compress(Mask<U, N> t, Pack<T, N> a, T* to) {
  using P = Pack<T, N>;
  const typename P::Tag tag;
  std::size_t count = 0;
  for (int i = 0; i < P::registers; ++i) {
    const auto mask = hn::RebindMask(tag, t.r[i]);
    if constexpr (HWY_TARGET <= HWY_AVX3 || P::width == 1) {
      hn::StoreU(hn::Compress(a.r[i], mask), tag, to + count);
      count += hn::CountTrue(tag, mask);
    } else {
      std::uint8_t set[8] = {};
      hn::StoreMaskBits(tag, mask, set);
      const auto row =
          hn::LoadU(typename Pack<LaneIndex<T>, N>::Tag(), compress_table<T, P::width>.rows[set[0]]);
      hn::StoreU(hn::TableLookupLanes(a.r[i], hn::IndicesFromVec(tag, row)), tag, to + count);
      count += static_cast<std::size_t>(hwy::PopCount(set[0]));
    }
  }
  return count;
}

/// N triples x y z x y z ...
template <class P, class T>
SIMD_INLINE Pack3<P> load3(const T* from) {
  Pack3<P> p;
  for (int i = 0; i < P::registers; ++i)
    hn::LoadInterleaved3(typename P::Tag(), from + 3 * i * P::width, p.x.r[i], p.y.r[i], p.z.r[i]);
  return p;
}
/// Doubles rounded to nearest.
template <int N>
SIMD_INLINE void store_narrowed(Pack<double, N> a, float* to) {
  const hn::Rebind<float, typename Pack<double, N>::Tag> narrow;
  for (int i = 0; i < a.registers; ++i) hn::StoreU(hn::DemoteTo(narrow, a.r[i]), narrow, to + i * a.width);
}
template <int N>
SIMD_INLINE void store_narrowed(Pack<double, N> a, double* to) {
  store(a, to);
}

/// Doubles as floats, rounded to nearest, without a trip through memory.
template <int N>
SIMD_INLINE Pack<float, N> demoted(Pack<double, N> a) {
  using P = Pack<float, N>;
  P p;
  if constexpr (Pack<double, N>::registers == P::registers) {
    for (int i = 0; i < P::registers; ++i) p.r[i] = hn::DemoteTo(typename P::Tag(), a.r[i]);
  } else {
#if HWY_TARGET != HWY_SCALAR
    static_assert(Pack<double, N>::registers == 2 * P::registers);
    const hn::Half<typename P::Tag> half;
    for (int i = 0; i < P::registers; ++i) {
      const auto upper = hn::DemoteTo(half, a.r[2 * i + 1]);
      p.r[i] = hn::Combine(typename P::Tag(), upper, hn::DemoteTo(half, a.r[2 * i]));
    }
#endif
  }
  return p;
}
/// Four fours, one after another.
SIMD_INLINE Float16 combine(const Float4 (&a)[4]) {
  Float16 p;
#if HWY_TARGET <= HWY_AVX2
  const hn::CappedTag<float, 8> eight;
  const auto low = hn::Combine(eight, a[1].r[0], a[0].r[0]), high = hn::Combine(eight, a[3].r[0], a[2].r[0]);
#if HWY_TARGET <= HWY_AVX3
  p.r[0] = hn::Combine(Float16::Tag(), high, low);
#else
  p.r[0] = low, p.r[1] = high;
#endif
#else
  for (int i = 0; i < Float16::registers; ++i) p.r[i] = a[i * Float16::width / 4].r[i % Float4::registers];
#endif
  return p;
}

/// Doubles as T, rounded to nearest.
template <class T, int N>
SIMD_INLINE Pack<T, N> narrowed(Pack<double, N> a) {
  if constexpr (sizeof(T) == sizeof(double)) {
    return a;
  } else {
    return demoted(a);
  }
}

/// Lane after lane, the four packs' values in turn.
template <class T, int N>
SIMD_INLINE void store_fours(Pack<T, N> a, Pack<T, N> b, Pack<T, N> c, Pack<T, N> d, T* to) {
  for (int i = 0; i < a.registers; ++i)
    hn::StoreInterleaved4(a.r[i], b.r[i], c.r[i], d.r[i], typename Pack<T, N>::Tag(), to + 4 * i * a.width);
}
/// Four values, repeated to the end of the pack.
template <class P, class T>
SIMD_INLINE P load_four(const T* from) {
  if constexpr (sizeof(T) == 4 && P::width >= 4) {
    P p;
    for (int i = 0; i < P::registers; ++i) p.r[i] = hn::LoadDup128(typename P::Tag(), from);
    return p;
  } else {
    constexpr int lanes = P::width * P::registers;
    T repeated[lanes];
    for (int k = 0; k < lanes; ++k) repeated[k] = from[k % 4];
    return load<P>(repeated);
  }
}

/// Sixteen points by coordinate: point 4 i + k is x y z at lanes 4 i ... 4 i + 2 of p[k].
SIMD_INLINE Pack3<Float16> transposed(const Float16 (&p)[4]) {
  Pack3<Float16> t;
#if HWY_TARGET == HWY_SCALAR
  for (int i = 0; i < 16; ++i) {
    const auto* const from = &p[i % 4].r[i / 4 * 4];
    t.x.r[i] = from[0], t.y.r[i] = from[1], t.z.r[i] = from[2];
  }
#else
  const Float16::Tag d;
  for (int i = 0; i < Float16::registers; ++i) {
    const auto xy02 = hn::InterleaveLower(d, p[0].r[i], p[2].r[i]);
    const auto xy13 = hn::InterleaveLower(d, p[1].r[i], p[3].r[i]);
    t.x.r[i] = hn::InterleaveLower(d, xy02, xy13);
    t.y.r[i] = hn::InterleaveUpper(d, xy02, xy13);
    t.z.r[i] = hn::InterleaveLower(d, hn::InterleaveUpper(d, p[0].r[i], p[2].r[i]),
                                   hn::InterleaveUpper(d, p[1].r[i], p[3].r[i]));
  }
#endif
  return t;
}

}  // namespace tenebra::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
