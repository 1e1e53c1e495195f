#include "bench/ao/ao_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "parallel/parallel.h"
#include "support/seeded_random.h"

namespace tenebra::bench {
namespace {

using glm::dvec2;
using glm::vec3;

/// Shirley and Chiu 1997: squares about the centre become circles. a, b in -1 .. 1.
dvec2 concentric(double a, double b) {
  if (a == 0 && b == 0) return {0, 0};
  const bool wide = std::abs(a) > std::abs(b);
  const double r = wide ? a : b, quarter = std::numbers::pi / 4;
  const double angle = wide ? quarter * (b / a) : 2 * quarter - quarter * (a / b);
  return {r * std::cos(angle), r * std::sin(angle)};
}

/// Points of the unit square, sorted into blocks of sixteen about as wide as high.
std::vector<dvec2> lattice(int count) {
  std::vector<dvec2> points;
  for (int i = 0; i < count; ++i)
    points.emplace_back((i + 0.5) / count, std::fmod((i + 0.5) / std::numbers::phi, 1.0));
  const int blocks = count / trees::batch_size, columns = static_cast<int>(std::lround(std::sqrt(blocks)));
  for (int c = 0; c < columns; ++c) {
    const auto at = [&](int column) {
      return points.begin() + trees::batch_size * (blocks * column / columns);
    };
    std::sort(at(c), at(c + 1), [](const dvec2& a, const dvec2& b) { return a.y < b.y; });
  }
  return points;
}

std::uint64_t mixed(std::uint64_t seed, std::size_t index) {
  return testing::Random(seed * 0x9e3779b97f4a7c15u ^ index).bits();
}

/// Tangents across the normal, turned about it by `turn` radians.
std::array<vec3, 2> turned_tangents(const vec3& n, float turn) {
  const vec3 helper = std::abs(n.z) < 0.7f ? vec3(0, 0, 1) : vec3(1, 0, 0);
  const vec3 u = glm::normalize(glm::cross(helper, n)), v = glm::cross(n, u);
  const float c = std::cos(turn), s = std::sin(turn);
  return {c * u + s * v, c * v - s * u};
}

}  // namespace

vec3 cosine_direction(double x, double y) {
  const dvec2 d = concentric(2 * x - 1, 2 * y - 1);
  return {d.x, d.y, std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y))};
}

CosineRays::CosineRays(int count, std::uint64_t seed) : seed_(seed) {
  for (const dvec2& p : lattice(count)) directions_.push_back(cosine_direction(p.x, p.y));
}

void CosineRays::batches(const Receiver& receiver, std::size_t index, std::span<trees::RayBatch> out) const {
  const std::uint64_t hash = mixed(seed_, index);
  const auto turn = static_cast<float>(static_cast<double>(hash >> 11) * 0x1p-53 * 2 * std::numbers::pi);
  const auto [u, v] = turned_tangents(receiver.normal, turn);
  const vec3 p = receiver.position, n = receiver.normal;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const vec3 d = directions_[i];
    out[i / trees::batch_size].set(static_cast<int>(i % trees::batch_size), p, d.x * u + d.y * v + d.z * n);
  }
}

std::vector<float> occlusion(std::span<const Receiver> receivers, const CosineRays& rays, float distance,
                             const Tracer& tracer) {
  std::vector<float> result(receivers.size());
  parallel::parallel_ranges(receivers.size(), 32, [&](std::size_t first, std::size_t last) {
    std::vector<trees::RayBatch> batches(static_cast<std::size_t>(rays.count() / trees::batch_size));
    std::vector<float> t(static_cast<std::size_t>(rays.count()));
    for (std::size_t r = first; r < last; ++r) {
      rays.batches(receivers[r], r, batches);
      std::fill(t.begin(), t.end(), distance);
      tracer(batches, t.data());
      double sum = 0;
      for (const float hit : t) sum += 1 - static_cast<double>(hit) / static_cast<double>(distance);
      result[r] = static_cast<float>(sum / rays.count());
    }
  });
  return result;
}

std::vector<trees::RayBatch> batches_towards(std::span<const Receiver> receivers, const CosineRays& rays,
                                             glm::dvec3 centre, double radius) {
  std::vector<trees::RayBatch> result, own(static_cast<std::size_t>(rays.count() / trees::batch_size));
  int filled = 0;
  for (std::size_t r = 0; r < receivers.size(); ++r) {
    rays.batches(receivers[r], r, own);
    for (int i = 0; i < rays.count(); ++i) {
      const trees::RayBatch& batch = own[static_cast<std::size_t>(i / trees::batch_size)];
      const vec3 origin = batch.origin(i % trees::batch_size),
                 direction = batch.direction(i % trees::batch_size);
      const glm::dvec3 to = centre - glm::dvec3(origin), d = glm::normalize(glm::dvec3(direction));
      const double along = glm::dot(to, d), square = glm::dot(to, to);
      if (square > radius * radius && (along <= 0 || square - along * along >= radius * radius)) continue;
      if (filled == 0) result.emplace_back();
      result.back().set(filled, origin, direction);
      filled = (filled + 1) % trees::batch_size;
    }
  }
  if (filled != 0) result.pop_back();
  return result;
}

double rms_255(std::span<const float> a, std::span<const float> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    sum += d * d;
  }
  return a.empty() ? 0 : 255 * std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace tenebra::bench
