#include "ao/receivers/receiver_sets.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "parallel/parallel.h"

namespace tenebra::ao {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr int tile = 16;
static_assert(tile <= ReceiverMaker::most_fetched);

}  // namespace

PixelReceivers::PixelReceivers(const AoFrame& frame, int step, float reach)
    : frame_(frame),
      step_(step),
      width_((frame.points.width + step - 1) / step),
      height_((frame.points.height + step - 1) / step),
      columns_((width_ + tile - 1) / tile),
      rows_((height_ + tile - 1) / tile),
      reach_(reach) {}

std::size_t PixelReceivers::pixel(int x, int y) const {
  const int px = std::min(x * step_ + step_ / 2, frame_.points.width - 1);
  const int py = std::min(y * step_ + step_ / 2, frame_.points.height - 1);
  return static_cast<std::size_t>(py) * static_cast<std::size_t>(frame_.points.width) +
         static_cast<std::size_t>(px);
}

void PixelReceivers::receivers(int group, std::vector<Receiver>& out) const {
  out.clear();
  ReceiverMaker maker(frame_.geometry, frame_.objects);
  const int x0 = group % columns_ * tile, y0 = group / columns_ * tile;
  std::uint32_t triangles[tile];
  for (int y = y0; y < std::min(y0 + tile, height_); ++y) {
    const int count = std::min(tile, width_ - x0);
    for (int k = 0; k < count; ++k) triangles[k] = frame_.points.triangles[pixel(x0 + k, y)];
    maker.fetch({triangles, static_cast<std::size_t>(count)});
    for (int x = x0; x < x0 + count; ++x) {
      const std::size_t i = pixel(x, y);
      Receiver& receiver = out.emplace_back();
      receiver.index =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
      if (!maker.make(frame_.points.triangles[i], frame_.points.positions[i], frame_.normals[i], receiver))
        out.pop_back();
    }
  }
}

void PixelReceivers::spread(std::span<const float> values, std::span<float> pixels) const {
  if (step_ == 1) {
    std::copy(values.begin(), values.end(), pixels.begin());
    return;
  }
  const int width = frame_.points.width;
  parallel::parallel_ranges(static_cast<std::size_t>(frame_.points.height), 8,
                            [&](std::size_t first, std::size_t last) {
                              for (std::size_t y = first; y < last; ++y) {
                                for (int x = 0; x < width; ++x)
                                  pixels[y * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
                                      blurred(values, x, static_cast<int>(y));
                              }
                            });
}

/// Joint bilateral: the 4 x 4 coarse pixels around, by their distance in the picture, how far each lies off
/// this one's tangent plane and how their normals differ. Where all of them differ, the one most alike
/// counts.
float PixelReceivers::blurred(std::span<const float> values, int x, int y) const {
  const std::size_t here = static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_.points.width) +
                           static_cast<std::size_t>(x);
  if (frame_.points.triangles[here] == no_triangle) return 1;
  const dvec3 p = frame_.points.positions[here];
  const vec3 n = frame_.normals[here];
  const float fx = (static_cast<float>(x - step_ / 2)) / static_cast<float>(step_);
  const float fy = (static_cast<float>(y - step_ / 2)) / static_cast<float>(step_);
  const int x0 = static_cast<int>(std::floor(fx)) - 1, y0 = static_cast<int>(std::floor(fy)) - 1;
  const int x1 = std::min(x0 + 4, width_), y1 = std::min(y0 + 4, height_);
  const auto value_at = [&](int cx, int cy) {
    return values[static_cast<std::size_t>(cy) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(cx)];
  };
  float least = 1, most = 0;
  for (int cy = std::max(0, y0); cy < y1; ++cy) {
    for (int cx = std::max(0, x0); cx < x1; ++cx)
      least = std::min(least, value_at(cx, cy)), most = std::max(most, value_at(cx, cy));
  }
  if (least >= most) return least;  // all alike: nothing to weigh
  float sum = 0, total = 0, nearest = 1, best = -1;
  for (int cy = std::max(0, y0); cy < y1; ++cy) {
    for (int cx = std::max(0, x0); cx < x1; ++cx) {
      const std::size_t there = pixel(cx, cy);
      if (frame_.points.triangles[there] == no_triangle) continue;
      const float dx = static_cast<float>(cx) - fx, dy = static_cast<float>(cy) - fy;
      const auto off =
          static_cast<float>(std::abs(glm::dot(frame_.points.positions[there] - p, dvec3(n)))) / reach_;
      const float alike = std::max(0.0f, glm::dot(n, frame_.normals[there]));
      const float a2 = alike * alike, a4 = a2 * a2;
      const float x_weight = 1 - dx * dx / 4, y_weight = 1 - dy * dy / 4;  // 0 at the window's edge
      const float plane = 1 / (1 + 8 * off), plane2 = plane * plane;
      const float weight = x_weight * x_weight * y_weight * y_weight * a4 * a4 * plane2 * plane2;
      const float value = value_at(cx, cy);
      sum += weight * value, total += weight;
      if (weight > best) best = weight, nearest = value;
    }
  }
  return total > 1e-6f ? sum / total : nearest;
}

VertexReceivers::VertexReceivers(const AoFrame& frame) : frame_(frame) {
  const VisiblePoints& points = frame.points;
  slots_.assign(frame.geometry.triangles.size(), no_triangle);
  std::vector<std::size_t> seen;  // the first pixel of each visible triangle
  for (std::size_t i = 0; i < points.triangles.size(); ++i) {
    const std::uint32_t id = points.triangles[i];
    if (id >= slots_.size() || slots_[id] != no_triangle) continue;
    slots_[id] = static_cast<std::uint32_t>(seen.size());
    seen.push_back(i);
  }
  std::unordered_map<std::uint64_t, std::uint32_t> shared;  // vertex and side -> index
  corners_.resize(seen.size());
  for (std::size_t s = 0; s < seen.size(); ++s) {
    const std::uint32_t id = points.triangles[seen[s]];
    const glm::uvec3 t = frame.geometry.triangles[id];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto fresh = static_cast<std::uint32_t>(vertices_.size());
      const vec3 own = frame.geometry.normals[t[static_cast<int>(k)]];
      const vec3 normal = corner_normal(id, k, frame.normals[seen[s]]);
      corners_[s].index[k] = fresh;
      if (own != vec3(0.0f)) {
        const bool turned = glm::dot(own, normal) < 0;
        const std::uint64_t key = 2 * std::uint64_t{t[static_cast<int>(k)]} + (turned ? 1 : 0);
        const auto [at, is_new] = shared.emplace(key, fresh);
        corners_[s].index[k] = at->second;
        if (!is_new) continue;
      }
      vertices_.push_back({id, k, normal});
    }
  }
}

/// On the side that `seen`, a shading normal of the triangle, shows.
vec3 VertexReceivers::corner_normal(std::uint32_t triangle, std::uint32_t corner, const vec3& seen) const {
  const glm::uvec3 t = frame_.geometry.triangles[triangle];
  const dvec3 a(frame_.geometry.positions[t.x]);
  const dvec3 n =
      glm::cross(dvec3(frame_.geometry.positions[t.y]) - a, dvec3(frame_.geometry.positions[t.z]) - a);
  const double square = glm::dot(n, n);
  if (!(square > 0)) return vec3(0.0f);
  vec3 face(n / std::sqrt(square));
  if (glm::dot(face, seen) < 0) face = -face;
  const vec3 own = frame_.geometry.normals[t[static_cast<int>(corner)]];
  if (own == vec3(0.0f)) return face;
  return glm::dot(own, face) < 0 ? -own : own;
}

void VertexReceivers::receivers(int group, std::vector<Receiver>& out) const {
  constexpr double pull = 1.0 / 64;  // into the triangle: clear of what touches it at the corner
  out.clear();
  ReceiverMaker maker(frame_.geometry, frame_.objects);
  const std::size_t first = static_cast<std::size_t>(group) * group_size;
  for (std::size_t i = first; i < std::min(first + group_size, vertices_.size()); ++i) {
    const Vertex& vertex = vertices_[i];
    const glm::uvec3 t = frame_.geometry.triangles[vertex.triangle];
    const dvec3 corner(frame_.geometry.positions[t[static_cast<int>(vertex.corner)]]);
    const dvec3 middle = (dvec3(frame_.geometry.positions[t.x]) + dvec3(frame_.geometry.positions[t.y]) +
                          dvec3(frame_.geometry.positions[t.z])) /
                         3.0;
    Receiver receiver;
    if (!maker.make(vertex.triangle, corner + pull * (middle - corner), vertex.normal, receiver)) continue;
    receiver.index = i;
    out.push_back(receiver);
  }
}

void VertexReceivers::spread(std::span<const float> values, std::span<float> pixels) const {
  const VisiblePoints& points = frame_.points;
  parallel::parallel_ranges(pixels.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t id = points.triangles[i];
      pixels[i] = 1;
      if (id >= slots_.size()) continue;
      const glm::uvec3 t = frame_.geometry.triangles[id];
      const dvec3 a(frame_.geometry.positions[t.x]);
      const dvec3 e1 = dvec3(frame_.geometry.positions[t.y]) - a,
                  e2 = dvec3(frame_.geometry.positions[t.z]) - a;
      const dvec3 n = glm::cross(e1, e2), p = points.positions[i] - a;
      const double area2 = glm::dot(n, n);
      if (!(area2 > 0) || !std::isfinite(p.x + p.y + p.z)) continue;
      const double v = std::clamp(glm::dot(glm::cross(e2, n), p) / area2, 0.0, 1.0);
      const double w = std::clamp(glm::dot(glm::cross(n, e1), p) / area2, 0.0, 1.0 - v);
      const Corners3& c = corners_[slots_[id]];
      pixels[i] = static_cast<float>((1 - v - w) * values[c.index[0]] + v * values[c.index[1]] +
                                     w * values[c.index[2]]);
    }
  });
}

}  // namespace tenebra::ao
