#include "bench/soft/soft_rival.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "parallel/parallel.h"
#include "soft/light/light_frame.h"
#include "soft/solve/group_solver.h"

namespace tenebra::bench {
namespace {

constexpr std::size_t tile_lanes = 16, rival_side = 4;
constexpr std::size_t rival_patterns = 16 * tile_lanes;
constexpr std::uint8_t no_state = 0, lit_state = 1, dark_state = 2, mixed_state = 3;

bool one_surface(const SampledReceiver& a, const SampledReceiver& b) {
  const glm::vec3 d = b.position - a.position;
  return glm::dot(a.normal, b.normal) > 0.95f &&
         std::abs(glm::dot(d, a.geometric_normal)) <= 0.1f * glm::length(d);
}

}  // namespace

RivalSampler::RivalSampler(const SoftView& view, const EmbreeScene& casters,
                           std::span<const SampledReceiver> receivers)
    : view_(view),
      casters_(casters),
      receivers_(receivers),
      kernels_(packet_kernels()),
      columns_((static_cast<std::size_t>(view.frame.points.width) + rival_side - 1) / rival_side),
      rows_((static_cast<std::size_t>(view.frame.points.height) + rival_side - 1) / rival_side) {
  const std::size_t tiles = columns_ * rows_;
  all_.resize(tiles * tile_lanes), seen_.resize(tiles * tile_lanes);
  states_.resize(tiles), decided_.resize(tiles);
  share_.resize(receivers.size()), smooth_.resize(receivers.size()), undecided_.resize(receivers.size());
  mask_.visible_fraction.resize(receivers.size()), mask_.irradiance.resize(receivers.size());
  classes_.resize(receivers.size());
}

const LightSamples& RivalSampler::samples_of(std::size_t rays) {
  const auto number = static_cast<std::size_t>(std::countr_zero(rays));
  if (samples_.size() <= number) samples_.resize(number + 1);
  if (!samples_[number].x.empty()) return samples_[number];
  LightSamples& samples = samples_[number] = sobol_by_tile(view_.light, rays, rival_patterns);
  if (view_.light.at_infinity) {
    const float beyond = 4 * view_.frame.diagonal_m;
    for (auto* directions : {&samples.x, &samples.y, &samples.z})
      for (float& coordinate : *directions) coordinate *= beyond;
  }
  return samples;
}

/// Rays `from` ... `to` - 1 of a tile's pixels; the state says what all rays of the tile met.
void RivalSampler::look(const LightSamples& samples, std::size_t tile, std::size_t from, std::size_t to) {
  ao::EmbreeQuery query(ao::EmbreeQuery::coherent);
  const auto width = static_cast<std::size_t>(view_.frame.points.width),
             height = static_cast<std::size_t>(view_.frame.points.height);
  ReceiverPacket packet{};
  bool any = false;
  for (std::size_t lane = 0; lane < tile_lanes; ++lane) {
    const std::size_t x = tile % columns_ * rival_side + lane % rival_side,
                      y = tile / columns_ * rival_side + lane / rival_side;
    if (x >= width || y >= height) continue;
    const SampledReceiver& r = receivers_[y * width + x];
    if (r.normal == glm::vec3(0)) continue;
    put(packet, lane, r);
    any = true;
  }
  float *all = &all_[tile * tile_lanes], *seen = &seen_[tile * tile_lanes];
  if (from == 0)
    std::fill_n(all, tile_lanes, 0.0f), std::fill_n(seen, tile_lanes, 0.0f), states_[tile] = no_state;
  if (!any) return;
  RayPacket16 rays;
  start_rays(packet, rays);
  if (view_.light.at_infinity)  // samples are ways from wherever they start
    for (auto* places : {packet.x, packet.y, packet.z}) std::fill_n(places, tile_lanes, 0.0f);
  const std::size_t block = scattered(tile) % (rival_patterns / tile_lanes) * samples.per_pattern;
  const glm::vec3 normal(view_.light.normal);
  for (std::size_t s = (block + from) * tile_lanes; s < (block + to) * tile_lanes; s += tile_lanes) {
    if (!kernels_.aim(packet, &samples.x[s], &samples.y[s], &samples.z[s], normal.x, normal.y, normal.z,
                      rays))
      continue;
    query.occluded16(rays.valid, casters_.get(), rays.rays);
    for (std::size_t i = 0; i < tile_lanes; ++i) all[i] += rays.weight[i];
    kernels_.gather(rays, seen);
  }
  for (std::size_t i = 0; i < tile_lanes; ++i) {
    if (!(all[i] > 0)) continue;
    states_[tile] |= seen[i] == all[i] ? lit_state : seen[i] == 0 ? dark_state : mixed_state;
  }
}

/// Lit or dark where a tile and its eight neighbours agree.
void RivalSampler::decide() {
  parallel::parallel_ranges(rows_, 4, [&](std::size_t first, std::size_t last) {
    for (std::size_t y = first; y < last; ++y) {
      for (std::size_t x = 0; x < columns_; ++x) {
        std::uint8_t state = 0;
        for (std::size_t ny = y == 0 ? 0 : y - 1; ny <= std::min(y + 1, rows_ - 1); ++ny)
          for (std::size_t nx = x == 0 ? 0 : x - 1; nx <= std::min(x + 1, columns_ - 1); ++nx)
            state |= states_[ny * columns_ + nx];
        decided_[y * columns_ + x] = state;
      }
    }
  });
}

/// The closed form of what nothing hides, where a ray came through, times the visible share.
void RivalSampler::light_up(std::vector<float>& irradiance) {
  const BenchFrame& frame = view_.frame;
  const soft::LightFrame light = soft::light_frame(view_.light);
  const TriangleView triangles = frame.triangles();
  const SoftShadowConfig config;
  const soft::SoftFrame of{frame.points, frame.normals, triangles, light, config, mask_, classes_, nullptr};
  const auto width = static_cast<std::size_t>(frame.points.width);
  parallel::parallel_ranges(rows_, 4, [&](std::size_t first, std::size_t last) {
    soft::GroupSolver solver(SimdLevel::automatic);
    std::vector<std::uint32_t> pixels;
    for (std::size_t y = first * rival_side; y < std::min(last * rival_side, share_.size() / width); ++y)
      for (std::size_t i = y * width; i < (y + 1) * width; ++i)
        if (share_[i] > 0) pixels.push_back(static_cast<std::uint32_t>(i));
    const std::span<const std::uint32_t> all(pixels);
    solver.solve_lit(of, {&all, 1});
  });
  irradiance.resize(share_.size());
  parallel::parallel_ranges(share_.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      irradiance[i] = share_[i] > 0 ? mask_.irradiance[i] * share_[i] : 0.0f;
  });
}

void RivalSampler::filter(int step) {
  static constexpr float spline[5] = {1.0f / 16, 1.0f / 4, 3.0f / 8, 1.0f / 4, 1.0f / 16};
  const int width = view_.frame.points.width, height = view_.frame.points.height;
  parallel::parallel_ranges(static_cast<std::size_t>(height), 8, [&](std::size_t first, std::size_t last) {
    for (int y = static_cast<int>(first); y < static_cast<int>(last); ++y) {
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(y * width + x);
        smooth_[i] = share_[i];
        if (undecided_[i] == 0) continue;
        float sum = 0, weights = 0;
        for (int dy = -2; dy <= 2; ++dy) {
          for (int dx = -2; dx <= 2; ++dx) {
            const int nx = x + dx * step, ny = y + dy * step;
            if (nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
            const auto k = static_cast<std::size_t>(ny * width + nx);
            if (k != i && !one_surface(receivers_[i], receivers_[k])) continue;
            const float weight = spline[dx + 2] * spline[dy + 2];
            sum += weight * share_[k], weights += weight;
          }
        }
        smooth_[i] = sum / weights;
      }
    }
  });
  share_.swap(smooth_);
}

void RivalSampler::trace(std::size_t rays, int passes, std::vector<float>& irradiance) {
  const LightSamples& samples = samples_of(rays);
  const std::size_t tiles = columns_ * rows_;
  const auto width = static_cast<std::size_t>(view_.frame.points.width),
             height = static_cast<std::size_t>(view_.frame.points.height);
  parallel::parallel_ranges(tiles, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t tile = first; tile < last; ++tile) look(samples, tile, 0, probe_rays);
  });
  decide();
  parallel::parallel_ranges(tiles, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t tile = first; tile < last; ++tile) {
      if (decided_[tile] == mixed_state && rays > probe_rays) look(samples, tile, probe_rays, rays);
      for (std::size_t lane = 0; lane < tile_lanes; ++lane) {
        const std::size_t x = tile % columns_ * rival_side + lane % rival_side,
                          y = tile / columns_ * rival_side + lane / rival_side;
        if (x >= width || y >= height) continue;
        const float all = all_[tile * tile_lanes + lane];
        share_[y * width + x] = all > 0 ? seen_[tile * tile_lanes + lane] / all : 0.0f;
        undecided_[y * width + x] = decided_[tile] == mixed_state && all > 0 ? 1 : 0;
      }
    }
  });
  for (int pass = 0; pass < passes; ++pass) filter(1 << pass);
  light_up(irradiance);
}

}  // namespace tenebra::bench
