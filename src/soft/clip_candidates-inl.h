// The occluders of a group in blocks of sixteen, their lines at one point, and which of them reach a part of
// the light. Included once per target.
#if defined(TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#undef TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#else
#define TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#endif

#include <bit>
#include <vector>

#include "soft/group_occluders.h"
#include "soft/light_polygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

/// A part of the light: |u - cu| <= hu, |v - cv| <= hv.
template <class T>
struct LightBox {
  T cu = 0, cv = 0, hu = 1, hv = 1;
};

/// A point as a group knows it.
struct GroupPoint {
  glm::dvec3 from_centre{0.0};
  glm::dvec3 in_light{0.0};  ///< u, v, height: light_coordinates
  double light_height = 0;   ///< of the light's plane over the group's centre
  std::uint32_t receiver = no_triangle;
  double receiver_tau = 0;
};

/// Which occluders are looked at.
enum class Chosen { all, indefinite };

template <class T>
class ClipCandidates {
public:
  /// Takes over a group's lines, largest occluder first.
  void reset(const GroupOccluders& group, Chosen chosen) {
    order_.clear();
    if (chosen == Chosen::all) {
      for (std::uint32_t i = 0; i < group.occluders.size(); ++i)
        order_.push_back({&group.occluders[i], nullptr});
    }
    for (std::uint32_t i = 0; i < group.indefinite.size(); ++i) {
      order_.push_back({&group.indefinite[i], &group.heights[i]});
    }
    std::sort(order_.begin(), order_.end(), [](const Entry& a, const Entry& b) {
      return comes_before(a.occluder->size, a.occluder->triangle, b.occluder->size, b.occluder->triangle);
    });
    slots_ = 0;
    for (const Entry& entry : order_) slots_ = HWY_MAX(slots_, static_cast<int>(entry.occluder->line_count));
    moving_.resize((order_.size() + 15) / 16);
    at_point_.resize(moving_.size());
    for (std::size_t i = 0; i < 16 * moving_.size(); ++i) fill(group, i);
  }

  std::size_t size() const { return order_.size(); }

  /// Shadow boxes, and the lines of the occluders whose boxes reach the light, at a point.
  HWY_NOINLINE void move_to(const GroupPoint& at) {
    for (std::size_t b = 0; b < moving_.size(); ++b) {
      const std::size_t valid = HWY_MIN(std::size_t{16}, order_.size() - 16 * b);
      at_point_[b].reaching = find_boxes(at, b) & ((1u << valid) - 1u);
      if (at_point_[b].reaching != 0) find_lines(at, b);
    }
  }

  /// Appends the occluders whose shadow may reach the light to `list`, largest first; true if one covers it.
  HWY_NOINLINE bool find_all(std::vector<std::uint32_t>& list) {
    shadows_.clear();
    for (std::size_t b = 0; b < at_point_.size(); ++b) {
      const std::uint32_t reaching = at_point_[b].reaching;
      if (reaching == 0) continue;
      const Reach reach = reach_of(at_point_[b]);
      if ((reach.covering & reaching) != 0) return true;
      for (std::uint32_t bits = reach.meeting & reaching; bits != 0; bits &= bits - 1) {
        list.push_back(static_cast<std::uint32_t>(shadows_.size()));
        add_shadow(b, std::countr_zero(bits));
      }
    }
    return false;
  }

  /// Those of list[first..last) whose shadow may reach into `box`, appended; true if one of them covers it.
  HWY_NOINLINE bool find_among(std::size_t first, std::size_t last, const LightBox<T>& box,
                               std::vector<std::uint32_t>& list) const {
    const T border[4] = {box.cu + box.hu, box.hu - box.cu, box.cv + box.hv, box.hv - box.cv};
    const Four border_lanes = load<Four>(border), zero = splat<Four>(T(0));
    const Four cu = splat<Four>(box.cu), cv = splat<Four>(box.cv);
    const Four hu = splat<Four>(box.hu), hv = splat<Four>(box.hv);
    for (std::size_t i = first; i < last; ++i) {
      const Shadow& shadow = shadows_[list[i]];
      if (!all_of(less(load<Four>(shadow.box), border_lanes))) continue;
      const Four u = load<Four>(shadow.u), v = load<Four>(shadow.v);
      const Four value = u * cu + v * cv + load<Four>(shadow.w);
      const Four radius = absolute(u) * hu + absolute(v) * hv;
      if (!all_of(less(zero, value + radius))) continue;
      if (all_of(less(zero, value - radius))) return true;
      list.push_back(list[i]);
    }
    return false;
  }

  /// The lines of a shadow in a list; returns their number.
  HWY_INLINE int lines_of(std::uint32_t id, LightLine<T>* lines) const {
    const Shadow& shadow = shadows_[id];
    for (int slot = 0; slot < slots_; ++slot) lines[slot] = {shadow.u[slot], shadow.v[slot], shadow.w[slot]};
    return slots_;
  }

private:
  using Wide = Pack<double, 16>;
  using Four = Pack<T, 4>;
  struct Entry {
    const Occluder* occluder;
    const PlaneHeight* plane;  ///< of indefinite ones
  };
  struct MovingBlock {
    double c[4][4][3][16];    ///< line, power of the point, coefficient, occluder
    double corner[3][3][16];  ///< corner, coordinate, occluder
    bool indefinite;          ///< one of them is
  };
  struct Block {
    T box[4][16];  ///< of the shadow: least u, -greatest u, least v, -greatest v
    std::uint32_t reaching = 0;
    T u[4][16], v[4][16], w[4][16];
  };
  /// What an occluder shadows at the point, by itself: four lines (missing ones are positive everywhere) and
  /// a box, its greatest coordinates negated.
  struct Shadow {
    T u[4], v[4], w[4], box[4];
  };
  struct Reach {
    std::uint32_t meeting, covering;
  };

  /// Missing lines, and those of missing occluders, are positive everywhere.
  void fill(const GroupOccluders& group, std::size_t i) {
    MovingBlock& block = moving_[i / 16];
    if (i % 16 == 0) block.indefinite = false;
    const Occluder* occluder = i < order_.size() ? order_[i].occluder : nullptr;
    if (i < order_.size() && order_[i].plane != nullptr) block.indefinite = true;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const glm::dvec3 corner = occluder ? group.corners[occluder->first_corner + k] : glm::dvec3(0.0);
      for (int c = 0; c < 3; ++c) block.corner[k][c][i % 16] = corner[c];
    }
    for (std::uint32_t slot = 0; slot < 4; ++slot) {
      const bool there = occluder != nullptr && slot < occluder->line_count;
      for (int k = 0; k < 4; ++k) {
        for (int c = 0; c < 3; ++c) {
          block.c[slot][k][c][i % 16] = there              ? group.lines[occluder->first_line + slot].c[k][c]
                                        : k == 0 && c == 2 ? 1.0
                                                           : 0.0;
        }
      }
    }
  }

  /// Boxes of the shadows on the light's plane; bit k: that of occluder k meets the light. An occluder all at
  /// or below the point's height shadows nothing; one that is partly so has no box.
  HWY_INLINE std::uint32_t find_boxes(const GroupPoint& at, std::size_t b) {
    const auto num = [](double value) { return splat<Wide>(value); };
    const Wide far = num(1e30), zero = num(0);
    Wide low_u = far, low_v = far, high_u = num(-1e30), high_v = high_u, lowest = far, highest = high_u;
    const Wide pu = num(at.in_light.x), pv = num(at.in_light.y);
    const Wide reach = num(at.light_height - at.in_light.z);
    for (int k = 0; k < 3; ++k) {
      const auto& corner = moving_[b].corner[k];
      const Wide rise = load<Wide>(corner[2]) - num(at.in_light.z);
      lowest = min(lowest, rise);
      highest = max(highest, rise);
      const Wide t = reach / choose(less(zero, rise), rise, num(1));
      const Wide u = pu + (load<Wide>(corner[0]) - pu) * t, v = pv + (load<Wide>(corner[1]) - pv) * t;
      low_u = min(low_u, u);
      high_u = max(high_u, u);
      low_v = min(low_v, v);
      high_v = max(high_v, v);
    }
    const auto boxed = less(zero, lowest);
    const Wide one = num(1), minus = num(-1);
    low_u = choose(boxed, low_u, minus);
    low_v = choose(boxed, low_v, minus);
    high_u = choose(boxed, high_u, one);
    high_v = choose(boxed, high_v, one);
    Block& to = at_point_[b];
    store(narrowed<T>(max(low_u, num(-2))), to.box[0]);
    store(narrowed<T>(zero - min(high_u, num(2))), to.box[1]);
    store(narrowed<T>(max(low_v, num(-2))), to.box[2]);
    store(narrowed<T>(zero - min(high_v, num(2))), to.box[3]);
    return less_bits(zero, highest) & less_bits(low_u, one) & less_bits(minus, high_u) &
           less_bits(low_v, one) & less_bits(minus, high_v);
  }

  HWY_INLINE void find_lines(const GroupPoint& at, std::size_t b) {
    const Wide x = splat<Wide>(at.from_centre.x), y = splat<Wide>(at.from_centre.y),
               z = splat<Wide>(at.from_centre.z);
    alignas(64) double signs[16];
    const bool turned = find_signs(b, at, signs);
    for (int slot = 0; slot < slots_; ++slot) {
      const auto& c = moving_[b].c[slot];
      Block& to = at_point_[b];
      T* lines[3] = {to.u[slot], to.v[slot], to.w[slot]};
      for (int i = 0; i < 3; ++i) {
        Wide value =
            load<Wide>(c[0][i]) + x * load<Wide>(c[1][i]) + y * load<Wide>(c[2][i]) + z * load<Wide>(c[3][i]);
        if (turned) value = value * load<Wide>(signs);
        store(narrowed<T>(value), lines[i]);
      }
      if (turned) shut(signs, slot, to);
    }
  }

  /// Signs of the lines in a block; false if all are +1.
  bool find_signs(std::size_t b, const GroupPoint& at, double* signs) const {
    if (!moving_[b].indefinite) return false;
    for (std::size_t k = 0; k < 16; ++k) {
      signs[k] = 1;
      if (16 * b + k >= order_.size()) continue;
      const Entry& entry = order_[16 * b + k];
      if (entry.plane == nullptr) continue;
      signs[k] = entry.occluder->triangle == at.receiver
                     ? 0
                     : blocking_sign(*entry.plane, at.from_centre, at.receiver_tau);
    }
    return true;
  }

  /// What does not block has no shadow.
  static void shut(const double* signs, int slot, Block& block) {
    for (int k = 0; k < 16; ++k) {
      if (signs[k] == 0) block.w[slot][k] = -1;
    }
  }

  /// Which shadows meet and cover the square around the light.
  HWY_INLINE Reach reach_of(const Block& lines) const {
    using Lanes = Pack<T, 16>;
    const Lanes zero = splat<Lanes>(T(0));
    Lanes highest = splat<Lanes>(T(1)),
          lowest = highest;  // least over the lines of the greatest, least value
    for (int slot = 0; slot < slots_; ++slot) {
      const Lanes radius = absolute(load<Lanes>(lines.u[slot])) + absolute(load<Lanes>(lines.v[slot]));
      const Lanes value = load<Lanes>(lines.w[slot]);
      highest = min(highest, value + radius);
      lowest = min(lowest, value - radius);
    }
    return {less_bits(zero, highest), less_bits(zero, lowest)};
  }

  void add_shadow(std::size_t b, int k) {
    const Block& from = at_point_[b];
    Shadow to;
    for (int slot = 0; slot < 4; ++slot) {
      const bool there = slot < slots_;
      to.u[slot] = there ? from.u[slot][k] : T(0);
      to.v[slot] = there ? from.v[slot][k] : T(0);
      to.w[slot] = there ? from.w[slot][k] : T(1);
      to.box[slot] = from.box[slot][k];
    }
    shadows_.push_back(to);
  }

  std::vector<Entry> order_;
  std::vector<MovingBlock> moving_;
  std::vector<Block> at_point_;
  std::vector<Shadow> shadows_;  ///< of find_all
  int slots_ = 0;
};

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
