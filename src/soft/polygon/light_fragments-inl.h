// Lists of convex fragments of the light, and the subtraction of an occluder's shadow from one. Included once
// per target.
#if defined(TENEBRA_SOFT_LIGHT_FRAGMENTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_LIGHT_FRAGMENTS_INL_H_
#undef TENEBRA_SOFT_LIGHT_FRAGMENTS_INL_H_
#else
#define TENEBRA_SOFT_LIGHT_FRAGMENTS_INL_H_
#endif

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "soft/polygon/irradiance-inl.h"
#include "soft/polygon/light_polygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Fragments in lists have at most this many vertices: an occluder's lines, at most four, each add one.
inline constexpr int fragment_capacity = polygon_capacity - 5;

/// A LightPolygon in memory.
template <class T>
struct alignas(64) StoredPolygon {
  T x[polygon_capacity], y[polygon_capacity];
  int count;
};

template <class T>
SIMD_INLINE LightPolygon<T> loaded(const StoredPolygon<T>& from) {
  using Lanes = Pack<T, polygon_capacity>;
  return {load<Lanes>(from.x), load<Lanes>(from.y), from.count};
}

template <class T>
class FragmentList {
public:
  void clear() { size_ = 0; }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  const StoredPolygon<T>& operator[](std::size_t i) const { return polygons_[i]; }
  /// The same vertices in the same order, bit by bit.
  bool operator==(const FragmentList& other) const {
    const auto same_bits = [](const auto& a, const auto& b) {
      // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c): bits
      return std::memcmp(&a, &b, sizeof(a)) == 0;
    };
    const auto equal = [&](const StoredPolygon<T>& a, const StoredPolygon<T>& b) {
      return a.count == b.count && same_bits(a.x, b.x) && same_bits(a.y, b.y);
    };
    return size_ == other.size_ &&
           std::equal(polygons_.data(), polygons_.data() + size_, other.polygons_.data(), equal);
  }
  void swap(FragmentList& other) {
    polygons_.swap(other.polygons_);
    std::swap(size_, other.size_);
  }

  /// A polygon of more than fragment_capacity vertices is stored as two halves.
  SIMD_INLINE void push(const LightPolygon<T>& polygon) {
    if (polygon.count > fragment_capacity) return push_halves(polygon);
    push_small(polygon);
  }
  void shrink(std::size_t size) { size_ = size; }
  SIMD_INLINE LightPolygon<T> pop() { return loaded(polygons_[--size_]); }

private:
  // Rare, and kept out of the many places that push.
  HWY_NOINLINE void push_halves(const LightPolygon<T>& polygon) {
    LightPolygon<T> low, high;
    halve(polygon, low, high);
    push_small(low);
    push_small(high);
  }
  HWY_NOINLINE void grow() { polygons_.resize(2 * size_ + 16); }

  SIMD_INLINE void push_small(const LightPolygon<T>& polygon) {
    if (size_ == polygons_.size()) grow();
    StoredPolygon<T>& to = polygons_[size_++];
    store(polygon.x, to.x);
    store(polygon.y, to.y);
    to.count = polygon.count;
  }

  std::vector<StoredPolygon<T>> polygons_;
  std::size_t size_ = 0;
};

/// Adds what is left of `fragment` outside the shadow to `out`; false, and nothing added, if that is all of
/// the fragment. `sides` are those of the lines, all of which have vertices of the fragment on their positive
/// side. Cut first along the line that takes most: others may then not cross the rest any more, and fragments
/// stay few and round.
template <class T>
HWY_NOINLINE bool subtract_shadow(const LightPolygon<T>& fragment, const ShadowLines<T>& lines,
                                  const LineSides<T>& sides, FragmentList<T>& out) {
  const std::size_t before = out.size();
  LightPolygon<T> rest = fragment;
  for (std::uint32_t crossing = sides.negative; crossing != 0;) {
    const int deepest = sides.deepest(crossing);
    crossing &= ~(1u << deepest);
    const LineValues<T> values = evaluate(rest, lines[deepest]);
    if (values.positive == 0) {
      out.shrink(before);
      return false;
    }
    if (values.negative == 0) continue;
    LightPolygon<T> inside, outside;
    split(rest, values, inside, outside);
    out.push(outside);
    rest = inside;
  }
  return true;
}

/// The part of every fragment on the positive side of `line`.
template <class T>
HWY_NOINLINE void keep_positive(FragmentList<T>& fragments, const LightLine<T>& line,
                                FragmentList<T>& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    const LightPolygon<T> fragment = loaded(fragments[i]);
    const LineValues<T> values = evaluate(fragment, line);
    if (values.positive == 0) continue;
    if (values.negative == 0) {
      scratch.push(fragment);
      continue;
    }
    LightPolygon<T> inside, outside;
    split(fragment, values, inside, outside);
    scratch.push(inside);
  }
  fragments.swap(scratch);
}

template <class T>
void append_edges(const FragmentList<T>& fragments, LightEdges& edges) {
  using Lanes = Pack<T, polygon_capacity>;
  using Index = Pack<LaneIndex<T>, polygon_capacity>;
  const Index next = load<Index>(next_lanes<T>);
  const auto widen = [](const T* from, int count, std::vector<double>& to, std::size_t place) {
    store(load_widened<Pack<double, 8>>(from), &to[place]);
    if (count > 8) store(load_widened<Pack<double, 8>>(from + 8), &to[place + 8]);
  };
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    const StoredPolygon<T>& p = fragments[i];
    edges.reserve(polygon_capacity);
    T x[polygon_capacity], y[polygon_capacity];  // of the next vertices
    store(permute(load<Lanes>(p.x), next), x);
    store(permute(load<Lanes>(p.y), next), y);
    widen(p.x, p.count, edges.u0, edges.count), widen(p.y, p.count, edges.v0, edges.count);
    widen(x, p.count, edges.u1, edges.count), widen(y, p.count, edges.v1, edges.count);
    edges.count += static_cast<std::size_t>(p.count);
  }
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
