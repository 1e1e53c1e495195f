#include "support/soup.h"

#include <array>

namespace tenebra::testing {
namespace {

using glm::dvec3;

/// Point k of n on the unit circle, by rational parameters: no library function that rounds its own way.
glm::dvec2 circle(int k, int n) {
  const double turn = 4.0 * (k % n) / n;
  const int quadrant = static_cast<int>(turn);
  const double t = turn - quadrant, d = 1 + t * t;
  const glm::dvec2 p{(1 - t * t) / d, 2 * t / d};
  const std::array<glm::dvec2, 4> turned{glm::dvec2{p.x, p.y}, {-p.y, p.x}, {-p.x, -p.y}, {p.y, -p.x}};
  return turned[static_cast<std::size_t>(quadrant)];
}

dvec3 any_across(Random& random, dvec3 axis) {
  return glm::normalize(glm::cross(axis, random.direction()));
}

}  // namespace

void Soup::add(dvec3 a, dvec3 b, dvec3 c) {
  const auto first = static_cast<std::uint32_t>(positions.size());
  for (const dvec3& p : {a, b, c}) positions.emplace_back(p);
  triangles.emplace_back(first, first + 1, first + 2);
}

void Soup::quad(dvec3 corner, dvec3 u, dvec3 v) {
  add(corner, corner + u, corner + u + v);
  add(corner, corner + u + v, corner + v);
}

void Soup::append(const Soup& other) {
  const auto first = static_cast<std::uint32_t>(positions.size());
  positions.insert(positions.end(), other.positions.begin(), other.positions.end());
  for (const glm::uvec3& t : other.triangles) triangles.push_back(t + first);
}

Soup Soup::moved(double scale, dvec3 offset) const {
  Soup out = *this;
  for (glm::vec3& p : out.positions) p = glm::vec3(dvec3(p) * scale + offset);
  return out;
}

dvec3 Soup::low() const {
  dvec3 low(HUGE_VAL);
  for (const glm::vec3& p : positions) low = glm::min(low, dvec3(p));
  return low;
}

dvec3 Soup::high() const {
  dvec3 high(-HUGE_VAL);
  for (const glm::vec3& p : positions) high = glm::max(high, dvec3(p));
  return high;
}

Soup random_soup(Random& random, int count, double size) {
  Soup soup;
  for (int i = 0; i < count; ++i) {
    const dvec3 centre = random.in_cube(1);
    soup.add(centre + random.in_cube(size), centre + random.in_cube(size), centre + random.in_cube(size));
  }
  return soup;
}

Soup sphere(int rings, double radius, dvec3 centre) {
  Soup soup;
  for (int face = 0; face < 6; ++face)
    for (int i = 0; i < rings; ++i)
      for (int j = 0; j < rings; ++j) {
        const auto at = [&](int u, int v) {
          dvec3 p;
          const int axis = face / 2;
          const double sign = face % 2 == 0 ? 1 : -1;
          p[axis] = sign;
          p[(axis + 1) % 3] = sign * (2.0 * u / rings - 1);  // the sign keeps all faces turned outwards
          p[(axis + 2) % 3] = 2.0 * v / rings - 1;
          return centre + radius * p / std::sqrt(glm::dot(p, p));
        };
        soup.add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        soup.add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
  return soup;
}

Soup torus(int around, int across, double major, double minor) {
  Soup soup;
  const auto at = [&](int i, int j) {
    const glm::dvec2 a = circle(i, around), b = circle(j, across);
    const double r = major + minor * b.x;
    return dvec3(r * a.x, minor * b.y, r * a.y);
  };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      soup.add(at(i, j), at(i, j + 1), at(i + 1, j + 1));
      soup.add(at(i, j), at(i + 1, j + 1), at(i + 1, j));
    }
  return soup;
}

Soup box(dvec3 low, dvec3 high) {
  Soup soup;
  const dvec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
  soup.quad(low, y, x), soup.quad(low + z, x, y);
  soup.quad(low, z, y), soup.quad(low + x, y, z);
  soup.quad(low, x, z), soup.quad(low + y, z, x);
  return soup;
}

Soup tilted_wall(Random& random) {
  const dvec3 n = random.direction(), u = any_across(random, n), v = glm::cross(n, u);
  const auto at = [&](double s, double t) { return s * u + t * v; };
  Soup soup;
  constexpr int cells = 8;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) {
      const double s = 2.0 * i / cells - 1, t = 2.0 * j / cells - 1, w = 2.0 / cells;
      if ((i + j) % 3 == 0) {  // T-junctions: one side of the cell split, its neighbour not
        const double cut = random.in(0.1, 0.9) * w;
        soup.add(at(s, t), at(s + w, t), at(s + cut, t + w));
        soup.add(at(s, t), at(s + cut, t + w), at(s, t + w));
        soup.add(at(s + w, t), at(s + w, t + w), at(s + cut, t + w));
      } else {
        soup.quad(at(s, t), w * u, w * v);
      }
    }
  for (int i = 0; i < 10; ++i) {
    const auto spot = [&] { return at(random.in(-1, 1), random.in(-1, 1)); };
    soup.add(spot(), spot(), spot());
  }
  soup.quad(at(-1, -1), 2.0 * v, 2.0 * u);  // the same wall, turned round
  return soup;
}

Soup slivers(Random& random, int count, double aspect) {
  Soup soup;
  for (int i = 0; i < count; ++i) {
    const dvec3 p = random.in_cube(1), along = random.direction();
    const dvec3 across = any_across(random, along) / aspect;
    soup.add(p, p + along, p + along * random.unit() + across);
  }
  soup.quad({-3, -1.5, -3}, {0, 0, 6}, {6, 0, 0});
  return soup;
}

Soup needle_fan(Random& random, int count) {
  Soup soup;
  const dvec3 apex = random.in_cube(0.3);
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 p = circle(i, count), q = circle(i + 1, count);
    soup.add(apex, {p.x, random.in(-0.01, 0.01), p.y}, {q.x, 0, q.y});
  }
  soup.quad({-3, -1.5, -3}, {0, 0, 6}, {6, 0, 0});
  return soup;
}

Soup duplicates(Random& random, int count, int copies) {
  Soup soup = random_soup(random, count, 0.4);
  for (int i = 0; i < count; ++i)
    for (int k = 1; k < copies; ++k) {
      const dvec3 a(soup.corner(static_cast<std::uint32_t>(i), 0)),
          b(soup.corner(static_cast<std::uint32_t>(i), 1)), c(soup.corner(static_cast<std::uint32_t>(i), 2));
      if (k % 2 == 0)
        soup.add(b, c, a);
      else
        soup.add(a, c, b);
    }
  return soup;
}

Soup coplanar(Random& random, int count) {
  const dvec3 n = random.direction(), u = any_across(random, n), v = glm::cross(n, u);
  const dvec3 origin = random.in_cube(1);
  Soup soup;
  const auto spot = [&] { return origin + random.in(-1, 1) * u + random.in(-1, 1) * v; };
  for (int i = 0; i < count; ++i) soup.add(spot(), spot(), spot());
  return soup;
}

Soup interpenetrating(Random& random, int count) {
  Soup soup;
  for (int i = 0; i < count; ++i) soup.add(random.direction(), random.direction(), -random.direction());
  return soup;
}

Soup wide_range(Random& random, int count) {
  Soup soup;
  const auto coordinate = [&] { return random.power_of_two(-26, 26); };
  const auto point = [&] {
    const double x = coordinate(), y = coordinate();
    return dvec3(x, y, coordinate());
  };
  for (int i = 0; i < count; ++i) {
    const dvec3 a = point(), b = point();
    soup.add(a, b, point());
  }
  return soup;
}

Soup with_zero_areas(Random& random, int count) {
  Soup soup = random_soup(random, count, 0.5);
  for (int i = 0; i < count; ++i) {
    const dvec3 a = random.in_cube(1), b = random.in_cube(1);
    soup.add(a, a, b);
    soup.add(a, a, a);
    const dvec3 corner(glm::ivec3(a * 64.0)), step(glm::ivec3(b * 8.0));  // collinear exactly
    soup.add(corner / 64.0, (corner + step) / 64.0, (corner + 3.0 * step) / 64.0);
  }
  return soup;
}

Soup equal_centroids(Random& random, int count) {
  Soup soup;
  for (int i = 0; i < count; ++i) {
    const dvec3 a = random.in_cube(1), b = random.in_cube(1);
    soup.add(a, b, -(a + b));
  }
  return soup;
}

Soup tiny_cluster(Random& random, int count) {
  Soup soup;
  for (int i = 0; i < count; ++i) {
    const dvec3 p = random.in_cube(0.02);
    soup.add(p + random.in_cube(2e-3), p + random.in_cube(2e-3), p + random.in_cube(2e-3));
  }
  soup.quad({-1, -0.1, -1}, {0, 0, 2}, {2, 0, 0});
  return soup;
}

Soup room(Random& random, int clutter) {
  Soup soup = box({-2, -1, -2}, {2, 2, 2});
  soup.append(sphere(8, 0.4, {0.5, -0.2, 0.3}));
  soup.append(torus(24, 12, 0.5, 0.15));
  soup.append(random_soup(random, clutter, 0.1));
  for (int i = 0; i < clutter / 20; ++i) {
    const dvec3 corner = random.in_cube(0.9);
    soup.append(box(corner, corner + dvec3(0.1, 0.2, 0.1)));
  }
  return soup;
}

std::vector<SoupMaker> soup_makers() {
  return {{"random large", [](Random& r) { return random_soup(r, 120, 1.0); }},
          {"random medium", [](Random& r) { return random_soup(r, 600, 0.2); }},
          {"random small", [](Random& r) { return random_soup(r, 3000, 0.05); }},
          {"room", [](Random& r) { return room(r, 200); }},
          {"spheres",
           [](Random& r) {
             Soup soup = sphere(12, 0.5, r.in_cube(0.5));
             soup.append(sphere(4, 0.3, r.in_cube(0.7)));
             soup.append(torus(32, 16, 0.8, 0.2));
             soup.quad({-2, -1, -2}, {0, 0, 4}, {4, 0, 0});
             return soup;
           }},
          {"tilted wall", tilted_wall},
          {"slivers 1e3", [](Random& r) { return slivers(r, 400, 1e3); }},
          {"slivers 1e6", [](Random& r) { return slivers(r, 400, 1e6); }},
          {"slivers 1e9", [](Random& r) { return slivers(r, 400, 1e9); }},
          {"needle fan", [](Random& r) { return needle_fan(r, 2000); }},
          {"duplicates", [](Random& r) { return duplicates(r, 40, 5); }},
          {"coplanar", [](Random& r) { return coplanar(r, 60); }},
          {"interpenetrating", [](Random& r) { return interpenetrating(r, 80); }},
          {"wide range", [](Random& r) { return wide_range(r, 200); }},
          {"zero areas", [](Random& r) { return with_zero_areas(r, 100); }},
          {"equal centroids", [](Random& r) { return equal_centroids(r, 100); }},
          {"tiny cluster", [](Random& r) { return tiny_cluster(r, 3000); }}};
}

}  // namespace tenebra::testing
