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

#include "soft/light_fragments-inl.h"
#include "soft/line_class_bsp.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

/// The line of a hyperplane as the point centre + d meets it: u, v, w.
template <class T>
HWY_INLINE LightLine<T> line_at(const MovingLine<T>& line, T dx, T dy, T dz) {
  return {line.c[0][0] + dx * line.c[1][0] + dy * line.c[2][0] + dz * line.c[3][0],
          line.c[0][1] + dx * line.c[1][1] + dy * line.c[2][1] + dz * line.c[3][1],
          line.c[0][2] + dx * line.c[1][2] + dy * line.c[2][2] + dz * line.c[3][2]};
}

template <class T>
class LineClassQuery {
public:
  /// Appends the parts of `light` visible from the point centre + d to `out`.
  HWY_INLINE void query(LineClassBsp& bsp, const MovingLine<T>* lines, const LightPolygon<T>& light, T dx,
                        T dy, T dz, FragmentList<T>& out) {
    push(-1, 0, light);
    while (!places_.empty()) {
      Place place = places_.back();
      places_.pop_back();
      LightPolygon<T> fragment = polygons_.pop();
      BspChild child = at(bsp, place);
      while (true) {
        if (is_undefined(child)) child = bsp.grow(place.parent, place.side);
        if (child < 0) break;
        const LineValues<T> values = evaluate(fragment, line_at(lines[bsp.nodes()[child].line], dx, dy, dz));
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
  }

private:
  static constexpr std::int32_t stop = -2;
  struct Place {
    std::int32_t parent;
    int side;
  };

  static HWY_INLINE BspChild at(const LineClassBsp& bsp, const Place& place) {
    return place.parent < 0 ? bsp.root() : bsp.nodes()[place.parent].child[place.side];
  }

  /// A polygon that is too large goes in halves, each with its place.
  HWY_INLINE void push(std::int32_t parent, int side, const LightPolygon<T>& polygon) {
    const std::size_t before = polygons_.size();
    polygons_.push(polygon);
    for (std::size_t i = before; i < polygons_.size(); ++i) places_.push_back({parent, side});
  }

  std::vector<Place> places_;
  FragmentList<T> polygons_;
};

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
