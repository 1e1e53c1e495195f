// The visibility query of Mora et al. 2012 (Algorithm 1, BSP_query): fragments of the light travel down the
// BSP of line classes and make it grow where they meet a class that is not known yet. Included once per
// target.
#if defined(TENEBRA_SOFT_LINE_CLASS_QUERY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_LINE_CLASS_QUERY_INL_H_
#undef TENEBRA_SOFT_LINE_CLASS_QUERY_INL_H_
#else
#define TENEBRA_SOFT_LINE_CLASS_QUERY_INL_H_
#endif

#include <vector>

#include "soft/bsp/line_class_bsp.h"
#include "soft/polygon/light_fragments-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// The line of a hyperplane as it meets the light from the point centre + d.
template <class T>
SIMD_INLINE LightLine<T> line_at(const MovingLine& line, const glm::dvec3& d) {
  const glm::dvec3 at = line.c[0] + d.x * line.c[1] + d.y * line.c[2] + d.z * line.c[3];
  return {static_cast<T>(at.x), static_cast<T>(at.y), static_cast<T>(at.z)};
}

template <class T>
class LineClassQuery {
public:
  /// Appends the parts of `light` visible from the point centre + d to `out`. False if the tree would have to
  /// grow beyond its bound: `out` then has some of them.
  HWY_NOINLINE bool query(LineClassBsp& bsp, const MovingLine* lines, const LightPolygon<T>& light,
                          const glm::dvec3& d, FragmentList<T>& out) {
    push(-1, 0, light);
    while (!places_.empty()) {
      Place place = places_.back();
      places_.pop_back();
      LightPolygon<T> fragment = polygons_.pop();
      BspChild child = at(bsp, place);
      while (true) {
        if (is_undefined(child)) child = bsp.grow(place.parent, place.side);
        if (is_undefined(child)) return give_up();
        if (child < 0) break;
        const LineValues<T> values = evaluate(fragment, line_at<T>(lines[bsp.nodes()[child].line], d));
        place = {child, values.positive != 0};
        if (values.positive != 0 && values.negative != 0) {
          LightPolygon<T> positive, negative;
          split(fragment, values, positive, negative);
          push(child, 1, positive);
          fragment = negative;
          place.side = 0;
          if (fragment.count > fragment_capacity) {
            push(child, 0, fragment);
            place.parent = stop;
            break;
          }
        }
        child = bsp.nodes()[place.parent].child[place.side];
      }
      if (place.parent != stop && child == visible_leaf) out.push(fragment);
    }
    return true;
  }

private:
  static constexpr std::int32_t stop = -2;
  struct Place {
    std::int32_t parent;
    int side;
  };

  bool give_up() {
    places_.clear();
    polygons_.clear();
    return false;
  }

  static SIMD_INLINE BspChild at(const LineClassBsp& bsp, const Place& place) {
    return place.parent < 0 ? bsp.root() : bsp.nodes()[place.parent].child[place.side];
  }

  /// A polygon that is too large is sent down in halves, each with its place.
  SIMD_INLINE void push(std::int32_t parent, int side, const LightPolygon<T>& polygon) {
    const std::size_t before = polygons_.size();
    polygons_.push(polygon);
    for (std::size_t i = before; i < polygons_.size(); ++i) places_.push_back({parent, side});
  }

  std::vector<Place> places_;
  FragmentList<T> polygons_;
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
