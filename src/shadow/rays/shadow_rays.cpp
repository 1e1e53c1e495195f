#include "shadow/rays/shadow_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "parallel/parallel.h"
#include "points/sample_sides.h"
#include "shadow/decision/lifted_points.h"
#include "shadow/rays/direction_keys.h"

namespace tenebra::shadow {

namespace {

using glm::dvec3;

constexpr std::uint32_t tile = 64;  // side, in pixels, of the squares that run in parallel

constexpr std::uint32_t even_bits(std::uint32_t v) {
  std::uint32_t r = 0;
  for (int bit = 0; bit < 16; ++bit) r |= ((v >> (2 * bit)) & 1u) << bit;
  return r;
}

// Pixels of a tile along a Z curve.
struct Offset {
  std::uint8_t x, y;
};
constexpr auto z_curve = [] {
  std::array<Offset, tile * tile> offsets{};
  for (std::uint32_t z = 0; z < tile * tile; ++z) {
    offsets[z] = {static_cast<std::uint8_t>(even_bits(z)), static_cast<std::uint8_t>(even_bits(z >> 1))};
  }
  return offsets;
}();

struct Tiles {
  std::uint32_t columns, rows;
};
Tiles tiles_of(const VisiblePoints& points) {
  return {(static_cast<std::uint32_t>(points.width) + tile - 1) / tile,
          (static_cast<std::uint32_t>(points.height) + tile - 1) / tile};
}

// Bits of `v` moved to the even places.
std::uint64_t spread(std::uint32_t v) {
  std::uint64_t r = 0;
  for (int bit = 0; bit < 32; ++bit) r |= static_cast<std::uint64_t>((v >> bit) & 1u) << (2 * bit);
  return r;
}

// Tiles (row * columns + column) along a Z curve.
std::vector<std::uint32_t> tile_order(Tiles tiles) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> places;
  places.reserve(static_cast<std::size_t>(tiles.columns) * tiles.rows);
  for (std::uint32_t row = 0; row < tiles.rows; ++row) {
    for (std::uint32_t column = 0; column < tiles.columns; ++column) {
      places.emplace_back(spread(column) | spread(row) << 1, row * tiles.columns + column);
    }
  }
  std::sort(places.begin(), places.end());
  std::vector<std::uint32_t> order;
  order.reserve(places.size());
  for (const auto& [key, place] : places) order.push_back(place);
  return order;
}

struct Plane2 {
  dvec3 x{0}, y{0};  // unit, across the light's travel
  double centre_x = 0, centre_y = 0, scale = 0;

  /// As a direction through the cube's +Z face: parallel rays get the keys of their places across the light.
  dvec3 project(const dvec3& p) const {
    return {(glm::dot(p, x) - centre_x) * scale, (glm::dot(p, y) - centre_y) * scale, 1};
  }
};

Plane2 plane_across(const VisiblePoints& points, const RaySource& source,
                    const std::vector<std::uint32_t>& pixels) {
  const dvec3 t = source.travel;
  const dvec3 other = std::abs(t.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  Plane2 plane;
  plane.x = glm::normalize(glm::cross(t, other));
  plane.y = glm::cross(t, plane.x);
  double low_x = INFINITY, high_x = -INFINITY, low_y = INFINITY, high_y = -INFINITY;
  for (const std::uint32_t pixel : pixels) {
    const dvec3& p = points.positions[pixel];
    const double x = glm::dot(p, plane.x), y = glm::dot(p, plane.y);
    low_x = std::min(low_x, x), high_x = std::max(high_x, x);
    low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  }
  plane.centre_x = 0.5 * (low_x + high_x);
  plane.centre_y = 0.5 * (low_y + high_y);
  const double extent = std::max(high_x - low_x, high_y - low_y);
  plane.scale = extent > 0 ? 2 / extent : 0;
  return plane;
}

}  // namespace

bool in_reach(const dvec3& p, const ShadowLight& light) {
  if (light.directional) return true;
  const double distance2 = p.x * p.x + p.y * p.y + p.z * p.z;
  if (light.range_m > 0 && distance2 > static_cast<double>(light.range_m) * light.range_m) return false;
  if (light.spot_cos_outer <= -1) return true;
  const double along = p.x * light.spot_axis.x + p.y * light.spot_axis.y + p.z * light.spot_axis.z;
  return along >= light.spot_cos_outer * std::sqrt(distance2);
}

// Each test of in_reach takes the sign of a function whose slope is at most 1 (range) or |axis| + |cosine|
// (cone). Doubles are off by far less than 2^-40 of what they add up.
Reach reach_of_ball(const dvec3& centre, double radius, const ShadowLight& light) {
  if (light.directional) return Reach::all;
  const double distance = glm::length(centre);
  bool all = true;
  const auto nothing_reached = [&](double value, double steepness) {
    const double change = steepness * (radius + 0x1p-40 * (distance + radius));
    all &= value > change;
    return value < -change;
  };
  if (light.range_m > 0 && nothing_reached(double{light.range_m} - distance, 1)) return Reach::none;
  if (light.spot_cos_outer > -1) {
    const dvec3 axis(light.spot_axis);
    const double cosine = light.spot_cos_outer;
    if (nothing_reached(glm::dot(centre, axis) - cosine * distance, glm::length(axis) + std::abs(cosine)))
      return Reach::none;
  }
  return all ? Reach::all : Reach::some;
}

void generate_shadow_rays(const VisiblePoints& points, const TriangleView& triangles,
                          const ShadowLight& light, const RaySource& source, const TriangleSet& set,
                          RayKeys& scratch, ShadowRays& out, std::vector<std::uint32_t>& at_light) {
  const Tiles tiles = tiles_of(points);
  const std::vector<std::uint32_t> order = tile_order(tiles);
  const std::size_t tile_count = order.size();

  // Each tile lists its pixels in a slot of its own; the slots are then closed up.
  const std::size_t slot = std::min<std::size_t>(tile, static_cast<std::size_t>(points.width)) *
                           std::min<std::size_t>(tile, static_cast<std::size_t>(points.height));
  out.pixels.resize(tile_count * slot);
  std::vector<float> tau(tile_count, 0.0f);
  std::vector<std::vector<std::uint32_t>> met(tile_count);
  scratch.counts.assign(tile_count, 0);
  const auto reached = [&](std::uint32_t pixel, points::SideFinder& sides) {
    const std::uint32_t id = points.triangles[pixel];
    if (id == free_point) return in_reach(points.positions[pixel] - source.origin, light);
    if (id >= set.facing.size() || set.facing[id] == 0) return false;
    const int side = sides.at(pixel);
    const auto faces = static_cast<Faces>(side == 0 ? 0 : set.facing[id] >> (side < 0 ? 2 : 0) & 3);
    if (faces == Faces::away) return false;
    const dvec3& p = points.positions[pixel];
    if (faces == Faces::beyond && !SeesPast(triangles, id, side, source).from(p)) return false;
    return in_reach(p - source.origin, light);
  };
  const auto tau_of = [&](std::uint32_t pixel) {
    const std::uint32_t id = points.triangles[pixel];
    if (id != free_point) return set.tau[id];
    const double tau = points::own_tolerance(triangles, id, points.positions[pixel]);
    return std::nextafter(static_cast<float>(tau), std::numeric_limits<float>::infinity());
  };
  parallel::parallel_tasks(static_cast<int>(tile_count), [&](int t) {
    const std::uint32_t left = order[t] % tiles.columns * tile, top = order[t] / tiles.columns * tile;
    std::uint32_t count = 0;
    points::SideFinder sides(points, triangles);
    std::uint32_t* const slots = &out.pixels[static_cast<std::size_t>(t) * slot];
    for (const Offset offset : z_curve) {
      const std::uint32_t x = left + offset.x, y = top + offset.y;
      if (x >= static_cast<std::uint32_t>(points.width) || y >= static_cast<std::uint32_t>(points.height))
        continue;
      const std::uint32_t pixel = y * static_cast<std::uint32_t>(points.width) + x;
      if (!reached(pixel, sides)) continue;
      if (!source.directional && points.positions[pixel] == source.origin) {
        met[t].push_back(pixel);
        continue;
      }
      slots[count++] = pixel;
      tau[t] = std::max(tau[t], tau_of(pixel));
    }
    scratch.counts[t] = count;
  });

  at_light.clear();
  out.tau_max = 0;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < tile_count; ++t) {
    std::copy_n(out.pixels.begin() + static_cast<std::size_t>(t) * slot, scratch.counts[t],
                out.pixels.begin() + kept);
    kept += scratch.counts[t];
    out.tau_max = std::max(out.tau_max, tau[t]);
    at_light.insert(at_light.end(), met[t].begin(), met[t].end());
  }
  out.pixels.resize(kept);
  out.triangles.resize(kept);
  parallel::parallel_ranges(kept, 1 << 15, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) out.triangles[i] = points.triangles[out.pixels[i]];
  });
}

void sort_shadow_rays(const VisiblePoints& points, const RaySource& source, SimdLevel simd, RayKeys& scratch,
                      ShadowRays& rays) {
  constexpr std::size_t at_once = 16;  // keys
  const DirectionKeys direction_keys = direction_keys_kernel(simd);
  const Plane2 plane = source.directional ? plane_across(points, source, rays.pixels) : Plane2{};
  scratch.keys.resize(rays.pixels.size());
  parallel::parallel_ranges(rays.pixels.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    float x[at_once] = {}, y[at_once] = {}, z[at_once] = {};
    std::uint32_t keys[at_once];
    for (std::size_t i = first; i < last; i += at_once) {
      const std::size_t count = std::min<std::size_t>(at_once, last - i);
      for (std::size_t k = 0; k < count; ++k) {
        const dvec3 p = points.positions[rays.pixels[i + k]] - source.origin;
        const dvec3 seen = source.directional ? plane.project(p) : p;
        x[k] = static_cast<float>(seen.x), y[k] = static_cast<float>(seen.y),
        z[k] = static_cast<float>(seen.z);
      }
      direction_keys(x, y, z, keys);
      for (std::size_t k = 0; k < count; ++k)
        scratch.keys[i + k] = static_cast<std::uint64_t>(keys[k]) << 32 | rays.pixels[i + k];
    }
  });
  radix_sort(scratch.keys, scratch);
  parallel::parallel_ranges(rays.pixels.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      rays.pixels[i] = static_cast<std::uint32_t>(scratch.keys[i]);
      rays.triangles[i] = points.triangles[rays.pixels[i]];
    }
  });
}

}  // namespace tenebra::shadow
