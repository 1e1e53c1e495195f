#include "bench/frame/embree_renderer.h"

#include <numeric>

#include "base/stopwatch.h"
#include "bench/common/bench_frame.h"
#include "parallel/parallel.h"
#include "render/area_lights.h"
#include "render/frame_lights.h"
#include "render/shadow_lights.h"
#include "shade/shading.h"

namespace tenebra::bench {
namespace {

void evaluate_at(const Scene& scene, int frame, FrameGeometry& geometry) {
  const auto [clip, time_s] = frame_instant(scene, frame);
  evaluate_frame(scene, clip, time_s, geometry);
}

/// Of each vertex whether it moves between the frames.
std::vector<std::uint8_t> moving_vertices(const Scene& scene, int first, int last) {
  FrameGeometry start, now;
  evaluate_at(scene, first, start);
  std::vector<std::uint8_t> moving(start.positions.size());
  for (int frame = first + 1; frame <= last; ++frame) {
    evaluate_at(scene, frame, now);
    const auto moved = moved_vertices(start.positions, now.positions);
    for (std::size_t i = 0; i < moved.size(); ++i) moving[i] |= moved[i];
  }
  return moving;
}

}  // namespace

EmbreeRenderer::EmbreeRenderer(const FrameTask& task, TreeKind kind, const PacketPlan& plan, int first,
                               int last)
    : task_(task), kind_(kind), plan_(plan) {
  const auto moving = moving_vertices(task.scene, first, last);
  geometry_.positions.reserve(moving.size() + 1);  // Embree reads a float behind the last vertex
  evaluate_at(task.scene, first, geometry_);
  tree_ = std::make_unique<EmbreeTree>(geometry_.positions.data(), triangle_view(geometry_), moving,
                                       EmbreeTree::Settings{kind, task.threads, SimdLevel::automatic, false});
  wide_m_ = static_cast<float>(render::box_of(geometry_).diagonal());
  ids_.resize(static_cast<std::size_t>(task.width) * static_cast<std::size_t>(task.height));
}

void EmbreeRenderer::trace_row(const TileGrid& grid, int row, std::span<const LightAim> lights,
                               PacketTracer& tracer, Shares* shares) {
  TilePlanes planes[16];
  TilePoints points[16];
  base::Stopwatch watch;
  for (int column = 0; column < grid.square_columns(); ++column) {
    for (int tile = 0; tile < 16; ++tile) {
      const glm::ivec2 at = grid.first({column, row}, tile);
      std::uint32_t ids[16];
      tracer.look(view_, static_cast<float>(at.x), static_cast<float>(at.y), ids, planes[tile], points[tile]);
      grid.put(ids, at, ids_.data());
    }
    if (shares != nullptr) shares->primary += watch.lap_ms();
    for (std::size_t i = 0; i < lights.size(); ++i) {
      for (int tile = 0; tile < 16; ++tile)
        grid.put_bits(tracer.lit(planes[tile], points[tile], lights[i]), grid.first({column, row}, tile),
                      masks_[i].data());
    }
    if (shares != nullptr) shares->shadows += watch.lap_ms();
  }
}

void EmbreeRenderer::trace(std::vector<Shares>* shares) {
  std::vector<LightAim> lights;
  for (const ShadowLight& light : lights_) lights.push_back(aim_at(light, view_.eye, plan_.way, wide_m_));
  const TileGrid grid(task_.width, task_.height, plan_.shape);
  if (shares != nullptr) shares->resize(static_cast<std::size_t>(grid.square_rows()));
  parallel::parallel_tasks(grid.square_rows(), [&](int row) {
    PacketTracer tracer(*tree_, plan_, SimdLevel::automatic);
    trace_row(grid, row, lights, tracer,
              shares != nullptr ? &(*shares)[static_cast<std::size_t>(row)] : nullptr);
  });
}

double EmbreeRenderer::retrace(const PacketPlan& plan) {
  plan_ = plan;
  base::Stopwatch watch;
  trace(nullptr);
  return watch.lap_ms();
}

EmbreeFrameTimes EmbreeRenderer::draw(int frame, bool split) {
  const Scene& scene = task_.scene;
  const auto [clip, time_s] = frame_instant(scene, frame);
  base::Stopwatch watch, whole;
  EmbreeFrameTimes times;
  evaluate_frame(scene, clip, time_s, geometry_);
  render::FrameInput input;  // lights alone: it holds its geometry by value
  input.lights = evaluate_lights(scene, clip, time_s);
  view_ = evaluate_camera(scene, clip, time_s, 0, task_.width, task_.height);
  times.evaluate = watch.lap_ms();

  tree_->follow();
  times.tree = watch.lap_ms();

  std::vector<std::string> notes;
  const auto lights = render::drawn_lights(scene, input, {}, notes);  // never fails: all are asked for
  lights_.clear();
  masks_.resize(lights->size());
  std::vector<shade::LightFactors> factors(lights->size());
  for (std::size_t i = 0; i < lights->size(); ++i) {
    const render::DrawnLight& light = (*lights)[i];
    lights_.push_back(render::shadow_light(light.light, light.placed));
    masks_[i].resize(ids_.size());
    factors[i].mask = masks_[i];
  }
  std::vector<Shares> shares;
  trace(split ? &shares : nullptr);
  const double traced = watch.lap_ms();
  double primary = 0, both = 0;
  for (const Shares& row : shares) primary += row.primary, both += row.primary + row.shadows;
  times.primary = both > 0 ? traced * primary / both : traced;
  times.shadows = traced - times.primary;

  const shade::Subject subject{geometry_, view_, task_.surfaces};
  const shade::Lighting lighting{*lights, scene.ambient_light, scene.background, nullptr};
  const shade::PixelSamples pixels{task_.width, task_.height, ids_, factors, {}};
  shade::shade_picture(subject, lighting, pixels, {.transfer = scene.transfer}, image_);
  times.shade = watch.lap_ms();
  times.total = whole.lap_ms();
  return times;
}

}  // namespace tenebra::bench
