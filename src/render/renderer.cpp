#include "render/renderer.h"

#include <cassert>
#include <cmath>
#include <unordered_set>

#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "raster/composite.h"
#include "raster/gbuffer.h"
#include "raster/geometry_buffers.h"
#include "raster/light_buffer.h"
#include "render/frame_lights.h"
#include "render/shadow_lights.h"

namespace tenebra {

namespace {

/// Times of one light's shadows, added to those of the frame; the stages of one method are zero in the other.
void add_shadow_times(FrameTimings& to, const FrameTimings& from) {
  to.rays_ms += from.rays_ms;
  to.sort_ms += from.sort_ms;
  to.build_ms += from.build_ms;
  to.traverse_ms += from.traverse_ms;
  to.writeback_ms += from.writeback_ms;
  to.shaft_ms += from.shaft_ms;
  to.init_ms += from.init_ms;
  to.query_ms += from.query_ms;
  to.irradiance_ms += from.irradiance_ms;
}

/// The scene but for the vertices of deforming meshes at their key times: FrameGeometry has them of each
/// frame, and they are most of a large animation.
Scene without_keyed_vertices(const Scene& scene) {
  Scene copy;
  copy.nodes = scene.nodes;
  copy.skins = scene.skins;
  copy.materials = scene.materials;
  copy.lights = scene.lights;
  copy.clips = scene.clips;
  copy.background = scene.background;
  copy.ambient_light = scene.ambient_light;
  for (const Mesh& mesh : scene.meshes) {
    Mesh& kept = copy.meshes.emplace_back();
    kept.name = mesh.name;
    kept.source = mesh.source;
    kept.positions = mesh.positions;
    kept.normals = mesh.normals;
    kept.triangles = mesh.triangles;
    kept.materials = mesh.materials;
    kept.joints = mesh.joints;
    kept.weights = mesh.weights;
    kept.morph_targets.resize(mesh.morph_targets.size());
    kept.default_weights = mesh.default_weights;
    for (const Mesh::Shape& shape : mesh.shapes) kept.shapes.push_back({shape.time_s, {}, {}});
    kept.casts_shadow = mesh.casts_shadow;
  }
  return copy;
}

/// Soft shadows and ambient occlusion start from exact points on triangles.
Expected<void> check_settings(const RenderSettings& settings) {
  const bool needs_ids = settings.shadows == ShadowMode::soft || settings.ao.mode != AoMode::none;
  if (needs_ids && settings.samples == SampleSource::depth) {
    return fail("samples from the depth buffer: {} needs the exact points from triangle ids",
                settings.shadows == ShadowMode::soft ? "a soft shadow" : "ambient occlusion");
  }
  return check_picture_size(settings.width, settings.height);
}

}  // namespace

struct Renderer::State {
  gl::Context context;
  Scene scene;  // as of without_keyed_vertices
  GeometryBuffers geometry;
  GBufferPass gbuffer_pass;
  LightPass light_pass;
  Compositor compositor;
  GBuffer gbuffer{};
  LightBuffer light_buffer{};

  std::vector<std::uint32_t> ids{};
  std::vector<float> depth{};
  VisiblePoints points{};
  std::vector<glm::vec3> normals{};
  ShadowTracer hard{};
  ShadowMask hard_mask{};
  SoftShadowTracer soft{};
  SoftMask soft_mask{};
  std::vector<std::uint8_t> casters{};
  AmbientOcclusion ambient{};
  std::vector<float> openness{};
  std::unordered_set<std::string> said{};  // notes of earlier frames

  void read_samples(const FrameInput& input, const RenderSettings& settings, FrameTimings& timings);
  void points_from_depth(const ViewRays& view);
  Expected<void> occlude_ambient(const FrameInput& input, const RenderSettings& settings, FrameResult& result,
                                 const AoProgress& progress, const StopFlag* stop);
  Expected<void> light_hard(const FrameInput& input, const DrawnLight& light, const RenderSettings& settings,
                            FrameResult& result);
  Expected<void> light_soft(const FrameInput& input, const DrawnLight& light, const RenderSettings& settings,
                            FrameResult& result, const StopFlag* stop);
  void keep_new(std::vector<std::string>& notes);
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
                                             .scene = without_keyed_vertices(scene),
                                             .geometry = {},
                                             .gbuffer_pass = std::move(*gbuffer_pass),
                                             .light_pass = std::move(*light_pass),
                                             .compositor = std::move(*compositor)});
  if (auto uploaded = state->geometry.upload_materials(scene.materials); !uploaded) {
    return tl::unexpected(uploaded.error());
  }
  return Renderer(std::move(state));
}

const std::string& Renderer::gl_renderer() const {
  return state_->context.description();
}

void Renderer::set_lights(std::vector<Light> lights) {
  assert(lights.size() == state_->scene.lights.size());
  state_->scene.lights = std::move(lights);
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
  const bool exact = settings.samples == SampleSource::ids;
  const bool shaded = settings.shadows == ShadowMode::soft || settings.ao.mode != AoMode::none;
  const TriangleView triangles = triangle_view(input.geometry);
  with_threads(settings.threads, [&] {
    if (!exact) return points_from_depth(input.view);
    compute_visible_points(ids, gbuffer.width, gbuffer.height, input.view, triangles, points);
    if (shaded) compute_shading_normals(points, input.geometry.normals, input.view, triangles, normals);
  });
  timings.points_ms = watch.lap_ms();
}

Expected<void> Renderer::State::occlude_ambient(const FrameInput& input, const RenderSettings& settings,
                                                FrameResult& result, const AoProgress& progress,
                                                const StopFlag* stop) {
  Expected<void> done;
  with_threads(settings.threads, [&] {
    done = ambient.compute(scene, input.geometry, points, normals, settings.ao, openness, progress, stop);
  });
  if (!done) return done;
  result.ao = ambient.stats();
  result.timings.ao_build_ms = ambient.timings().ao_build_ms;
  result.timings.ao_ms = ambient.timings().ao_ms;
  result.notes.insert(result.notes.end(), ambient.notes().begin(), ambient.notes().end());
  return {};
}

/// One light as a point, with hard shadows or with none.
Expected<void> Renderer::State::light_hard(const FrameInput& input, const DrawnLight& light,
                                           const RenderSettings& settings, FrameResult& result) {
  Stopwatch watch;
  if (auto drawn = light_pass.draw(gbuffer, geometry, light.light, light.placed, light_buffer); !drawn)
    return drawn;
  result.timings.raster_ms += watch.lap_ms();
  if (settings.shadows == ShadowMode::none) {
    compositor.add_light(light_buffer, {});
    result.timings.writeback_ms += watch.lap_ms();
    return {};
  }
  HardShadowConfig config = settings.hard;
  if (settings.samples == SampleSource::depth) config.contact = ContactRule::none;
  with_threads(settings.threads, [&] {
    hard.trace_shadow_mask(points, input.view, triangle_view(input.geometry),
                           shadow_light(light.light, light.placed), config, hard_mask);
  });
  result.stats += hard.stats();
  add_shadow_times(result.timings, hard.timings());
  LightMask& out = result.masks.emplace_back();
  out.light = light.number;
  out.mask = {gbuffer.width, gbuffer.height, 1, hard_mask};
  if (settings.shadows == ShadowMode::soft) {
    out.visible_fraction = {gbuffer.width, gbuffer.height, 1, {}};
    for (const std::uint8_t lit : hard_mask) out.visible_fraction.pixels.push_back(lit != 0 ? 1.0f : 0.0f);
  }
  watch.lap_ms();
  compositor.add_light(light_buffer, hard_mask);
  result.timings.writeback_ms += watch.lap_ms();
  return {};
}

/// One light as a polygon: the visible part from each point and its irradiance.
Expected<void> Renderer::State::light_soft(const FrameInput& input, const DrawnLight& light,
                                           const RenderSettings& settings, FrameResult& result,
                                           const StopFlag* stop) {
  Stopwatch watch;
  if (auto drawn = light_pass.draw_area(gbuffer, geometry, light.light, light.placed, light.area->area_m2,
                                        light_buffer);
      !drawn) {
    return drawn;
  }
  result.timings.raster_ms += watch.lap_ms();
  TriangleView triangles = triangle_view(input.geometry);
  if (casters_off_plane(input.geometry, *light.area, casters)) triangles.casts_shadow = casters;
  result.timings.shaft_ms += watch.lap_ms();
  bool done = false;
  with_threads(settings.threads, [&] {
    done = soft.trace(points, normals, input.view, triangles, *light.area, settings.soft, soft_mask, stop);
  });
  if (!done) return fail("stopped");
  result.soft += soft.stats();
  add_shadow_times(result.timings, soft.timings());
  watch.lap_ms();
  LightMask& out = result.masks.emplace_back();
  out.light = light.number;
  out.visible_fraction = {gbuffer.width, gbuffer.height, 1, soft_mask.visible_fraction};
  out.mask = {gbuffer.width, gbuffer.height, 1, {}};
  for (const float fraction : soft_mask.visible_fraction) {
    out.mask.pixels.push_back(static_cast<std::uint8_t>(std::lround(255.0f * fraction)));
  }
  out.classes.assign(soft.classes().begin(), soft.classes().end());
  compositor.add_area_light(light_buffer, soft_mask.irradiance);
  result.timings.writeback_ms += watch.lap_ms();
  return {};
}

void Renderer::State::keep_new(std::vector<std::string>& notes) {
  std::erase_if(notes, [&](const std::string& note) { return !said.insert(note).second; });
}

// Olsson and Assarsson 2011, section 3.1: (1) rasterise, direct light apart; (2) rays and their hierarchy
// from what is seen; (3) triangles through the hierarchy; (4) blocked pixels lose the light; (5) add it up.
// Soft shadows put groups of what is seen and the light's visible parts in the place of (2) to (4).
Expected<void> Renderer::render_frame(const FrameInput& input, const RenderSettings& settings,
                                      FrameResult& result, const AoProgress& progress, const StopFlag* stop) {
  State& s = *state_;
  result.masks.clear();
  result.notes.clear();
  result.timings = {};
  result.stats = {};
  result.soft = {};
  result.ao = {};
  FrameTimings& timings = result.timings;
  Stopwatch watch, whole;
  if (auto checked = check_settings(settings); !checked) return checked;
  const auto lights = drawn_lights(s.scene, input, settings, result.notes);
  if (!lights) return tl::unexpected(lights.error());

  if (auto uploaded = s.geometry.upload(input.geometry); !uploaded) return uploaded;
  if (auto drawn = s.gbuffer_pass.draw(input.view, s.geometry, settings.width, settings.height, s.gbuffer);
      !drawn)
    return drawn;
  if (auto begun = s.compositor.begin(settings.width, settings.height); !begun) return begun;
  timings.raster_ms = watch.lap_ms();

  const bool occlusion = settings.ao.mode != AoMode::none;
  const bool shadows = settings.shadows != ShadowMode::none && !lights->empty();
  if (shadows || occlusion) s.read_samples(input, settings, timings);
  if (occlusion) {
    if (auto done = s.occlude_ambient(input, settings, result, progress, stop); !done) return done;
  }
  for (const DrawnLight& light : *lights) {
    if (stop_requested(stop)) return fail("stopped");
    auto lit = light.area ? s.light_soft(input, light, settings, result, stop)
                          : s.light_hard(input, light, settings, result);
    if (!lit) return lit;
  }
  watch.lap_ms();
  CompositeSettings composite{s.scene.ambient_light, s.scene.background, settings.exposure, {}};
  if (occlusion) composite.openness = s.openness;
  s.compositor.finish(s.gbuffer, s.geometry, composite, result.image);
  timings.composite_ms = watch.lap_ms();
  timings.total_ms = whole.lap_ms();
  s.keep_new(result.notes);
  return {};
}

}  // namespace tenebra
