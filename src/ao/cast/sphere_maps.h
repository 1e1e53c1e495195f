// Maps between the square [-1, 1]^2 and the sphere, the disk and the hemisphere; with inverses in constant
// time. The forms for packs of sixteen stand in sphere_maps-inl.h and give the same bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace tenebra::ao {

/// (4 / pi) atan(t) for |t| <= 1: odd, -1 .. 1, off by at most 7e-7. Interpolates at seven Chebyshev nodes in
/// t^2.
inline float octant_angle(float t) {
  const float s = t * t;
  float p = 0.00973818667f;
  p = p * s + -0.0462955384f;
  p = p * s + 0.105839887f;
  p = p * s + -0.171223523f;
  p = p * s + 0.253018675f;
  p = p * s + -0.424315711f;
  p = p * s + 1.27323856f;
  return p * t;
}

/// Octahedral map of equal areas (Clarberg 2008): a unit vector to the square. The upper hemisphere is the
/// diamond |u| + |v| <= 1. Off by at most 2e-6 (see octant_angle), at the poles by 4e-4 (1 - z cancels).
inline glm::vec2 square_from_direction(glm::vec3 d) {
  const float x = std::abs(d.x), y = std::abs(d.y);
  const float r = std::sqrt(std::max(1 - std::abs(d.z), 0.0f));
  const float larger = std::max(x, y), smaller = std::min(x, y);
  const float angle = 0.5f * octant_angle(smaller / std::max(larger, 1e-37f));
  float v = (y <= x ? angle : 1 - angle) * r;
  float u = r - v;
  if (!(0 <= d.z)) {
    const float swap = 1 - u;
    u = 1 - v;
    v = swap;
  }
  return {std::copysign(u, d.x), std::copysign(v, d.y)};
}

/// Its inverse: a unit vector.
inline glm::vec3 direction_from_square(glm::vec2 square) {
  const float u = std::abs(square.x), v = std::abs(square.y);
  const float above = 1 - (u + v);  // the lower hemisphere is folded over the diamond's sides
  const float r = 1 - std::abs(above);
  // Angle from the x axis: (1 + q) pi / 4; sine and cosine of q pi / 4, over sqrt(2), off by at most 2e-8.
  const float q = (v - u) / std::max(r, 1e-37f), s = q * q;
  const float sine = (((-2.54235228e-05f * s + 0.00176070069f) * s + -0.0570956444f) * s + 0.555360366f) * q;
  const float cosine = ((-0.000225480425f * s + 0.0112075793f) * s + -0.21808888f) * s + 0.707106762f;
  const float out = r * std::sqrt(2 - r * r);
  return {std::copysign((cosine - sine) * out, square.x), std::copysign((cosine + sine) * out, square.y),
          std::copysign(1 - r * r, above)};
}

/// Shirley and Chiu 1997: concentric squares to concentric circles, areas kept.
inline glm::vec2 disk_from_square(glm::vec2 square) {
  constexpr double quarter = 0.78539816339744831;
  const double a = square.x, b = square.y;
  if (a == 0 && b == 0) return {0, 0};
  if (std::abs(b) <= std::abs(a)) {
    const double phi = quarter * (b / a);
    return {static_cast<float>(a * std::cos(phi)), static_cast<float>(a * std::sin(phi))};
  }
  const double phi = quarter * (a / b);
  return {static_cast<float>(b * std::sin(phi)), static_cast<float>(b * std::cos(phi))};
}

/// Its inverse, for points of the unit disk; off by at most 2e-6.
inline glm::vec2 square_from_disk(glm::vec2 disk) {
  const float x = std::abs(disk.x), y = std::abs(disk.y);
  const float larger = std::max(x, y), smaller = std::min(x, y);
  const float r = std::sqrt(disk.x * disk.x + disk.y * disk.y);
  const float across = r * octant_angle(smaller / std::max(larger, 1e-37f));
  return {std::copysign(y <= x ? r : across, disk.x), std::copysign(y <= x ? across : r, disk.y)};
}

/// Point i of n that fill the square evenly, whatever n: a lattice of the golden ratio. Through the maps
/// below its 256 rays have half the error of a 16 x 16 grid's, and no bias.
inline glm::vec2 lattice_point(int i, int n) {
  const double across = i * 0.61803398874989485;
  return {static_cast<float>((2 * i + 1.0) / n - 1),
          static_cast<float>(2 * (across - std::floor(across)) - 1)};
}

/// Malley: the disk lifted to the hemisphere around +z; density proportional to the cosine.
inline glm::vec3 hemisphere_from_square(glm::vec2 square) {
  const glm::vec2 d = disk_from_square(square);
  return {d.x, d.y, std::sqrt(std::max(0.0f, 1 - d.x * d.x - d.y * d.y))};
}

/// Two unit vectors that make a right-handed frame with the unit vector n (Duff et al. 2017).
struct Frame {
  glm::vec3 x, y;
};
inline Frame frame_around(glm::vec3 n) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * (n.x * n.x * a), sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

/// Cell 0 .. side - 1 of a coordinate of the square; NaN counts as cell 0.
inline int cell_of(float coordinate, int side) {
  const float half = 0.5f * static_cast<float>(side);
  return static_cast<int>(std::min(std::max(0.0f, coordinate * half + half), static_cast<float>(side - 1)));
}
/// Cell index: rows of v.
inline int cell_index(glm::vec2 square, int side) {
  return cell_of(square.y, side) * side + cell_of(square.x, side);
}
/// The point (fx, fy) in 0..1 of cell `index`; its centre if not given.
inline glm::vec2 cell_point(int index, int side, float fx = 0.5f, float fy = 0.5f) {
  const float scale = 2 / static_cast<float>(side);
  return {(static_cast<float>(index % side) + fx) * scale - 1,
          (static_cast<float>(index / side) + fy) * scale - 1};
}

}  // namespace tenebra::ao
