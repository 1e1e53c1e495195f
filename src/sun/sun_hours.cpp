#include "sun/sun_hours.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "base/fail.h"
#include "parallel/parallel.h"
#include "sun/glass.h"

namespace tenebra::sun {
namespace {

constexpr std::uint32_t most_at_a_time = 1u << 18;  // points, but for receivers that have more

template <class T>
std::span<const T> part_of(std::span<const T> all, std::size_t first, std::size_t count) {
  return all.empty() ? all : all.subspan(first, count);
}
QueryPoints part_of(const QueryPoints& points, std::size_t first, std::size_t count) {
  return {.positions = points.positions.subspan(first, count),
          .triangles = part_of(points.triangles, first, count),
          .normals = part_of(points.normals, first, count),
          .sides = part_of(points.sides, first, count)};
}

/// Receivers [first, end) and where their points begin.
struct Batch {
  std::size_t first, end;
  std::uint32_t points_begin, points_end;
};
Batch next_batch(std::span<const std::uint32_t> ends, std::size_t first) {
  const std::uint32_t begin = first == 0 ? 0 : ends[first - 1];
  std::size_t end = first + 1;
  while (end < ends.size() && ends[end] - begin <= most_at_a_time) ++end;
  return {first, end, begin, ends[end - 1]};
}

/// Which way a point's surface faces.
struct Facing {
  glm::dvec3 normal;  ///< unit
  bool both;          ///< it is the side that the sun is on

  double cosine(const glm::dvec3& to_sun) const {
    const double cosine = glm::dot(normal, to_sun);
    return both ? std::abs(cosine) : std::max(cosine, 0.0);
  }
};

Facing facing_of(const TriangleView& view, const QueryPoints& points, std::size_t i) {
  const glm::dvec3 given = points.normals.empty() ? glm::dvec3(0.0) : glm::dvec3(points.normals[i]);
  if (const double length = glm::length(given); length > 0) return {given / length, false};
  const std::uint32_t triangle = points.triangles.empty() ? no_triangle : points.triangles[i];
  // Numbers of no triangle are left to the tracer, which refuses them.
  if (triangle >= view.triangles.size()) return {glm::dvec3(0.0), triangle != no_triangle};
  const auto corner = [&](int k) { return glm::dvec3(view.positions[view.triangles[triangle][k]]); };
  const glm::dvec3 cross = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
  const double length = glm::length(cross);
  const int side = points.sides.empty() ? 0 : points.sides[i];
  if (!(length > 0)) return {glm::dvec3(0.0), true};
  return {cross / (side < 0 ? -length : length), side == 0};
}

/// How much each point of a batch sees of a sun: marks of a mask, or shares of a disc.
struct Sight {
  std::span<const std::uint8_t> mask;
  std::span<const float> shares;

  double of(std::size_t i) const {
    return mask.empty() ? static_cast<double>(shares[i]) : mask[i] != 0 ? 1.0 : 0.0;
  }
};
/// Of some points, added up in their order.
struct Seen {
  double sum = 0, cosines = 0;
};
Seen seen_of(const Sight& sight, std::size_t first, std::size_t end, std::span<const Facing> facings,
             const glm::dvec3& to_sun) {
  Seen seen;
  for (std::size_t i = first; i < end; ++i) {
    const double part = sight.of(i);
    seen.sum += part;
    if (part > 0 && !facings.empty()) seen.cosines += part * facings[i].cosine(to_sun);
  }
  return seen;
}

/// Adds what the batch sees of sun `number`.
void add(const Sight& sight, const Batch& batch, std::span<const std::uint32_t> ends,
         std::span<const Facing> facings, const Sun& sun, std::int32_t number, SunHours& out) {
  parallel::parallel_ranges(batch.end - batch.first, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = batch.first + begin; r < batch.first + end; ++r) {
      const std::uint32_t first = r == 0 ? 0 : ends[r - 1];
      const Seen seen =
          seen_of(sight, first - batch.points_begin, ends[r] - batch.points_begin, facings, sun.to_sun);
      if (!(seen.sum > 0)) continue;
      const double weights = sun.weight * seen.sum, light = sun.light_wh_m2 * seen.cosines;
      out.sums[r] += weights;
      if (!out.light.empty()) out.light[r] += light;
      if (!out.months.empty())
        out.months[12 * r + static_cast<std::size_t>(sun.month)] += out.light.empty() ? weights : light;
      if (out.first[r] < 0) out.first[r] = number;
      out.last[r] = number;
    }
  });
}

using Use = std::function<void(std::size_t sun, const Sight& sight)>;

Expected<void> see_points(PointTracer& tracer, const Geometry& geometry, const QueryPoints& points,
                          std::span<const Sun> suns, const HoursConfig& config, const StopFlag* stop,
                          const Use& use) {
  std::vector<ShadowLight> lights;
  for (const Sun& sun : suns) lights.push_back({.directional = true, .to_light = glm::vec3(sun.to_sun)});
  std::optional<Glass> glass;
  if (config.glass != nullptr) glass.emplace(*config.glass, geometry, points);
  std::vector<float> shares(glass ? points.positions.size() : 0);
  bool whole = true;
  auto done = tracer.hard_masks(
      geometry, points, lights, config.hard,
      [&](std::size_t sun, std::span<const std::uint8_t> mask) {
        for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = mask[i] != 0 ? 1.0f : 0.0f;
        whole = whole && (!glass || glass->dim(lights[sun], shares, stop));
        use(sun, shares.empty() ? Sight{mask, {}} : Sight{{}, shares});
      },
      stop);
  return whole ? done : base::stopped();
}

Expected<void> see_discs(PointTracer& tracer, const Geometry& geometry, const QueryPoints& points,
                         std::span<const Sun> suns, const HoursConfig& config, const StopFlag* stop,
                         const Use& use) {
  std::vector<float> shares(points.positions.size());
  std::optional<Glass> glass;
  if (config.glass != nullptr) glass.emplace(*config.glass, geometry, points);
  for (std::size_t s = 0; s < suns.size(); ++s) {
    const auto disc = make_sun(glm::vec3(suns[s].to_sun), config.disc_deg);
    if (!disc) return tl::unexpected(disc.error());
    auto done = tracer.soft_visibility(geometry, points, *disc, config.soft, shares, {}, stop);
    if (!done) return done;
    if (glass && !glass->dim({.directional = true, .to_light = glm::vec3(suns[s].to_sun)}, shares, stop))
      return base::stopped();
    use(s, {{}, shares});
  }
  return {};
}

void divide_by_points(std::span<const std::uint32_t> ends, SunHours& out) {
  for (std::size_t r = 0; r < ends.size(); ++r) {
    const double points = ends[r] - (r == 0 ? 0 : ends[r - 1]);
    out.sums[r] /= points;
    if (!out.light.empty()) out.light[r] /= points;
    for (std::size_t m = 12 * r; m < std::min(12 * r + 12, out.months.size()); ++m) out.months[m] /= points;
  }
}

std::vector<Facing> facings_of(const Geometry& geometry, const QueryPoints& points) {
  std::vector<Facing> facings;
  const TriangleView view = geometry.view();
  for (std::size_t i = 0; i < points.positions.size(); ++i) facings.push_back(facing_of(view, points, i));
  return facings;
}

}  // namespace

Expected<void> check_facings(const QueryPoints& points) {
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    const bool on_face = !points.triangles.empty() && points.triangles[i] != no_triangle;
    if (!on_face && (points.normals.empty() || !(glm::length(glm::dvec3(points.normals[i])) > 0)))
      return base::fail(
          "point {} lies on no face and has no normal, expected one (columns nx, ny, nz): light on a surface "
          "depends on where it faces",
          i);
  }
  return {};
}

Expected<SunHours> sun_hours(const Geometry& geometry, const QueryPoints& points,
                             std::span<const std::uint32_t> ends, std::span<const Sun> suns,
                             const HoursConfig& config, const StopFlag* stop, const QueryProgress& progress) {
  if (config.light)
    if (auto facing = check_facings(points); !facing) return tl::unexpected(facing.error());
  const std::size_t count = ends.size();
  SunHours out{std::vector<double>(count),
               std::vector<std::int32_t>(count, -1),
               std::vector<std::int32_t>(count, -1),
               {},
               {}};
  if (config.light) out.light.resize(count);
  if (config.months) out.months.resize(12 * count);
  PointTracer tracer;
  for (std::size_t first = 0; first < count;) {
    const Batch batch = next_batch(ends, first);
    const QueryPoints asked = part_of(points, batch.points_begin, batch.points_end - batch.points_begin);
    const auto facings = config.light ? facings_of(geometry, asked) : std::vector<Facing>();
    const auto use = [&](std::size_t s, const Sight& sight) {
      add(sight, batch, ends, facings, suns[s], static_cast<std::int32_t>(s), out);
      const double part = static_cast<double>(batch.points_end - batch.points_begin) *
                          static_cast<double>(s + 1) / static_cast<double>(suns.size());
      if (progress) progress((batch.points_begin + part) / static_cast<double>(ends.back()));
    };
    const auto see = config.disc_deg > 0 ? see_discs : see_points;
    auto seen = see(tracer, geometry, asked, suns, config, stop, use);
    if (!seen) return tl::unexpected(seen.error());
    first = batch.end;
  }
  divide_by_points(ends, out);
  return out;
}

Expected<SunHours> sun_hours(const Geometry& geometry, const Receivers& receivers, const Suns& suns,
                             HoursConfig config, const StopFlag* stop, const QueryProgress& progress) {
  config.light = suns.kind == SunKind::radiation;
  return sun_hours(geometry, receivers.points(), receivers.ends(), suns.list, config, stop, progress);
}

}  // namespace tenebra::sun
