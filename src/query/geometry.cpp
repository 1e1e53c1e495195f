#include <tenebra/queries.h>

#include <algorithm>
#include <cmath>

#include "base/fail.h"
#include "math/whole_origin.h"
#include "query/geometry_data.h"

namespace tenebra {
namespace {

template <class Vector>
bool in_range(const Vector& p) {
  return std::abs(p.x) <= query::largest_coordinate && std::abs(p.y) <= query::largest_coordinate &&
         std::abs(p.z) <= query::largest_coordinate;  // false for NaN too
}

template <class Vector>
Expected<void> check_vertices(std::span<const Vector> positions) {
  const auto bad = std::find_if_not(positions.begin(), positions.end(), in_range<Vector>);
  if (bad == positions.end()) return {};
  return base::fail("geometry: vertex {} is ({}, {}, {}), expected finite coordinates of at most 1e18",
                    bad - positions.begin(), bad->x, bad->y, bad->z);
}

Expected<void> check_triangles(std::span<const glm::uvec3> triangles, std::size_t vertices) {
  const auto bad = std::find_if(triangles.begin(), triangles.end(), [&](const glm::uvec3& t) {
    return std::max({t.x, t.y, t.z}) >= vertices;
  });
  if (bad == triangles.end()) return {};
  return base::fail("geometry: triangle {} has the vertices {}, {} and {}, expected numbers below {}",
                    bad - triangles.begin(), bad->x, bad->y, bad->z, vertices);
}

glm::dvec3 origin_for(std::span<const glm::vec3>) {
  return glm::dvec3(0);
}
glm::dvec3 origin_for(std::span<const glm::dvec3> positions) {
  return math::whole_origin(positions);
}

template <class Vector>
void set_positions(std::span<const Vector> positions, query::GeometryData& data) {
  const Vector origin(data.origin);
  data.positions.resize(positions.size());
  std::transform(positions.begin(), positions.end(), data.positions.begin(),
                 [&](const Vector& p) { return glm::vec3(p - origin); });
}

double diagonal_of(std::span<const glm::vec3> positions) {
  if (positions.empty()) return 0;
  glm::vec3 low = positions.front(), high = low;
  for (const glm::vec3& p : positions) low = glm::min(low, p), high = glm::max(high, p);
  return glm::length(glm::dvec3(high) - glm::dvec3(low));
}

using Data = std::shared_ptr<query::GeometryData>;

template <class Vector>
Expected<Data> make_data(std::span<const Vector> positions, std::span<const glm::uvec3> triangles,
                         std::span<const std::uint8_t> casts_shadow) {
  if (triangles.size() >= no_triangle)
    return base::fail("geometry: found {} triangles, expected fewer than {}", triangles.size(), no_triangle);
  if (!casts_shadow.empty() && casts_shadow.size() != triangles.size())
    return base::fail("geometry: casts_shadow has {} elements, expected one for each of {} triangles",
                      casts_shadow.size(), triangles.size());
  if (auto checked = check_vertices(positions); !checked) return tl::unexpected(checked.error());
  if (auto checked = check_triangles(triangles, positions.size()); !checked)
    return tl::unexpected(checked.error());
  auto data = std::make_shared<query::GeometryData>();
  data->origin = origin_for(positions);
  set_positions(positions, *data);
  data->triangles.assign(triangles.begin(), triangles.end());
  data->casts_shadow.assign(casts_shadow.begin(), casts_shadow.end());
  data->diagonal = diagonal_of(data->positions);
  return data;
}

template <class Vector>
Expected<void> move_data(std::span<const Vector> positions, query::GeometryData& data) {
  if (positions.size() != data.positions.size())
    return base::fail("geometry: found {} vertices, expected {} as before", positions.size(),
                      data.positions.size());
  if (auto checked = check_vertices(positions); !checked) return checked;
  set_positions(positions, data);
  data.diagonal = diagonal_of(data.positions);
  ++data.revision;
  return {};
}

}  // namespace

Geometry::Geometry(std::shared_ptr<query::GeometryData> data) : data_(std::move(data)) {}
Geometry::Geometry(Geometry&&) noexcept = default;
Geometry& Geometry::operator=(Geometry&&) noexcept = default;
Geometry::~Geometry() = default;

Expected<Geometry> Geometry::create(std::span<const glm::vec3> positions,
                                    std::span<const glm::uvec3> triangles,
                                    std::span<const std::uint8_t> casts_shadow) {
  auto data = make_data(positions, triangles, casts_shadow);
  if (!data) return tl::unexpected(data.error());
  return Geometry(std::move(*data));
}

Expected<Geometry> Geometry::create(std::span<const glm::dvec3> positions,
                                    std::span<const glm::uvec3> triangles,
                                    std::span<const std::uint8_t> casts_shadow) {
  auto data = make_data(positions, triangles, casts_shadow);
  if (!data) return tl::unexpected(data.error());
  return Geometry(std::move(*data));
}

Expected<void> Geometry::move_vertices(std::span<const glm::vec3> positions) {
  return move_data(positions, *data_);
}
Expected<void> Geometry::move_vertices(std::span<const glm::dvec3> positions) {
  return move_data(positions, *data_);
}

glm::dvec3 Geometry::origin() const {
  return data_->origin;
}

TriangleView Geometry::view() const {
  return query::view_of(*data_);
}

}  // namespace tenebra
