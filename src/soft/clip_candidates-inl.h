// The occluders of a group in blocks of sixteen, their lines at one point, and which of them reach a part of
// the light. Included once per target.
#if defined(TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#undef TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#else
#define TENEBRA_SOFT_CLIP_CANDIDATES_INL_H_
#endif

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
    const auto before = [](const Entry& a, const Entry& b) {
      return comes_before(a.occluder->size, a.occluder->triangle, b.occluder->size, b.occluder->triangle);
    };
    const auto middle = order_.end() - static_cast<std::ptrdiff_t>(group.indefinite.size());
    std::sort(middle, order_.end(), before);
    std::inplace_merge(order_.begin(), middle, order_.end(), before);
    slots_ = 0;
    for (const Entry& entry : order_) slots_ = HWY_MAX(slots_, static_cast<int>(entry.occluder->line_count));
    moving_.resize((order_.size() + 15) / 16);
    at_point_.resize(moving_.size());
    for (std::size_t i = 0; i < 16 * moving_.size(); ++i) fill(group, i);
  }

  /// Forgets all lists and finds the boxes of the shadows at a point. The list of those that may reach the
  /// light is [0, count()), largest first.
  HWY_NOINLINE void move_to(const GroupPoint& at) {
    at_ = at;
    count_ = 0;
    make_room(16 * moving_.size());
    const LightBox<T> light;
    for (std::size_t b = 0; b < moving_.size(); ++b) {
      at_point_[b].has_lines = false;
      find_boxes(at, b);
      const std::size_t valid = HWY_MIN(std::size_t{16}, order_.size() - 16 * b);
      append_meeting(at_point_[b].box, ids_in_block(b), valid, light);
    }
  }

  std::size_t count() const { return count_; }
  /// Forgets the lists beyond.
  void shrink(std::size_t count) { count_ = count; }

  /// Appends those of the list [first, last) whose shadow may reach into `box`; false, and nothing appended,
  /// if one of the largest among them covers it.
  HWY_NOINLINE bool find_among(std::size_t first, std::size_t last, const LightBox<T>& box) {
    make_room(last - first);
    const std::size_t from = count_;
    for (std::size_t i = first; i < last; i += 16) {
      const T* sides[4] = {&sides_[0][i], &sides_[1][i], &sides_[2][i], &sides_[3][i]};
      append_meeting(sides, load<Index>(&ids_[i]), HWY_MIN(std::size_t{16}, last - i), box);
    }
    const std::size_t largest_end = HWY_MIN(count_, from + looked_at);
    for (std::size_t i = from; i < largest_end; ++i) {
      if (!covers(i, box)) continue;
      count_ = from;
      return false;
    }
    return true;
  }

  /// The lines of an occluder in a list, by its place there; returns their number.
  HWY_INLINE int lines_of(std::size_t place, LightLine<T>* lines) {
    const auto id = static_cast<std::size_t>(ids_[place]);
    const Block& block = block_with_lines(id / 16);
    const std::size_t k = id % 16;
    for (int slot = 0; slot < slots_; ++slot)
      lines[slot] = {block.u[slot][k], block.v[slot][k], block.w[slot][k]};
    return slots_;
  }

private:
  using Wide = Pack<double, 16>;
  using Lanes = Pack<T, 16>;
  using Index = Pack<LaneIndex<T>, 16>;
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
    T u[4][16], v[4][16], w[4][16];
    bool has_lines = false;
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

  /// Boxes of the shadows on the light's plane. An occluder all at or below the point's height shadows
  /// nothing; one that is partly so may shadow all.
  HWY_INLINE void find_boxes(const GroupPoint& at, std::size_t b) {
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
    const auto boxed = less(zero, lowest), none = not_above(highest, zero);
    low_u = choose(none, num(2), choose(boxed, low_u, num(-2)));
    low_v = choose(boxed, low_v, num(-2));
    high_u = choose(boxed, high_u, num(2));
    high_v = choose(boxed, high_v, num(2));
    T(&box)[4][16] = at_point_[b].box;
    store(narrowed<T>(max(low_u, num(-2))), box[0]);
    store(narrowed<T>(zero - min(high_u, num(2))), box[1]);
    store(narrowed<T>(max(low_v, num(-2))), box[2]);
    store(narrowed<T>(zero - min(high_v, num(2))), box[3]);
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

  HWY_INLINE const Block& block_with_lines(std::size_t b) {
    if (!at_point_[b].has_lines) {
      find_lines(at_, b);
      at_point_[b].has_lines = true;
    }
    return at_point_[b];
  }

  static HWY_INLINE Index ids_in_block(std::size_t b) {
    constexpr LaneIndex<T> lanes[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return load<Index>(lanes) + splat<Index>(static_cast<LaneIndex<T>>(16 * b));
  }

  /// Room for `more` places and a full register behind them.
  void make_room(std::size_t more) {
    const std::size_t needed = count_ + more + 16;
    if (ids_.size() >= needed) return;
    for (auto& side : sides_) side.resize(2 * needed);
    ids_.resize(2 * needed);
  }

  /// Appends those of the first `valid` lanes whose boxes meet `box`.
  template <class Sides>
  HWY_INLINE void append_meeting(const Sides& sides, Index ids, std::size_t valid, const LightBox<T>& box) {
    constexpr T lanes[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const T border[4] = {box.cu + box.hu, box.hu - box.cu, box.cv + box.hv, box.hv - box.cv};
    auto meets = less(load<Lanes>(lanes), splat<Lanes>(static_cast<T>(valid)));
    for (int k = 0; k < 4; ++k) meets = meets & less(load<Lanes>(&sides[k][0]), splat<Lanes>(border[k]));
    std::size_t added = 0;
    for (int k = 0; k < 4; ++k) added = compress(meets, load<Lanes>(&sides[k][0]), &sides_[k][count_]);
    compress(meets, ids, &ids_[count_]);
    count_ += added;
  }

  HWY_INLINE bool covers(std::size_t place, const LightBox<T>& box) {
    LightLine<T> lines[4];
    const int count = lines_of(place, lines);
    const auto size = [](T a) { return HWY_MAX(a, -a); };
    for (int slot = 0; slot < count; ++slot) {
      const T value = lines[slot].u * box.cu + lines[slot].v * box.cv + lines[slot].w;
      if (!(value > size(lines[slot].u) * box.hu + size(lines[slot].v) * box.hv)) return false;
    }
    return true;
  }

  static constexpr std::size_t looked_at = 4;  ///< occluders that may cover a part by themselves
  std::vector<Entry> order_;
  std::vector<MovingBlock> moving_;
  std::vector<Block> at_point_;
  GroupPoint at_;
  std::vector<T> sides_[4];        ///< boxes of the shadows in lists, as in Block
  std::vector<LaneIndex<T>> ids_;  ///< and the occluders
  std::size_t count_ = 0;
  int slots_ = 0;
};

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
