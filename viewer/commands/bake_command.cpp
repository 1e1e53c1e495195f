// tenebra bake: light and ambient occlusion into colours of vertices or a lightmap.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <memory>

#include "bake/baked_scene.h"
#include "bake/surface_light.h"
#include "base/fail.h"
#include "base/stopwatch.h"
#include "commands/command.h"
#include "io/exr/exr_file.h"
#include "io/output_file.h"
#include "options/bake_options.h"
#include "session/session.h"
#include "shade/display.h"
#include "shared/files_apart.h"
#include "shell/console.h"
#include "shell/memory_limit.h"
#include "shell/progress.h"
#include "shell/stop_signals.h"

namespace tenebra::viewer {
namespace {

constexpr const char* bake_examples =
    "Examples:\n"
    "  tenebra bake scenes/court.glb -o court.glb\n"
    "      light and occlusion in vertex colours; materials become unlit and show them unchanged\n"
    "  tenebra bake room.glb --to lightmap --size 2048 --shadows soft -o room_lit.glb\n"
    "      room_lit.exr for the second set of texture coordinates (TEXCOORD_1) of room_lit.glb\n"
    "  tenebra bake room.glb --to lightmap --what ao --map room_ao.png -o room_uv.glb\n"
    "      occlusion alone, 0 closed to 255 open\n"
    "\n"
    "The baked values are what a white diffuse surface shows, 1 being white; surfaces multiply them by their "
    "colour.\n"
    "Only the side that the normals point to is baked. A lightmap needs TEXCOORD_1, which Blender's Lightmap "
    "Pack\n"
    "makes. Meshes that overlap there each get a square of the map of their own, and OUT.glb has the "
    "matching\n"
    "coordinates. docs/bake.md says how three.js and Blender show the result.\n"
    "Exit code: 0 done, 1 failed (one sentence says why), 124 the time of --timeout is up, 129, 130 or 143 "
    "stopped by\n"
    "a signal; files are then whole or absent.";

/// A scene of one instant, its meshes separated for baking.
struct Baking {
  session::StagedScene staged;
  render::FrameInput input;
  bake::LightRequest request;
  std::vector<std::string> notes;
};

Expected<double> moment(const BakeOptions& options, const session::StagedScene& staged) {
  if (!options.frame) return options.scene.time_s.value_or(staged.time_of_frame(0));
  if (*options.frame >= staged.frames())
    return base::fail("--frame: frame {} does not exist, the animation has frames 0 to {}", *options.frame,
                      staged.frames() - 1);
  return staged.time_of_frame(*options.frame);
}

Expected<Baking> prepare(const BakeOptions& options) {
  SceneOptions of_scene = options.scene;
  of_scene.exposure_given = true;
  of_scene.shows = options.content == BakeContent::both && !options.ambient;  // the sky's ambient light
  if (options.content == BakeContent::ao) of_scene.sky = stage::Sky::none;
  auto staged = session::stage_scene(of_scene, session::Staging::for_light);
  if (!staged) return tl::unexpected(staged.error());
  Baking baking{.staged = std::move(*staged), .input = {}, .request = {}, .notes = {}};
  Scene& scene = baking.staged.scene;
  const bool no_light = scene.lights.empty() && options.scene.edits.added.empty();
  if (no_light && options.content != BakeContent::ao)
    return base::fail(
        "{}: found no light, expected one; --add-light adds it, --what ao needs none, and "
        "--sky auto lights it as pictures are",
        options.scene.file);
  bake::separate_meshes(scene);
  if (options.target == BakeTarget::vertices) bake::separate_flat_corners(scene);
  const auto time_s = moment(options, baking.staged);
  if (!time_s) return tl::unexpected(time_s.error());

  session::evaluate(scene, options.scene.edits, baking.staged.clip, *time_s, baking.input);
  baking.request.settings =
      session::with_edits(bake_settings(options, baking.staged.display), options.scene.edits);
  baking.request.direct = options.content != BakeContent::ao;
  if (options.content == BakeContent::both)
    baking.request.ambient = options.ambient.value_or(scene.ambient_light);
  if (options.content == BakeContent::both && baking.request.ambient == glm::vec3(0.0f))
    baking.notes.emplace_back(
        "the scene has no ambient light, so occlusion does not change the light; --ambient 0.2,0.2,0.2 adds "
        "some");
  return baking;
}

/// The scene that is lit, with its lights and materials as edited; `light` refers to it.
struct LitScene {
  Scene scene;
  std::optional<bake::SurfaceLight> light;
};
Expected<void> light_scene(const BakeOptions& options, Baking& baking, LitScene& out) {
  out.scene = baking.staged.scene;
  out.scene.lights =
      stage::lights_of(baking.staged.scene, options.scene.edits, baking.staged.light_has_units);
  out.scene.materials = stage::materials_of(baking.staged.scene, options.scene.edits);
  auto light = bake::SurfaceLight::create(out.scene, baking.input, baking.request, baking.notes);
  if (!light) return tl::unexpected(light.error());
  out.light = std::move(*light);
  stage::remove_added(baking.staged.added, baking.staged.scene);  // the written file lights itself
  return {};
}

/// Shows the progress over several portions.
class PortionProgress {
public:
  PortionProgress(std::size_t portions, bool quiet)
      : portions_(static_cast<double>(portions)), line_(1, quiet) {}
  QueryProgress begin(std::size_t portion) {
    return [this, portion](double done) {
      line_.show_building("light", (static_cast<double>(portion) + done) / portions_);
    };
  }

private:
  double portions_;
  Progress line_;
};

Expected<std::vector<bake::Light>> bake_vertices(Baking& baking, bake::SurfaceLight& light,
                                                 const BakeOptions& options, const StopFlag& stop) {
  constexpr std::size_t portion = std::size_t{1} << 18;
  const FrameGeometry& frame = baking.input.geometry;
  std::vector<bake::Sample> samples = bake::vertex_samples(frame);
  bake::move_inside(frame, bake::edge_margin(bake::extent_of(frame)), samples);
  std::vector<bake::Light> values(samples.size());
  const std::size_t portions = (samples.size() + portion - 1) / portion;
  PortionProgress progress(portions, options.quiet);
  for (std::size_t i = 0; i < portions; ++i) {
    const std::size_t first = i * portion, count = std::min(portion, samples.size() - first);
    auto done = light.at(std::span(samples).subspan(first, count), std::span(values).subspan(first, count),
                         &stop, progress.begin(i));
    if (!done) return tl::unexpected(done.error());
  }
  return bake::vertex_light(samples, values, frame.positions.size());
}

Expected<bake::BakedMap> bake_map(Baking& baking, bake::SurfaceLight& light, const BakeOptions& options,
                                  const bake::TexelCoverage& coverage, const StopFlag& stop) {
  const FrameGeometry& frame = baking.input.geometry;
  const double margin_m = bake::edge_margin(bake::extent_of(frame));
  bake::BakedMap map(options.size);
  const int bands = (options.size + bake::TexelCoverage::band_rows - 1) / bake::TexelCoverage::band_rows;
  PortionProgress progress(static_cast<std::size_t>(bands), options.quiet);
  std::vector<bake::Sample> samples;
  std::vector<bake::Light> values;
  for (int band = 0; band < bands; ++band) {
    coverage.samples_of_band(band * bake::TexelCoverage::band_rows, samples);
    bake::move_inside(frame, margin_m, samples);
    values.resize(samples.size());
    auto done = light.at(samples, values, &stop, progress.begin(static_cast<std::size_t>(band)));
    if (!done) return tl::unexpected(done.error());
    bake::add_means(samples, values, map);
  }
  return map;
}

/// What the coordinates leave unbaked, one sentence each.
void note_coverage(const bake::ScenePlaces& places, const bake::TexelCoverage& coverage,
                   std::vector<std::string>& notes) {
  if (!places.parts_without.empty())
    notes.push_back(fmt::format("{} meshes have no TEXCOORD_1 and no place in the map, the first is '{}'",
                                places.parts_without.size(), places.parts_without.front()));
  if (places.flat > 0)
    notes.push_back(
        fmt::format("{} triangles have no area in TEXCOORD_1 and no place in the map", places.flat));
  if (places.outside > 0)
    notes.push_back(fmt::format("{} triangles reach beyond 0 to 1 in TEXCOORD_1 and have no place in the map",
                                places.outside));
  if (places.own_squares)
    notes.emplace_back("meshes overlap in TEXCOORD_1: each got a square of the map of its own");
  const std::size_t overlaps = coverage.overlaps_within() + coverage.overlaps_between();
  if (overlaps * 1000 > coverage.covered_places())
    notes.push_back(
        fmt::format("{:.1f} % of the covered texels lie in two triangles or more, of which the first counts; "
                    "an unwrapping without overlaps, like Blender's Lightmap Pack, has none",
                    100.0 * static_cast<double>(overlaps) / static_cast<double>(coverage.covered_places())));
}

Expected<std::string> encode_map(const bake::BakedMap& map, const BakeOptions& options) {
  const std::size_t count = map.texels.size();
  const bool ao_alone = options.content == BakeContent::ao, ao = options.content != BakeContent::light;
  if (options.map.ends_with(".png")) {
    io::Image8 image{map.size, map.size, ao_alone ? 1 : 3, {}};
    image.pixels.resize(count * static_cast<std::size_t>(image.channels));
    for (std::size_t i = 0; i < count; ++i) {
      if (ao_alone)
        image.pixels[i] =
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(map.texels[i].a, 0.0f, 1.0f)));
      else
        shade::encode_shown({}, glm::min(options.exposure * glm::vec3(map.texels[i]), 1.0f),
                            &image.pixels[3 * i]);
    }
    return io::encode_png(image);
  }
  std::span<const float> values(&map.texels.data()->x, 4 * count);
  io::exr::Picture picture{.width = map.size, .height = map.size};
  const char* const names[] = {"R", "G", "B"};
  if (ao_alone)
    picture.channels.push_back({"Y", io::exr::Floats{values.subspan(3), 4}});
  else
    for (std::size_t c = 0; c < 3; ++c)
      picture.channels.push_back({names[c], io::exr::Floats{values.subspan(c), 4}});
  if (ao && !ao_alone) picture.channels.push_back({"ao", io::exr::Floats{values.subspan(3), 4}});
  picture.texts = {{"software", "tenebra"},
                   {"tenebra/texels", ao_alone ? "openness: 1 open, 0 closed"
                                               : "what a white diffuse surface shows, linear; ao: openness"}};
  return io::exr::encode(picture);
}

void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) print_error("note: {}\n", note);
}

Expected<void> write_scene(const Scene& scene, const BakeOptions& options) {
  io::remove_stale_temporaries(std::filesystem::path(options.output).parent_path());
  const auto losses = formats::export_glb(scene, options.output, options.scene.fps);
  if (!losses) return tl::unexpected(losses.error());
  if (!options.quiet) print_warnings(*losses);
  return {};
}

/// Down to two significant digits.
double rounded_down(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::floor(value / unit) * unit;
}

Expected<void> to_vertices(Baking& baking, LitScene& lit, const BakeOptions& options, const StopFlag& stop) {
  base::Stopwatch watch;
  const auto values = bake_vertices(baking, *lit.light, options, stop);
  if (!values) return tl::unexpected(values.error());
  const double ms = watch.lap_ms();
  Scene& scene = baking.staged.scene;
  const auto clipped =
      bake::colour_vertices(scene, *values, options.exposure, options.content == BakeContent::ao);
  if (clipped.vertices > 0 && options.content != BakeContent::ao)
    baking.notes.push_back(fmt::format(
        "{} of {} vertices are brighter than white and cut off; --exposure {:.2g} would leave none",
        clipped.vertices, values->size(), rounded_down(options.exposure / clipped.brightest)));
  if (!options.quiet) print_notes(baking.notes);
  if (auto written = write_scene(scene, options); !written) return written;
  if (!options.quiet)
    print_out("{} vertices, {} lights, {:.2f} s: {}\n", values->size(), lit.light->lights(), ms / 1e3,
              options.output);
  return {};
}

Expected<void> to_lightmap(Baking& baking, LitScene& lit, const BakeOptions& options, const StopFlag& stop) {
  base::Stopwatch watch;
  auto places = bake::place_in_map(baking.staged.scene, baking.input.geometry, options.size);
  if (!places) return base::fail("{}: {}", options.scene.file, places.error().message);
  const bake::TexelCoverage coverage(places->triangles, options.size, options.per_side);
  if (coverage.covered_places() == 0)
    return base::fail("{}: found no triangle with a place in the map, expected TEXCOORD_1 from 0 to 1",
                      options.scene.file);
  note_coverage(*places, coverage, baking.notes);
  if (!options.quiet) print_notes(baking.notes);
  auto map = bake_map(baking, *lit.light, options, coverage, stop);
  if (!map) return tl::unexpected(map.error());
  const std::size_t texels = map->filled_texels(), lit_texels = map->lit_texels();
  bake::dilate(*map, options.rings);
  const double ms = watch.lap_ms();
  const auto bytes = encode_map(*map, options);
  if (!bytes) return base::fail("{}: {}", options.map, bytes.error().message);
  if (auto written = io::write_file(options.map, *bytes); !written) return written;
  if (auto written = write_scene(baking.staged.scene, options); !written) return written;
  if (!options.quiet)
    print_out("{}x{} texels, {} covered, {} lit, {} lights, {:.2f} s: {}, {}\n", options.size, options.size,
              texels, lit_texels, lit.light->lights(), ms / 1e3, options.map, options.output);
  return {};
}

Expected<void> check_outputs(const Baking& baking, const BakeOptions& options) {
  return check_files_apart(
      baking.staged.inputs,
      [&](const std::function<Expected<void>(const OutputName&)>& use) -> Expected<void> {
        if (auto used = use({"-o", options.output}); !used) return used;
        if (options.map.empty()) return {};
        return use({"--map", options.map});
      });
}

Expected<int> bake_scene(const BakeOptions& options) {
  if (auto limited = limit_memory(options.memory_mb); !limited) return tl::unexpected(limited.error());
  StopSignals stop(options.timeout_s, StopSignals::Start::at_once);
  auto baking = prepare(options);
  if (!baking) return tl::unexpected(baking.error());
  if (auto apart = check_outputs(*baking, options); !apart) return tl::unexpected(apart.error());
  if (!options.quiet) print_warnings(baking->staged.scene.warnings);
  LitScene lit;
  if (auto made = light_scene(options, *baking, lit); !made) return tl::unexpected(made.error());
  stop.be_orderly();
  const auto done = options.target == BakeTarget::vertices ? to_vertices(*baking, lit, options, stop.flag())
                                                           : to_lightmap(*baking, lit, options, stop.flag());
  if (is_stop(done)) {
    print_error("tenebra: stopped before the light was baked, nothing is written\n");
    return stop.exit_code();
  }
  if (!done) return tl::unexpected(done.error());
  return 0;
}

}  // namespace

void add_bake_command(CLI::App& program, Run& run) {
  CLI::App& command =
      add_command(program, "bake", "Bake light and occlusion into vertex colours or a lightmap");
  const auto options = std::make_shared<BakeOptions>();
  set_examples(command, bake_examples);
  add_bake_options(command, *options);
  when_chosen(command, [options, &command, &run] {
    const auto settled = settle_bake_options(command, *options);
    run = [options, settled]() -> Expected<int> {
      if (!settled) return tl::unexpected(settled.error());
      return bake_scene(*options);
    };
  });
}

}  // namespace tenebra::viewer
