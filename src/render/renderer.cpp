#include "render/renderer.h"

#include <algorithm>
#include <cassert>
#include <unordered_set>
#include <utility>

#include <tenebra/threads.h>
#include "base/fail.h"
#include "base/stopwatch.h"
#include "points/receiver.h"
#include "render/antialias/anti_aliaser.h"
#include "render/antialias/pattern.h"
#include "render/centres.h"
#include "render/cpu_shading.h"
#include "render/frame_aovs.h"
#include "render/lighter.h"
#include "render/see_through_layer.h"

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

/// What a renderer keeps from frame to frame.
struct Renderer::State {
  DrawnScene scene;
  FrameRaster raster;
  Lighter lighter{};
  SeeThroughLayer layer{};
  AntiAliaser anti_aliaser{};
  std::unique_ptr<FrameShading> shading = std::make_unique<CpuShading>();

  // Of the last frame.
  FrameInput recast{};  // its input as RenderSettings::see_through wants it
  std::vector<DrawnLight> lights{};
  Centres centres{};

  std::uint64_t frames_begun = 0;
  std::unordered_set<std::string> said{};  // notes of earlier frames

  /// As Renderer::render_frame, with the settings' threads.
  Expected<void> render(const FrameInput& given, const RenderSettings& settings, FrameResult& result,
                        const AoProgress& progress, const StopFlag* stop);
  /// Drops the last frame's answers, but for their memory.
  void begin(FrameResult& result);
  /// `input`, or a copy whose see-through surfaces cast as the settings say.
  const FrameInput& cast_as(SeeThrough see_through, const FrameInput& input);
  /// What each pixel sees.
  Expected<void> find_ids(const Frame& frame, FrameTimings& timings);
  Expected<void> begin_shading(const Frame& frame);
  /// The picture, from all of the above.
  Expected<void> shade(const Frame& frame, FrameResult& result);
  /// The colours behind the picture.
  Expected<void> keep_linear(const RenderSettings& settings, FrameResult& result) const;
};

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Renderer Renderer::create(FrameRaster raster, const Scene& scene) {
  auto shading = raster.take_shading();
  auto state = std::make_unique<State>(State{
      .scene = {without_keyed_vertices(scene), shade::SurfaceTable(scene), {}}, .raster = std::move(raster)});
  state->shading = std::move(shading);
  state->scene.coordinates = surface_coordinates(state->scene.scene);
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
  state_->scene.scene.lights = std::move(lights);
}

void Renderer::set_materials(const std::vector<Material>& materials) {
  DrawnScene& drawn = state_->scene;
  assert(materials.size() == drawn.scene.materials.size());
  drawn.scene.materials = materials;
  drawn.surfaces.set_factors(materials);
}

std::span<const std::uint32_t> Renderer::triangle_ids() const {
  return state_->centres.seen.ids;
}

const std::vector<DrawnLight>& Renderer::drawn_lights() const {
  return state_->lights;
}

void Renderer::set_environment(const io::ImageF& picture) {
  state_->scene.environment.emplace(picture);
}

std::vector<std::string> Renderer::take_debug_messages() {
  return state_->raster.take_debug_messages();
}

std::optional<glm::dvec3> Renderer::visible_point(const FrameInput& input, int x, int y) {
  const visibility::VisibleIds& seen = state_->centres.seen;
  if (x < 0 || y < 0 || x >= seen.width || y >= seen.height) return std::nullopt;
  const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
  const std::uint32_t id = seen.ids[row * static_cast<std::size_t>(seen.width) + column];
  if (id >= input.geometry.triangles.size()) return std::nullopt;
  const points::Receiver receiver = points::receiver_of(triangle_view(input.geometry), id);
  return points::PixelRays(input.view).point_on(receiver, column, row);
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
  base::Stopwatch watch;
  begin(result);
  if (auto checked = check_settings(settings); !checked) return checked;
  if (auto checked = raster.check_picture_size(settings.width, settings.height); !checked) return checked;
  if (auto checked = check_ids(given.ids, settings); !checked) return checked;
  const FrameInput& input = cast_as(settings.see_through, given);
  auto found_lights = render::drawn_lights(scene.scene, input, settings, result.notes);
  if (!found_lights) return tl::unexpected(found_lights.error());
  lights = std::move(*found_lights);
  const Frame frame{scene, input, settings, lights, ++frames_begun, stop};

  if (auto found = find_ids(frame, result.timings); !found) return found;
  if (auto begun = begin_shading(frame); !begun) return begun;
  if (frame.has_shadows() || frame.has_occlusion()) find_centre_points(frame, centres, result.timings);
  if (auto lit = lighter.light_centres(frame, progress, centres.lit, result); !lit) return lit;
  if (auto shaded = shade(frame, result); !shaded) return shaded;
  hand_over_masks(frame, centres, result);
  result.timings.total_ms = watch.lap_ms();

  lighter.note_changed_groups(settings.soft, result.notes);
  for (std::string& note : shading->take_notes()) result.notes.push_back(std::move(note));
  std::erase_if(result.notes, [&](const std::string& note) { return !said.insert(note).second; });
  return {};
}

void Renderer::State::begin(FrameResult& result) {
  reuse_masks(result.masks, centres);
  result.methods.clear();
  result.notes.clear();
  result.timings = {};
  result.stats = {};
  result.soft = {};
  result.ao = {};
  result.antialias = {};
}

const FrameInput& Renderer::State::cast_as(SeeThrough see_through, const FrameInput& input) {
  if (see_through == SeeThrough::tint || input.geometry.see_through.empty()) return input;
  recast = input;
  cast_see_through(see_through, recast.geometry);
  return recast;
}

Expected<void> Renderer::State::find_ids(const Frame& frame, FrameTimings& timings) {
  const RenderSettings& settings = frame.settings;
  const FrameInput& input = frame.input;
  visibility::VisibleIds& seen = centres.seen;
  if (input.ids.empty()) {
    const FrameRaster::Wish wish{.width = settings.width,
                                 .height = settings.height,
                                 .with_depth = settings.samples == SampleSource::depth,
                                 .simd = settings.hard.simd};
    return raster.draw(input.geometry, input.view, wish, seen, timings);
  }
  seen = {.width = settings.width, .height = settings.height, .transform = {}, .ids = input.ids};
  for (std::uint32_t& id : seen.ids)
    if (id >= input.geometry.triangles.size()) id = no_triangle;
  return {};
}

Expected<void> Renderer::State::begin_shading(const Frame& frame) {
  const RenderSettings& settings = frame.settings;
  const shade::Subject subject{frame.input.geometry, frame.input.view, scene.surfaces, frame.lifts_points()};
  const shade::Lighting lighting{lights, scene.scene.ambient_light, scene.scene.background,
                                 scene.environment ? &*scene.environment : nullptr};
  const shade::Display display{settings.exposure, settings.tone, scene.scene.transfer};
  const bool keeps_linear = settings.antialias > 1 || settings.linear || settings.linear_mean;
  return shading->begin({subject, lighting, display, settings.width, settings.height, centres.seen.ids,
                         keeps_linear, settings.linear_mean});
}

Expected<void> Renderer::State::keep_linear(const RenderSettings& settings, FrameResult& result) const {
  result.linear = {};
  result.linear_mean = {};
  result.seen.clear();
  if (settings.linear_mean) {
    if (auto copied = shading->copy_linear(result.linear_mean); !copied) return copied;
  }
  if (!settings.linear) return {};
  for (const std::uint32_t id : centres.seen.ids) result.seen.push_back(id != no_triangle ? 1 : 0);
  return shading->copy_linear(result.linear);
}

Expected<void> Renderer::State::shade(const Frame& frame, FrameResult& result) {
  base::Stopwatch all;
  centres.factors = centres.lit.factors();
  if (auto done = shading->shade_centres(centres.samples(), result.image); !done) return done;
  result.aovs = find_aovs(frame, centres, scene.surfaces);
  base::Stopwatch watch;
  if (auto drawn = layer.draw(frame, centres, lighter, *shading, result.image); !drawn) return drawn;
  if (centres.seen.has_layer) result.timings.layer_ms = watch.lap_ms();
  if (auto kept = keep_linear(frame.settings, result); !kept) return kept;
  const SampleStages stages{frame, centres, raster, lighter, layer, *shading};
  if (auto done = anti_aliaser.run(stages, result); !done) return done;
  result.timings.composite_ms = all.lap_ms() - result.timings.layer_ms - result.timings.antialias_ms;
  return {};
}

}  // namespace tenebra::render
