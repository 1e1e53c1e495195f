#include "render/renderer.h"

#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "raster/composite.h"
#include "raster/gbuffer.h"
#include "raster/geometry_buffers.h"
#include "raster/light_buffer.h"
#include "render/shadow_lights.h"

namespace tenebra {

namespace {

void add_trace_times(FrameTimings& to, const FrameTimings& from) {
  to.rays_ms += from.rays_ms;
  to.sort_ms += from.sort_ms;
  to.build_ms += from.build_ms;
  to.traverse_ms += from.traverse_ms;
  to.writeback_ms += from.writeback_ms;
}

}  // namespace

struct Renderer::State {
  gl::Context context;
  Scene scene;  // materials, lights and colours only
  GeometryBuffers geometry;
  GBufferPass gbuffer_pass;
  LightPass light_pass;
  Compositor compositor;
  GBuffer gbuffer{};
  LightBuffer light_buffer{};

  std::vector<std::uint32_t> ids{};
  std::vector<float> depth{};
  VisiblePoints points{};
  ShadowTracer tracer{};
  ShadowMask mask{};

  Expected<std::vector<int>> chosen_lights(const FrameInput& input, const RenderSettings& settings) const;
  void read_samples(const FrameInput& input, const RenderSettings& settings, FrameTimings& timings);
  void points_from_depth(const ViewRays& view);
  void keep_pixel_nodes(FrameResult& result) const;
  void trace_light(const FrameInput& input, int light, const RenderSettings& settings, FrameResult& result);
};

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Expected<Renderer> Renderer::create(gl::Context context, const Scene& scene) {
  auto gbuffer_pass = GBufferPass::create();
  if (!gbuffer_pass) return tl::unexpected(gbuffer_pass.error());
  auto light_pass = LightPass::create();
  if (!light_pass) return tl::unexpected(light_pass.error());
  auto compositor = Compositor::create();
  if (!compositor) return tl::unexpected(compositor.error());
  auto state = std::make_unique<State>(State{.context = std::move(context),
                                             .scene = {},
                                             .geometry = {},
                                             .gbuffer_pass = std::move(*gbuffer_pass),
                                             .light_pass = std::move(*light_pass),
                                             .compositor = std::move(*compositor)});
  if (auto uploaded = state->geometry.upload_materials(scene.materials); !uploaded) {
    return tl::unexpected(uploaded.error());
  }
  state->scene.lights = scene.lights;
  state->scene.ambient_light = scene.ambient_light;
  state->scene.background = scene.background;
  return Renderer(std::move(state));
}

const std::string& Renderer::gl_renderer() const {
  return state_->context.description();
}

void Renderer::set_lights(const std::vector<Light>& lights) {
  state_->scene.lights = lights;
}

std::vector<std::string> Renderer::take_debug_messages() {
  return state_->context.take_debug_messages();
}

std::optional<glm::dvec3> Renderer::visible_point(const FrameInput& input, int x, int y) {
  State& s = *state_;
  if (x < 0 || y < 0 || x >= s.gbuffer.width || y >= s.gbuffer.height) return std::nullopt;
  read_triangle_ids(s.gbuffer, s.ids);
  compute_visible_points(s.ids, s.gbuffer.width, s.gbuffer.height, input.view, triangle_view(input.geometry),
                         s.points);
  const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(s.gbuffer.width) +
                     static_cast<std::size_t>(x);
  if (s.points.triangles[pixel] == no_triangle) return std::nullopt;
  return s.points.positions[pixel];
}

Expected<std::vector<int>> Renderer::State::chosen_lights(const FrameInput& input,
                                                          const RenderSettings& settings) const {
  const int count = static_cast<int>(input.lights.size());
  if (settings.light >= count)
    return fail("light {}: the scene has {} lights, counted from 0", settings.light, count);
  std::vector<int> chosen;
  for (int i = 0; i < count; ++i) {
    if (settings.light < 0 || settings.light == i) chosen.push_back(i);
  }
  return chosen;
}

void Renderer::State::points_from_depth(const ViewRays& view) {
  const std::size_t width = static_cast<std::size_t>(gbuffer.width),
                    height = static_cast<std::size_t>(gbuffer.height);
  points.width = gbuffer.width;
  points.height = gbuffer.height;
  points.triangles = ids;
  points.positions.resize(width * height);
  parallel_ranges(height, 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first * width; i < last * width; ++i) {
      if (depth[i] <= 0) points.triangles[i] = no_triangle;
      if (points.triangles[i] == no_triangle) continue;
      points.positions[i] = point_from_depth(view, gbuffer.transform, static_cast<int>(i % width),
                                             static_cast<int>(i / width), depth[i]);
    }
  });
}

void Renderer::State::read_samples(const FrameInput& input, const RenderSettings& settings,
                                   FrameTimings& timings) {
  Stopwatch watch;
  read_triangle_ids(gbuffer, ids);
  if (settings.samples == SampleSource::depth) read_depth(gbuffer, depth);
  timings.readback_ms = watch.lap_ms();
  with_threads(settings.threads, [&] {
    if (settings.samples == SampleSource::depth) return points_from_depth(input.view);
    compute_visible_points(ids, gbuffer.width, gbuffer.height, input.view, triangle_view(input.geometry),
                           points);
  });
  timings.points_ms = watch.lap_ms();
}

void Renderer::State::keep_pixel_nodes(FrameResult& result) const {
  const auto nodes = tracer.pixel_nodes();
  result.pixel_nodes.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) result.pixel_nodes[i] += nodes[i];
}

void Renderer::State::trace_light(const FrameInput& input, int light, const RenderSettings& settings,
                                  FrameResult& result) {
  const WorldLight& placed = input.lights[static_cast<std::size_t>(light)];
  HardShadowConfig config = settings.hard;
  if (settings.samples == SampleSource::depth) config.contact = ContactRule::none;
  config.count_pixel_nodes = settings.diagnostics;
  with_threads(settings.threads, [&] {
    tracer.trace_shadow_mask(points, input.view, triangle_view(input.geometry),
                             shadow_light(scene.lights[static_cast<std::size_t>(placed.light)], placed),
                             config, mask);
  });
  if (settings.diagnostics) keep_pixel_nodes(result);
  result.stats += tracer.stats();
  add_trace_times(result.timings, tracer.timings());
  result.masks.push_back({light, {gbuffer.width, gbuffer.height, 1, mask}});
}

// Olsson and Assarsson 2011, section 3.1: (1) rasterise, direct light apart; (2) rays and their hierarchy
// from what is seen; (3) triangles through the hierarchy; (4) blocked pixels lose the light; (5) add it up.
Expected<void> Renderer::render_frame(const FrameInput& input, const RenderSettings& settings,
                                      FrameResult& result, const AoProgress&, const StopFlag*) {
  State& s = *state_;
  const auto lights = s.chosen_lights(input, settings);
  if (!lights) return tl::unexpected(lights.error());
  if (auto checked = check_picture_size(settings.width, settings.height); !checked) return checked;
  result.masks.clear();
  result.timings = {};
  result.stats = {};
  result.pixel_nodes.clear();
  result.soft_classes.clear();
  FrameTimings& timings = result.timings;
  Stopwatch watch, whole;

  if (auto uploaded = s.geometry.upload(input.geometry); !uploaded) return uploaded;
  if (auto drawn = s.gbuffer_pass.draw(input.view, s.geometry, settings.width, settings.height, s.gbuffer);
      !drawn)
    return drawn;
  if (auto begun = s.compositor.begin(settings.width, settings.height); !begun) return begun;
  timings.raster_ms = watch.lap_ms();

  const bool shadows = settings.shadows == ShadowMode::hard && !lights->empty();
  if (shadows) s.read_samples(input, settings, timings);
  for (const int light : *lights) {
    const WorldLight& placed = input.lights[static_cast<std::size_t>(light)];
    watch.lap_ms();
    if (auto drawn =
            s.light_pass.draw(s.gbuffer, s.geometry, s.scene.lights[static_cast<std::size_t>(placed.light)],
                              placed, s.light_buffer);
        !drawn) {
      return drawn;
    }
    timings.raster_ms += watch.lap_ms();
    if (shadows) s.trace_light(input, light, settings, result);
    watch.lap_ms();
    s.compositor.add_light(s.light_buffer,
                           shadows ? std::span<const std::uint8_t>(s.mask) : std::span<const std::uint8_t>());
    timings.writeback_ms += watch.lap_ms();
  }
  s.compositor.finish(s.gbuffer, s.geometry, {s.scene.ambient_light, s.scene.background, settings.exposure},
                      result.image);
  timings.composite_ms = watch.lap_ms();
  timings.total_ms = whole.lap_ms();
  return {};
}

}  // namespace tenebra
