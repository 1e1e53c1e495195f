#include "render/renderer.h"

#include <algorithm>
#include <cassert>

#include <tenebra/threads.h>
#include "base/fail.h"
#include "base/stopwatch.h"
#include "render/antialias/pattern.h"
#include "render/renderer_state.h"

namespace tenebra::render {

namespace {

/// The scene but for the vertices of deforming meshes at their key times (FrameGeometry has them of each
/// frame, and they are most of a large animation) and, where nothing is see-through, images: the surfaces
/// hold what they need.
Scene without_keyed_vertices(Scene scene) {
  for (Mesh& mesh : scene.meshes) {
    for (MorphTarget& target : mesh.morph_targets) target = {};
    for (Mesh::Shape& shape : mesh.shapes) shape = {shape.time_s, {}, {}};
  }
  const bool see_through = std::any_of(scene.materials.begin(), scene.materials.end(),
                                       [](const Material& material) { return material.see_through(); });
  if (!see_through) scene.images.clear();
  return scene;
}

/// Fails on settings that exclude each other: soft shadows and ambient occlusion start from exact points on
/// triangles.
Expected<void> check_settings(const RenderSettings& settings) {
  const bool needs_ids = settings.shadows == ShadowMode::soft || settings.ao.mode != AoMode::none;
  if (needs_ids && settings.samples == SampleSource::depth) {
    return base::fail("samples from the depth buffer: {} needs the exact points from triangle ids",
                      settings.shadows == ShadowMode::soft ? "a soft shadow" : "ambient occlusion");
  }
  if (!is_sample_count(settings.antialias))
    return base::fail("anti-aliasing: found {} samples per pixel, expected 1, 2, 4, 8 or 16",
                      settings.antialias);
  if (settings.antialias > 16 && !settings.antialias_everywhere)
    return base::fail("anti-aliasing: found {} samples per pixel for some pixels only, expected at most 16",
                      settings.antialias);
  return {};
}

/// Ids that another renderer has drawn.
Expected<void> check_ids(std::span<const std::uint32_t> ids, const RenderSettings& settings) {
  if (ids.empty()) return {};
  if (ids.size() != static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height))
    return base::fail("ids that were handed in: found {}, expected {}x{}", ids.size(), settings.width,
                      settings.height);
  if (settings.antialias != 1 || settings.samples != SampleSource::ids)
    return base::fail("ids that were handed in: expected one sample per pixel, from ids");
  return {};
}

}  // namespace

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Renderer Renderer::create(FrameRaster raster, const Scene& scene) {
  auto state = std::make_unique<State>(State{.raster = std::move(raster),
                                             .scene = without_keyed_vertices(scene),
                                             .surfaces = shade::SurfaceTable(scene)});
  state->coordinates = surface_coordinates(state->scene);
  return Renderer(std::move(state));
}

Expected<Renderer> Renderer::create(gl::Context context, const Scene& scene) {
  auto raster = FrameRaster::create(std::move(context));
  if (!raster) return tl::unexpected(raster.error());
  return create(std::move(*raster), scene);
}

const FrameRaster& Renderer::raster() const {
  return state_->raster;
}

void Renderer::set_lights(std::vector<Light> lights) {
  state_->scene.lights = std::move(lights);
}

void Renderer::set_materials(const std::vector<Material>& materials) {
  assert(materials.size() == state_->scene.materials.size());
  state_->scene.materials = materials;
  state_->surfaces.set_factors(materials);
}

std::span<const std::uint32_t> Renderer::triangle_ids() const {
  return state_->seen.ids;
}

const std::vector<DrawnLight>& Renderer::drawn_lights() const {
  return state_->drawn;
}

void Renderer::set_environment(const io::ImageF& picture) {
  state_->environment.emplace(picture);
}

std::vector<std::string> Renderer::take_debug_messages() {
  return state_->raster.take_debug_messages();
}

std::optional<glm::dvec3> Renderer::visible_point(const FrameInput& input, int x, int y) {
  State& s = *state_;
  if (x < 0 || y < 0 || x >= s.seen.width || y >= s.seen.height) return std::nullopt;
  compute_visible_points(s.seen.ids, s.seen.width, s.seen.height, input.view, triangle_view(input.geometry),
                         s.points);
  const auto pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(s.seen.width) + static_cast<std::size_t>(x);
  if (s.points.triangles[pixel] == no_triangle) return std::nullopt;
  return s.points.positions[pixel];
}

Expected<void> Renderer::render_frame(const FrameInput& input, const RenderSettings& settings,
                                      FrameResult& result, const AoProgress& progress, const StopFlag* stop) {
  Expected<void> drawn;
  with_threads(settings.threads, [&] { drawn = state_->render(input, settings, result, progress, stop); });
  return drawn;
}

// Olsson and Assarsson 2011, section 3.1: (1) rasterise; (2) rays and their hierarchy from what is seen;
// (3) triangles through the hierarchy; (4) blocked pixels lose the light; (5) add it up. The paper draws the
// light of (1) into buffers that (4) and (5) read; here it is computed where it is added, in one pass over
// all lights. Soft shadows put groups of what is seen and the light's visible parts in the place of (2) to
// (4).
Expected<void> Renderer::State::render(const FrameInput& given, const RenderSettings& settings,
                                       FrameResult& result, const AoProgress& progress,
                                       const StopFlag* stop) {
  ++frames_begun;
  const FrameInput& input = cast_as(settings.see_through, given);
  result.masks.clear();
  result.methods.clear();
  result.notes.clear();
  result.timings = {};
  result.stats = {};
  result.soft = {};
  result.ao = {};
  result.antialias = {};
  groups_changed = false;
  FrameTimings& timings = result.timings;
  base::Stopwatch watch, whole;
  if (auto checked = check_settings(settings); !checked) return checked;
  if (auto checked = raster.check_picture_size(settings.width, settings.height); !checked) return checked;
  if (auto checked = check_ids(input.ids, settings); !checked) return checked;
  auto lights = render::drawn_lights(scene, input, settings, result.notes);
  if (!lights) return tl::unexpected(lights.error());
  drawn = std::move(*lights);

  if (auto found = find_ids(input, settings, timings); !found) return found;
  if (auto begun = begin_shading(input, drawn, settings); !begun) return begun;
  const bool occlusion = settings.ao.mode != AoMode::none;
  const bool shadows = settings.shadows != ShadowMode::none && !drawn.empty();
  if (shadows || occlusion) find_points(input, drawn, settings, timings);
  if (occlusion) {
    if (auto done = occlude_ambient(input, settings, result, progress, stop); !done) return done;
  }
  if (auto traced = trace_lights(input, drawn, settings, result, stop); !traced) return traced;
  watch.lap_ms();
  if (auto shaded = shade_pixels(input, drawn, settings, result, stop); !shaded) return shaded;
  timings.composite_ms = watch.lap_ms() - timings.layer_ms - timings.antialias_ms;
  timings.total_ms = whole.lap_ms();
  note_changed_groups(settings.soft, result.notes);
  keep_new(result.notes);
  return {};
}

}  // namespace tenebra::render
