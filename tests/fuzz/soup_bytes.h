// Triangles and points on them from bytes: what the fuzzers of the methods compare.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include <tenebra/visible_points.h>
#include "fuzz/input_bytes.h"
#include "support/soup.h"

namespace tenebra::fuzz {

/// What a method is asked about.
struct SoupCase {
  testing::Soup soup;
  ViewRays view;
  VisiblePoints points;
  float unit = 1;  ///< of all coordinates
};

/// Up to `most` triangles, each with two points, at corners, on edges and within. Corners are often those of
/// the triangle before, so that triangles share edges, fold over and repeat.
inline SoupCase soup_case(InputBytes& bytes, int most) {
  SoupCase c;
  c.unit = std::ldexp(1.0f, bytes.below(16) - 8);
  c.view.eye = bytes.vector(c.unit);
  c.points.seen_from = c.view;
  const int count = 1 + bytes.below(most);
  for (int i = 0; i < count; ++i) {
    glm::vec3 corner[3];
    const int shared = bytes.byte();
    for (int k = 0; k < 3; ++k)
      corner[k] = i > 0 && (shared >> k & 1) != 0
                      ? c.soup.positions[3 * static_cast<std::size_t>(i - 1) +
                                         static_cast<std::size_t>((shared >> 3) + k) % 3]
                      : bytes.vector(c.unit);
    c.soup.add(corner[0], corner[1], corner[2]);
  }
  for (int i = 0; i < 2 * count; ++i) {
    const auto id = static_cast<std::uint32_t>(i / 2);
    const double v = bytes.below(9) / 8.0, w = (1 - v) * bytes.below(9) / 8.0;
    const glm::dvec3 a(c.soup.corner(id, 0)), b(c.soup.corner(id, 1)), d(c.soup.corner(id, 2));
    c.points.positions.push_back((1 - v - w) * a + v * b + w * d);
    c.points.triangles.push_back(id);
  }
  c.points.width = 2 * count;
  c.points.height = 1;
  return c;
}

/// All that it takes to repeat it by hand.
inline std::string describe(const SoupCase& c) {
  std::string text = fmt::format("\n  eye {} {} {}", c.view.eye.x, c.view.eye.y, c.view.eye.z);
  for (std::uint32_t id = 0; id < c.soup.triangles.size(); ++id)
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 q = c.soup.corner(id, k);
      text += fmt::format("{}{} {} {}", k == 0 ? fmt::format("\n  triangle {}: ", id) : ", ", q.x, q.y, q.z);
    }
  for (std::size_t i = 0; i < c.points.positions.size(); ++i) {
    const glm::dvec3 p = c.points.positions[i];
    text += fmt::format("\n  point {} on {}: {} {} {}", i, c.points.triangles[i], p.x, p.y, p.z);
  }
  return text;
}

/// Ends the program, which the fuzzer counts as a find.
[[noreturn]] inline void found(const std::string& what) {
  std::fprintf(stderr, "found: %s\n", what.c_str());
  std::abort();
}

}  // namespace tenebra::fuzz
