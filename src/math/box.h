// Boxes along the axes.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

namespace tenebra::math {

/// The smallest box around what was added to it; low beyond high: nothing was.
template <class T>
struct Box {
  using Point = glm::vec<3, T>;
  Point low{std::numeric_limits<T>::infinity()};
  Point high{-std::numeric_limits<T>::infinity()};

  void add(const Point& p) { low = glm::min(low, p), high = glm::max(high, p); }
  void add(const Box& other) { low = glm::min(low, other.low), high = glm::max(high, other.high); }

  bool empty() const { return !(low.x <= high.x); }
  /// The origin, if it is empty.
  Point centre() const { return empty() ? Point(0) : T(0.5) * (low + high); }
  T diagonal() const { return empty() ? T(0) : glm::length(high - low); }
  /// 0, 1 or 2; the first of equals.
  int longest_side() const {
    const Point size = high - low;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  }
  T largest_coordinate() const {
    const Point size = glm::max(glm::abs(low), glm::abs(high));
    return std::max({size.x, size.y, size.z});
  }
  T distance_to(const Point& p) const { return glm::length(glm::max(Point(0), glm::max(low - p, p - high))); }
};

}  // namespace tenebra::math
