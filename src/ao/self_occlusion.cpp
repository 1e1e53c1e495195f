#include "ao/self_occlusion.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "ao/sphere_maps.h"
#include "parallel/parallel.h"

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;

// A value is unknown, or 4 x (0..most) + 2 x (buried) + (something is near).
constexpr std::uint16_t unknown = 0xffff, near_bit = 1, buried_bit = 2;
constexpr float most = 16382.0f;
constexpr std::uint32_t refinement = 4;   // fine steps a wide one
constexpr double wide_steps = 12;         // a reach
constexpr float disagreement = 0.1f;      // neighbours that differ by more have their cell divided
constexpr std::uint32_t patch_steps = 4;  // of a divided cell
constexpr std::size_t patch_size = (patch_steps + 1) * (patch_steps + 2) / 2;
constexpr std::uint64_t is_patch = std::uint64_t{1} << 63;  // what is missing is a cell's division
constexpr double near_steps = 1.5;  // wide ones: closer things make samples come closer too

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
  in_patches_ = values_.size();
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

std::uint64_t SelfOcclusion::corner_key(std::uint32_t triangle, int corner) const {
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
    mix(std::bit_cast<std::uint32_t>(shape_.positions[vertex][k] + 0.0f));
    mix(std::round(4.0 * normal[k]));
    mix(std::round(3.0 * face[k]));
  }
  return key;
}

void SelfOcclusion::weld_corners() {
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
      corners.push_back({corner_key(t, static_cast<int>(k)), 3 * small + k, 3 * t + k});
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

SelfOcclusion::GridCell SelfOcclusion::grid_cell(float v, float w, std::uint32_t count) {
  const auto steps = static_cast<float>(count);
  const auto i = std::min(static_cast<std::uint32_t>(v * steps), count - 1);
  const auto j = std::min(static_cast<std::uint32_t>(w * steps), count - 1 - i);
  const float fv = std::clamp(v * steps - static_cast<float>(i), 0.0f, 1.0f);
  const float fw = std::clamp(w * steps - static_cast<float>(j), 0.0f, 1.0f);
  const float sum = fv + fw;
  if (sum <= 1) return {{i, i + 1, i}, {j, j, j + 1}, {1 - sum, fv, fw}, false};
  if (i + j + 2 > count)  // beyond the long side by rounding
    return {{i, i + 1, i}, {j, j, j + 1}, {0, fv / sum, fw / sum}, false};
  return {{i + 1, i, i + 1}, {j + 1, j + 1, j}, {sum - 1, 1 - fv, 1 - fw}, true};
}

SelfOcclusion::Blend SelfOcclusion::blend(const SurfacePoint& point, std::uint32_t stride) const {
  const Grid grid = grids_[point.triangle];
  const std::uint32_t side = point.front ? 0 : 1;
  const float v = std::clamp(point.v, 0.0f, 1.0f), w = std::clamp(point.w, 0.0f, 1.0f - v);
  if (grid.steps == 1) {
    const std::uint32_t* c = &corners_[std::size_t{3} * grid.first];
    return {{2 * c[0] + side, 2 * c[1] + side, 2 * c[2] + side}, {1 - v - w, v, w}};
  }
  const GridCell cell = grid_cell(v, w, grid.steps / stride);
  const auto at = [&](int k) {
    return 2 * (grid.first + grid_index(stride * cell.i[k], stride * cell.j[k], grid.steps)) + side;
  };
  return {{at(0), at(1), at(2)}, {cell.weights[0], cell.weights[1], cell.weights[2]}};
}

bool SelfOcclusion::is_rough(const Blend& blend) const {
  return std::any_of(blend.samples, blend.samples + 3, [this](std::uint32_t sample) {
    return (values_[sample] & (near_bit | buried_bit)) != 0;
  });
}

/// Some buried, some not.
bool SelfOcclusion::are_mixed(const Blend& blend) const {
  const auto is_buried = [&](int k) { return (values_[blend.samples[k]] & buried_bit) != 0; };
  return is_buried(0) != is_buried(1) || is_buried(0) != is_buried(2);
}

/// So much that straight lines between them do not hold.
bool SelfOcclusion::disagree(const Blend& blend) const {
  const auto [least, greatest] =
      std::minmax({values_[blend.samples[0]], values_[blend.samples[1]], values_[blend.samples[2]]});
  return are_mixed(blend) || static_cast<float>(greatest - least) > 4 * most * disagreement;
}

bool SelfOcclusion::lacks(const Blend& blend, std::vector<std::uint64_t>& missing) const {
  const std::size_t before = missing.size();
  for (const std::uint32_t sample : blend.samples) {
    if (values_[sample] == unknown) missing.push_back(sample);
  }
  return missing.size() > before;
}

/// Names the finest cell of the triangle's grid around the point: bits 60.. 30 the triangle, 14 each for the
/// cell's place, one for the half, one for the side.
std::uint64_t SelfOcclusion::patch_key(const SurfacePoint& point) const {
  const float v = std::clamp(point.v, 0.0f, 1.0f), w = std::clamp(point.w, 0.0f, 1.0f - v);
  const GridCell cell = grid_cell(v, w, grids_[point.triangle].steps);
  const std::uint64_t i = cell.i[cell.upper ? 1 : 0], j = cell.j[cell.upper ? 2 : 0];
  return is_patch | std::uint64_t{point.triangle} << 30 | i << 16 | j << 2 | (cell.upper ? 2u : 0u) |
         (point.front ? 0u : 1u);
}

/// The wide grid's samples, the fine one's where those say that something is near, the divided cell's where
/// those disagree.
SelfOcclusion::Blend SelfOcclusion::find_samples(const SurfacePoint& point,
                                                 std::vector<std::uint64_t>& missing) const {
  if (grids_[point.triangle].steps > 1) {
    const Blend wide = blend(point, refinement);
    if (lacks(wide, missing) || (!is_rough(wide) && !disagree(wide))) return wide;
  }
  const Blend fine = blend(point, 1);
  if (lacks(fine, missing) || !disagree(fine)) return fine;
  const std::uint64_t key = patch_key(point);
  const auto patch = patch_at_.find(key);
  if (patch == patch_at_.end()) {
    missing.push_back(key);
    return fine;
  }
  const GridCell cell = grid_cell(fine.weights[1], fine.weights[2], patch_steps);
  const auto at = [&](int k) { return patch->second + grid_index(cell.i[k], cell.j[k], patch_steps); };
  const Blend finest{{at(0), at(1), at(2)}, {cell.weights[0], cell.weights[1], cell.weights[2]}};
  lacks(finest, missing);
  return finest;
}

void SelfOcclusion::add_patch(std::uint64_t key) {
  if (!patch_at_.emplace(key, static_cast<std::uint32_t>(values_.size())).second) return;
  patches_.push_back(key);
  values_.resize(values_.size() + patch_size, unknown);
}

SurfacePoint SelfOcclusion::place_in_patch(std::uint32_t sample) const {
  const std::size_t number = sample - in_patches_;
  const std::uint64_t key = patches_[number / patch_size];
  auto a = static_cast<std::uint32_t>(number % patch_size);
  std::uint32_t b = 0;
  while (a > patch_steps - b) a -= patch_steps - b++ + 1;  // rows shrink by one
  const auto triangle = static_cast<std::uint32_t>((key & ~is_patch) >> 30);
  const auto i = static_cast<float>(key >> 16 & 0x3fff), j = static_cast<float>(key >> 2 & 0x3fff);
  const auto steps = static_cast<float>(grids_[triangle].steps);
  constexpr float pull = 0.25f / patch_steps;
  float v = static_cast<float>(a) / patch_steps, w = static_cast<float>(b) / patch_steps;
  v += pull * (1.0f / 3 - v), w += pull * (1.0f / 3 - w);
  if ((key & 2) == 0) return {triangle, (i + v) / steps, (j + w) / steps, (key & 1) == 0};
  return {triangle, (i + 1 - v) / steps, (j + 1 - w) / steps, (key & 1) == 0};
}

float SelfOcclusion::occlusion(const SurfacePoint& point, const Blend& around,
                               const AoKernels& kernels) const {
  if (are_mixed(around)) return look(point, kernels).occlusion;
  float sum = 0;
  for (int k = 0; k < 3; ++k) sum += around.weights[k] * static_cast<float>(values_[around.samples[k]] / 4);
  return std::clamp(sum / most, 0.0f, 1.0f);
}

SurfacePoint SelfOcclusion::place(std::uint32_t sample) const {
  if (sample >= in_patches_) return place_in_patch(sample);
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

bool SelfOcclusion::fill(std::span<const std::uint64_t> missing, const AoKernels& kernels,
                         const std::function<void(double)>& progress, const StopFlag* stop) {
  const auto divisions = std::lower_bound(missing.begin(), missing.end(), is_patch);
  for (auto key = divisions; key != missing.end(); ++key) add_patch(*key);
  const std::vector<std::uint32_t> samples(missing.begin(), divisions);
  constexpr std::size_t step = 8192, grain = 32;
  const auto stored = [](const Seen& seen) {
    return static_cast<std::uint16_t>(4 * std::lround(seen.occlusion * most) +
                                      (seen.buried ? buried_bit : 0) + (seen.near ? near_bit : 0));
  };
  for (std::size_t first = 0; first < samples.size(); first += step) {
    if (stop_requested(stop)) return false;
    if (progress) progress(static_cast<double>(first) / static_cast<double>(samples.size()));
    const auto part = std::span(samples).subspan(first, std::min(step, samples.size() - first));
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
         (corners_.size() + shared_.size() + large_.size()) * sizeof(std::uint32_t) +
         patches_.size() * 4 * sizeof(std::uint64_t);
}

}  // namespace tenebra
