#include "ao/self_occlusion.h"

#include <algorithm>
#include <cmath>

#include "ao/sphere_maps.h"
#include "parallel/parallel.h"

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;

// A value is unknown, buried, or 2 x (0..most) + (something is near).
constexpr std::uint16_t unknown = 0xffff, buried = 0xfffe;
constexpr float most = 32766.0f;
constexpr std::uint32_t refinement = 4;  // fine steps a wide one
constexpr double wide_steps = 12;        // a reach
constexpr double near_steps = 1.5;       // wide ones: closer things make samples come closer too

/// Sixteen directions all around, three degrees above the surface: they see what is low.
RayPattern grazing_pattern() {
  constexpr double up = 0.0524, around = 6.283185307179586 / batch_size;
  RayPattern pattern;
  pattern.rays = batch_size;
  pattern.batches.resize(1);
  for (int i = 0; i < batch_size; ++i) {
    pattern.batches[0].x[i] = static_cast<float>(std::sqrt(1 - up * up) * std::cos(i * around));
    pattern.batches[0].y[i] = static_cast<float>(std::sqrt(1 - up * up) * std::sin(i * around));
    pattern.batches[0].z[i] = static_cast<float>(up);
  }
  return pattern;
}

std::size_t grid_size(std::uint32_t steps) {
  return (std::size_t{steps} + 1) * (std::size_t{steps} + 2) / 2;
}
/// Grid point (i, j), i + j <= steps, in rows of j.
std::uint32_t grid_index(std::uint32_t i, std::uint32_t j, std::uint32_t steps) {
  return j * (steps + 1) - j * (j - 1) / 2 + i;
}

double longest_edge(const ObjectShape& shape, std::size_t triangle) {
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const dvec3 edge = dvec3(shape.positions[shape.triangles[triangle][(k + 1) % 3]]) -
                       dvec3(shape.positions[shape.triangles[triangle][k]]);
    square = std::max(square, glm::dot(edge, edge));
  }
  return std::sqrt(square);
}

/// Fine steps along a side: a multiple of the refinement, or 1 for a triangle whose corners will do.
std::uint32_t steps_of(double edge, double spacing) {
  constexpr double most_wide = 2048;
  if (!(edge > 0.5 * spacing)) return 1;
  return refinement * static_cast<std::uint32_t>(std::clamp(std::ceil(edge / spacing), 1.0, most_wide));
}

vec3 face_normal(const ObjectShape& shape, std::size_t triangle) {
  const glm::uvec3 t = shape.triangles[triangle];
  const dvec3 a(shape.positions[t.x]);
  const dvec3 n = glm::cross(dvec3(shape.positions[t.y]) - a, dvec3(shape.positions[t.z]) - a);
  const double square = glm::dot(n, n);
  return square > 0 ? vec3(n / std::sqrt(square)) : vec3(0.0f);
}

}  // namespace

double largest_coordinate(const ObjectShape& shape) {
  float largest = 0;
  for (const vec3& p : shape.positions)
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return largest;
}

float surface_lift(double largest_coordinate) {
  return static_cast<float>(4 * 1.7320508 * 0x1p-24 * largest_coordinate);
}

SelfOcclusion::SelfOcclusion(const ObjectShape& shape, const TriangleBvh& casters, double reach)
    : shape_(shape),
      casters_(casters),
      reach_(reach),
      spacing_(reach / wide_steps),
      lift_(surface_lift(largest_coordinate(shape))),
      pattern_(make_ray_pattern(sample_rays)),
      grazing_(grazing_pattern()) {
  lay_grids();
  weld_corners();
  std::size_t samples = shared_.size();
  for (const std::uint32_t t : large_) {
    grids_[t].first = static_cast<std::uint32_t>(samples);
    samples += grid_size(grids_[t].steps);
  }
  values_.assign(2 * samples, unknown);
}

// Too many samples: the spacing grows until they fit.
void SelfOcclusion::lay_grids() {
  grids_.assign(shape_.triangles.size(), {});
  std::vector<double> edges(shape_.triangles.size());
  for (std::size_t t = 0; t < edges.size(); ++t) edges[t] = longest_edge(shape_, t);
  const auto count = [&] {
    std::size_t samples = 0;
    for (const double edge : edges) {
      const std::uint32_t steps = steps_of(edge, spacing_);
      samples += steps > 1 ? grid_size(steps) : 0;
    }
    return samples;
  };
  while (count() > most_samples) spacing_ *= 1.25;
  for (std::size_t t = 0; t < edges.size(); ++t) {
    grids_[t].steps = steps_of(edges[t], spacing_);
    if (grids_[t].steps > 1) large_.push_back(static_cast<std::uint32_t>(t));
  }
}

std::uint64_t SelfOcclusion::corner_key(std::uint32_t triangle, int corner, double cell) const {
  const std::uint32_t vertex = shape_.triangles[triangle][corner];
  const vec3 face = face_normal(shape_, triangle);
  const vec3 normal = shape_.normals[vertex] == vec3(0.0f) ? face : shape_.normals[vertex];
  std::uint64_t key = 0x243f6a8885a308d3u;
  const auto mix = [&key](double number) {
    constexpr double limit = 1e15;
    key ^= static_cast<std::uint64_t>(static_cast<std::int64_t>(std::clamp(number, -limit, limit)));
    key *= 0x9e3779b97f4a7c15u;
    key ^= key >> 31;
  };
  for (int k = 0; k < 3; ++k) {
    mix(std::floor(shape_.positions[vertex][k] / cell + 0.3819660113));
    mix(std::round(4.0 * normal[k]));
    mix(std::round(3.0 * face[k]));
  }
  return key;
}

void SelfOcclusion::weld_corners() {
  const double cell = 0.25 * spacing_;
  struct Corner {
    std::uint64_t key;
    std::uint32_t at;  // 3 x small triangle + corner
    std::uint32_t id;  // 3 x triangle + corner
  };
  std::vector<Corner> corners;
  for (std::uint32_t t = 0, small = 0; t < grids_.size(); ++t) {
    if (grids_[t].steps > 1) continue;
    grids_[t].first = small;
    for (std::uint32_t k = 0; k < 3; ++k)
      corners.push_back({corner_key(t, static_cast<int>(k), cell), 3 * small + k, 3 * t + k});
    ++small;
  }
  corners_.resize(corners.size());
  std::sort(corners.begin(), corners.end(),
            [](const Corner& a, const Corner& b) { return a.key != b.key ? a.key < b.key : a.id < b.id; });
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i == 0 || corners[i].key != corners[i - 1].key) shared_.push_back(corners[i].id);
    corners_[corners[i].at] = static_cast<std::uint32_t>(shared_.size() - 1);
  }
}

SelfOcclusion::Blend SelfOcclusion::blend(const SurfacePoint& point, std::uint32_t stride) const {
  const Grid grid = grids_[point.triangle];
  const std::uint32_t side = point.front ? 0 : 1;
  const float v = std::clamp(point.v, 0.0f, 1.0f), w = std::clamp(point.w, 0.0f, 1.0f - v);
  if (grid.steps == 1) {
    const std::uint32_t* c = &corners_[std::size_t{3} * grid.first];
    return {{2 * c[0] + side, 2 * c[1] + side, 2 * c[2] + side}, {1 - v - w, v, w}};
  }
  const std::uint32_t count = grid.steps / stride;
  const auto steps = static_cast<float>(count);
  const auto i = std::min(static_cast<std::uint32_t>(v * steps), count - 1);
  const auto j = std::min(static_cast<std::uint32_t>(w * steps), count - 1 - i);
  const float fv = std::clamp(v * steps - static_cast<float>(i), 0.0f, 1.0f);
  const float fw = std::clamp(w * steps - static_cast<float>(j), 0.0f, 1.0f);
  const auto at = [&](std::uint32_t x, std::uint32_t y) {
    return 2 * (grid.first + grid_index(stride * x, stride * y, grid.steps)) + side;
  };
  if (fv + fw <= 1) return {{at(i, j), at(i + 1, j), at(i, j + 1)}, {1 - fv - fw, fv, fw}};
  if (i + j + 2 > count) {  // beyond the long side by rounding
    const float sum = fv + fw;
    return {{at(i, j), at(i + 1, j), at(i, j + 1)}, {0, fv / sum, fw / sum}};
  }
  return {{at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)}, {fv + fw - 1, 1 - fv, 1 - fw}};
}

bool SelfOcclusion::is_rough(const Blend& blend) const {
  return std::any_of(blend.samples, blend.samples + 3, [this](std::uint32_t sample) {
    return values_[sample] == buried || values_[sample] % 2 == 1;
  });
}

/// The wide grid's samples, or the fine one's where those say that something is near.
SelfOcclusion::Blend SelfOcclusion::find_samples(const SurfacePoint& point,
                                                 std::vector<std::uint32_t>& missing) const {
  const auto lacks = [&](const Blend& blend) {
    const std::size_t before = missing.size();
    for (const std::uint32_t sample : blend.samples) {
      if (values_[sample] == unknown) missing.push_back(sample);
    }
    return missing.size() > before;
  };
  if (grids_[point.triangle].steps > 1) {
    const Blend wide = blend(point, refinement);
    if (lacks(wide) || !is_rough(wide)) return wide;
  }
  const Blend fine = blend(point, 1);
  lacks(fine);
  return fine;
}

float SelfOcclusion::occlusion(const SurfacePoint& point, const Blend& around,
                               const AoKernels& kernels) const {
  constexpr float enough = 1e-4f;
  float sum = 0, total = 0;
  for (int k = 0; k < 3; ++k) {
    const std::uint16_t value = values_[around.samples[k]];
    if (value >= buried) continue;
    sum += around.weights[k] * static_cast<float>(value / 2);
    total += around.weights[k];
  }
  if (!(total > enough)) return look(point, kernels).occlusion;
  return std::clamp(sum / (total * most), 0.0f, 1.0f);
}

SurfacePoint SelfOcclusion::place(std::uint32_t sample) const {
  const bool front = sample % 2 == 0;
  sample /= 2;
  const auto pulled = [&](std::uint32_t triangle, float v, float w, float steps) {
    const float pull = 0.25f / steps;  // towards the middle: clear of the triangle's edges
    return SurfacePoint{triangle, v + pull * (1.0f / 3 - v), w + pull * (1.0f / 3 - w), front};
  };
  if (sample < shared_.size()) {
    const std::uint32_t corner = shared_[sample] % 3;
    return pulled(shared_[sample] / 3, corner == 1 ? 1.0f : 0.0f, corner == 2 ? 1.0f : 0.0f, 1);
  }
  const auto after = std::upper_bound(large_.begin(), large_.end(), sample,
                                      [&](std::uint32_t s, std::uint32_t t) { return s < grids_[t].first; });
  const std::uint32_t triangle = *(after - 1);
  const Grid grid = grids_[triangle];
  std::uint32_t i = sample - grid.first, j = 0;
  while (i > grid.steps - j) i -= grid.steps - j++ + 1;  // rows shrink by one
  const auto steps = static_cast<float>(grid.steps);
  return pulled(triangle, static_cast<float>(i) / steps, static_cast<float>(j) / steps, steps);
}

SelfOcclusion::Seen SelfOcclusion::look(const SurfacePoint& point, const AoKernels& kernels) const {
  constexpr int batches = sample_rays / batch_size;
  const glm::uvec3 t = shape_.triangles[point.triangle];
  vec3 face = face_normal(shape_, point.triangle);
  if (face == vec3(0.0f)) return {};
  if (!point.front) face = -face;
  const float u = 1 - point.v - point.w;
  vec3 normal = u * shape_.normals[t.x] + point.v * shape_.normals[t.y] + point.w * shape_.normals[t.z];
  const float square = glm::dot(normal, normal);
  normal = square > 1e-12f ? normal / std::sqrt(square) : face;
  if (glm::dot(normal, face) < 0) normal = -normal;
  const dvec3 p = double{u} * dvec3(shape_.positions[t.x]) + double{point.v} * dvec3(shape_.positions[t.y]) +
                  double{point.w} * dvec3(shape_.positions[t.z]);
  const vec3 origin(p + double{lift_} * dvec3(face));
  const auto reach = static_cast<float>(reach_);
  RayBatch rays[batches + 1];
  alignas(64) float distances[(batches + 1) * batch_size], facing[(batches + 1) * batch_size];
  const Frame frame = frame_around(normal), flat = frame_around(face);
  kernels.fan.spread(pattern_, {frame.x, frame.y, normal}, face, origin, rays);
  kernels.fan.spread(grazing_, {flat.x, flat.y, face}, face, origin, rays + batches);
  std::fill(std::begin(distances), std::end(distances), reach);
  for (int b = 0; b <= batches; ++b)
    kernels.cast(casters_, rays[b], distances + b * batch_size, facing + b * batch_size);
  Seen seen;
  seen.occlusion = std::clamp(kernels.fan.fall_off(distances, batches, reach) / sample_rays, 0.0f, 1.0f);
  seen.near = *std::min_element(std::begin(distances), std::end(distances)) < near_steps * spacing_;
  seen.buried = 2 * std::count_if(facing, facing + sample_rays, [](float f) { return f < 0; }) > sample_rays;
  return seen;
}

bool SelfOcclusion::fill(std::span<const std::uint32_t> samples, const AoKernels& kernels,
                         const std::function<void(double)>& progress, const StopFlag* stop) {
  constexpr std::size_t step = 8192, grain = 32;
  const auto stored = [](const Seen& seen) {
    if (seen.buried || !(seen.occlusion >= 0)) return buried;
    return static_cast<std::uint16_t>(2 * std::lround(seen.occlusion * most) + (seen.near ? 1 : 0));
  };
  for (std::size_t first = 0; first < samples.size(); first += step) {
    if (stop_requested(stop)) return false;
    if (progress) progress(static_cast<double>(first) / static_cast<double>(samples.size()));
    const auto part = samples.subspan(first, std::min(step, samples.size() - first));
    parallel_ranges(part.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end && !stop_requested(stop); ++i)
        values_[part[i]] = stored(look(place(part[i]), kernels));
    });
  }
  filled_ += samples.size();
  return !stop_requested(stop);
}

std::size_t SelfOcclusion::bytes() const {
  return values_.size() * sizeof(values_[0]) + grids_.size() * sizeof(Grid) +
         (corners_.size() + shared_.size() + large_.size()) * sizeof(std::uint32_t);
}

}  // namespace tenebra
