// Within a cell alpha is a + bx + cy + dxy, and its level line (x - xc)(y - yc) = K: an arc of a hyperbola
// whose axes are the grid's, or a straight line where d = 0.
#include <algorithm>
#include <cmath>

#include "stage/cutout/gates.h"

namespace tenebra::stage {
namespace {

constexpr int most_halvings = 3;

/// The geometric mean, with the sign of both; rounding may leave one of them a hair on the wrong side.
double mean_of(double a, double b) {
  return std::copysign(std::sqrt(std::max(0.0, a * b)), a + b);
}

/// The farthest point of an arc from its chord is where the tangent has the chord's direction: at the
/// geometric means of its ends' distances from both axes.
void halve(glm::dvec2 centre, glm::dvec2 from, glm::dvec2 to, double limit, int depth,
           std::vector<glm::dvec2>& out) {
  const glm::dvec2 a = from - centre, b = to - centre, chord = to - from;
  const glm::dvec2 middle(mean_of(a.x, b.x), mean_of(a.y, b.y));
  const glm::dvec2 off = middle - a;
  const double twice_area = std::abs(chord.x * off.y - chord.y * off.x);
  if (depth == most_halvings || !(twice_area > limit * std::sqrt(glm::dot(chord, chord)))) return;
  halve(centre, from, centre + middle, limit, depth + 1, out);
  out.push_back(centre + middle);
  halve(centre, centre + middle, to, limit, depth + 1, out);
}

}  // namespace

void bend_hyperbola(const std::array<double, 4>& corner, glm::dvec2 low, glm::dvec2 high, glm::dvec2 from,
                    glm::dvec2 to, double limit, std::vector<glm::dvec2>& out) {
  const glm::dvec2 size = high - low;
  if (!(size.x > 0 && size.y > 0)) return;
  const double b = corner[1] - corner[0], c = corner[3] - corner[0];
  const double d = (corner[0] - corner[1]) + (corner[2] - corner[3]);
  // Farther than 4096 cells from its centre an arc within the cell is straight to 1/16384 of it.
  if (!(std::abs(d) * 4096.0 > std::max(std::abs(b), std::abs(c)))) return;
  const glm::dvec2 centre = low + glm::dvec2(-c / d, -b / d) * size;
  const std::size_t first = out.size();
  halve(centre, from, to, limit, 0, out);
  const glm::dvec2 inset = size * corner_gap;
  for (std::size_t i = first; i < out.size(); ++i) out[i] = glm::clamp(out[i], low + inset, high - inset);
}

}  // namespace tenebra::stage
