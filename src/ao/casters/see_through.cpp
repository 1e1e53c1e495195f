#include "ao/casters/see_through.h"

#include <cmath>
#include <numeric>

#include "parallel/parallel.h"
#include "texture/transmittance.h"

namespace tenebra::ao {
namespace {

bool apart(const math::Box<double>& a, const math::Box<double>& b, double reach) {
  for (int k = 0; k < 3; ++k)
    if (a.low[k] > b.high[k] + reach || b.low[k] > a.high[k] + reach) return true;
  return false;
}

}  // namespace

void SeeThroughCasters::begin_frame(const Scene& scene, const FrameGeometry& geometry, const StopFlag* stop) {
  layers_.clear();
  if (geometry.see_through.empty()) return;
  std::vector<int> steps;  // of each material
  for (const Material& material : scene.materials) {
    const glm::vec3 passed = texture::mean_transmittance(scene, material);
    const float opacity = 1 - (passed.x + passed.y + passed.z) / 3;
    steps.push_back(static_cast<int>(std::lround(opacity * opacity_steps)));
  }
  std::vector<std::vector<glm::uvec3>> of_step(opacity_steps + 1);
  for (std::size_t id = 0; id < geometry.triangles.size(); ++id) {
    const glm::uvec3 t = geometry.triangles[id];
    if (geometry.see_through[id] == 1 && !(t.x == t.y && t.y == t.z))
      of_step[static_cast<std::size_t>(steps[geometry.materials[id]])].push_back(t);
  }
  for (int step = 1; step <= opacity_steps; ++step)
    add_layer(step, of_step[static_cast<std::size_t>(step)], geometry, stop);
}

void SeeThroughCasters::add_layer(int step, const std::vector<glm::uvec3>& triangles,
                                  const FrameGeometry& geometry, const StopFlag* stop) {
  if (triangles.empty()) return;
  auto tree = trees::build_triangle_bvh(geometry.positions, triangles, stop);
  if (!tree) return;
  Layer& layer = layers_.emplace_back();
  layer.opacity = static_cast<float>(step) / opacity_steps;
  for (const glm::uvec3& t : triangles)
    for (int k = 0; k < 3; ++k) layer.box.add(glm::dvec3(geometry.positions[t[k]]));
  layer.triangles = std::move(*tree);
}

void SeeThroughCasters::darken(const ReceiverSet& set, const PointRays& rays, const RayKernels& kernels,
                               std::span<float> values, std::uint64_t& rays_cast,
                               const StopFlag* stop) const {
  struct Scratch {
    std::vector<Receiver> receivers;
    std::vector<trees::RayBatch> batches;
    std::vector<float> distances;
  };
  std::vector<Scratch> scratch(static_cast<std::size_t>(thread_count()));
  std::vector<std::uint64_t> cast(static_cast<std::size_t>(set.groups()), 0);
  parallel::parallel_tasks(set.groups(), [&](int group) {
    if (stop_requested(stop)) return;
    Scratch& own = scratch[static_cast<std::size_t>(parallel::thread_index())];
    set.receivers(group, own.receivers);
    math::Box<double> box;
    for (const Receiver& receiver : own.receivers) box.add(receiver.position);
    own.batches.resize(rays.batches());
    for (const Layer& layer : layers_) {
      if (own.receivers.empty() || apart(box, layer.box, rays.reach())) continue;
      for (const Receiver& receiver : own.receivers) {
        rays.spread(receiver, own.batches.data());
        own.distances.assign(rays.batches() * trees::batch_size, rays.reach());
        kernels.cast(layer.triangles, own.batches, own.distances.data(), nullptr);
        values[receiver.index] *= 1 - layer.opacity * rays.hidden(own.distances.data());
        cast[static_cast<std::size_t>(group)] += static_cast<std::uint64_t>(rays.rays());
      }
    }
  });
  rays_cast += std::accumulate(cast.begin(), cast.end(), std::uint64_t{0});
}

float SeeThroughCasters::left(const glm::dvec3& point, std::span<const trees::RayBatch> rays, int count,
                              float reach, const RayKernels& kernels, std::span<float> distances,
                              std::uint64_t& rays_cast) const {
  math::Box<double> box;
  box.add(point);
  float open = 1;
  for (const Layer& layer : layers_) {
    if (apart(box, layer.box, reach)) continue;
    std::fill(distances.begin(), distances.end(), reach);
    kernels.cast(layer.triangles, rays, distances.data(), nullptr);
    const float hidden = kernels.fan.fall_off(distances.data(), static_cast<int>(rays.size()), reach);
    open *= 1 - layer.opacity * std::clamp(hidden / static_cast<float>(count), 0.0f, 1.0f);
    rays_cast += rays.size() * trees::batch_size;
  }
  return open;
}

}  // namespace tenebra::ao
