#include "soft/shaft.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tenebra {

namespace {

using glm::dvec3;

double largest(const dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

double sum(const dvec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

// The corner of the cell, and the vertex of the light, farthest along m.
dvec3 farthest(const Cell& cell, const dvec3& m) {
  dvec3 corner = cell.centre;
  for (const dvec3& a : cell.axis) corner += glm::dot(m, a) > 0 ? a : -a;
  return corner;
}
dvec3 farthest(const LightShape& light, const dvec3& m) {
  int best = 0;
  double most = -INFINITY;
  for (int k = 0; k < light.count; ++k) {
    const double along = glm::dot(m, light.vertices[k]);
    if (along > most) most = along, best = k;
  }
  return light.vertices[best];
}

}  // namespace

LightShape::LightShape(const AreaLight& light) : origin(light.centre), normal(light.normal) {
  for (const glm::dvec2& v : light.outline) {
    assert(count < most_light_vertices);
    vertices[count] = v.x * light.ex + v.y * light.ey;
    reach = std::max(reach, largest(vertices[count]));
    ++count;
  }
}

Cell box_cell(const dvec3& low, const dvec3& high, const LightShape& light) {
  Cell cell;
  cell.centre = 0.5 * (low + high) - light.origin;
  const dvec3 half = 0.5 * (high - low);
  cell.axis = {dvec3(half.x, 0, 0), dvec3(0, half.y, 0), dvec3(0, 0, half.z)};
  cell.slack = 0x1p-50 * (largest(low) + largest(high) + largest(light.origin));
  cell.reach = largest(cell.centre) + largest(half) + cell.slack;
  return cell;
}

Cell fitted_cell(std::span<const dvec3> points, std::span<const std::uint32_t> pixels, int width,
                 const dvec3& low, const dvec3& high, const LightShape& light) {
  const auto columns = static_cast<std::uint32_t>(width);
  const dvec3 base = 0.5 * (low + high);
  // Slopes of the position along rows and columns, up to a factor: sum of (x - mean x) p.
  dvec3 r(0), c(0), all(0);
  double x_sum = 0, y_sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dvec3 p = points[i] - base;
    const std::uint32_t row = pixels[i] / columns;
    const double x = pixels[i] - row * columns, y = row;
    r += x * p, c += y * p, all += p;
    x_sum += x, y_sum += y;
  }
  const auto count = static_cast<double>(points.size());
  r -= x_sum / count * all, c -= y_sum / count * all;
  const double r_length = std::sqrt(glm::dot(r, r)), c_length = std::sqrt(glm::dot(c, c));
  r /= r_length, c /= c_length;
  dvec3 n = glm::cross(r, c);
  const double sine = std::sqrt(glm::dot(n, n));
  if (!(sine > 0x1p-4)) return box_cell(low, high, light);
  n /= sine;
  // p = (p.dual_r) r + (p.dual_c) c + (p.n) n up to 2^-42 |p|: units within 4u, the normal within 2^-45.
  const dvec3 dual_r = glm::cross(c, n) / sine, dual_c = glm::cross(n, r) / sine;
  dvec3 least(INFINITY), most(-INFINITY);
  for (const dvec3& point : points) {
    const dvec3 p = point - base;
    const dvec3 place(glm::dot(dual_r, p), glm::dot(dual_c, p), glm::dot(n, p));
    least = glm::min(least, place), most = glm::max(most, place);
  }
  const dvec3 middle = 0.5 * (least + most), half = 0.5 * (most - least);
  Cell cell;
  cell.centre = (base - light.origin) + middle.x * r + middle.y * c + middle.z * n;
  cell.axis = {half.x * r, half.y * c, half.z * n};
  cell.slack = 0x1p-40 * sum(high - low) + 0x1p-49 * (largest(base) + largest(light.origin));
  cell.reach = largest(cell.centre) + half.x + half.y + half.z + cell.slack;
  return cell;
}

Shaft::Shaft(const Cell& of, const LightShape& to) : cell(of), light(&to) {
  low = dvec3(INFINITY), high = dvec3(-INFINITY);
  for (int k = 0; k < to.count; ++k)
    low = glm::min(low, to.vertices[k]), high = glm::max(high, to.vertices[k]);
  const dvec3 half = glm::abs(cell.axis[0]) + glm::abs(cell.axis[1]) + glm::abs(cell.axis[2]);
  const double margin = cell.slack + 0x1p-49 * (cell.reach + to.reach + largest(to.origin));
  low = glm::min(low, cell.centre - half) - margin;
  high = glm::max(high, cell.centre + half) + margin;
  add_plane(-to.normal);
  add_light_edges();
  for (const dvec3& a : cell.axis) add_tangents(a);
}

// Any m gives a valid plane: its limit is the farthest that the shaft reaches along m.
void Shaft::add_plane(dvec3 m) {
  const double size = sum(m);
  if (!(size > 0)) return;
  m /= size * (1 + 0x1p-50);
  double most = glm::dot(m, cell.centre) + cell.slack;
  for (const dvec3& a : cell.axis) most += std::abs(glm::dot(m, a));
  most = std::max(most, glm::dot(m, farthest(*light, m)));
  planes[plane_count++] = {m, most + 0x1p-49 * (cell.reach + light->reach + largest(light->origin))};
}

// The two planes parallel to an edge of the cell that touch cell and light. The touching corners are searched
// from the normal across the line between the centres; each step turns the plane towards them.
void Shaft::add_tangents(const dvec3& along) {
  const double length = std::sqrt(glm::dot(along, along));
  if (!(length > 0)) return;
  const dvec3 unit = along / length;
  for (const double sign : {1.0, -1.0}) {
    dvec3 m = sign * glm::cross(unit, cell.centre);
    for (int step = 0; step < 2; ++step) {
      const dvec3 span = farthest(cell, m) - farthest(*light, m);
      m = sign * glm::cross(unit, span);
    }
    add_plane(m);
  }
}

// Planes through the light's edges that touch the cell: m = o - t normal, o across the edge in the light's
// plane and t the largest (x.o) / (x.normal) of the corners x seen from the edge.
void Shaft::add_light_edges() {
  const LightShape& l = *light;
  double height[8];
  dvec3 corner[8];
  for (int k = 0; k < 8; ++k) {
    corner[k] = cell.centre + (k & 1 ? cell.axis[0] : -cell.axis[0]) +
                (k & 2 ? cell.axis[1] : -cell.axis[1]) + (k & 4 ? cell.axis[2] : -cell.axis[2]);
    height[k] = glm::dot(corner[k], l.normal);
    if (!(height[k] > 0)) return;
  }
  for (int j = 0; j < l.count; ++j) {
    const dvec3 q = l.vertices[j];
    const dvec3 o = glm::cross(l.vertices[j + 1 < l.count ? j + 1 : 0] - q, l.normal);
    const double at_edge = glm::dot(o, q);
    double t = -INFINITY;
    for (int k = 0; k < 8; ++k) t = std::max(t, (glm::dot(o, corner[k]) - at_edge) / height[k]);
    if (std::isfinite(t)) add_plane(o - t * l.normal);
  }
}

}  // namespace tenebra
