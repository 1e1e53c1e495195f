// tenebra info: what a scene file holds, or which OpenGL the machine has, as text or JSON.
#include <fmt/core.h>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>

#include "base/fail.h"
#include "commands/command.h"
#include "commands/gl_survey.h"
#include "formats/format_list.h"
#include "options/memory_option.h"
#include "options/method_options.h"
#include "options/scene_options.h"
#include "options/settings_names.h"
#include "session/brightness.h"
#include "session/scene_summary.h"
#include "session/staged_scene.h"
#include "shell/console.h"
#include "shell/memory_limit.h"
#include "stage/additions.h"
#include "stage/cutout/cutout.h"
#include "stage/left_out.h"
#include "stage/looks.h"

namespace tenebra::viewer {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* info_examples =
    "Examples:\n"
    "  tenebra info scenes/city.glb\n"
    "  tenebra info scenes/city.glb --json | python3 -m json.tool\n"
    "  tenebra info --gl\n"
    "  tenebra info --formats\n"
    "\n"
    "Triangles and bounds are those of the first frame; bounds are in metres, along the axes and from the "
    "zero\n"
    "of the file. Where the file does not number its frames, they are counted at --fps.";

struct InfoOptions {
  SceneOptions scene;
  double fps = 30.0;
  std::optional<int> memory_mb;
  bool meter = false;
  bool json = false;
  bool gl = false;
  bool formats = false;
};

template <class T>
Json list(const glm::vec<3, T>& v) {
  return {v.x, v.y, v.z};
}

/// A place of the scene along the axes and from the zero of its file, in metres.
Json metres_in_file(const FileFrame& frame, const glm::vec3& place) {
  if (frame.is_identity()) return list(place);
  return list(frame.to_file(glm::dvec3(place)) * frame.metres_per_unit);
}
Json turned_to_file(const FileFrame& frame, const glm::vec3& direction) {
  return list(glm::vec3(frame.direction_to_file(glm::dvec3(direction))));
}

/// Which way the file's coordinates are taken, and what of it is no statement of the file's or the user's.
Json coordinates_of(const Scene& scene, const InfoOptions& options) {
  const formats::Placement& asked = options.scene.import.placement;
  const formats::FileFormat* const format = formats::format_of(options.scene.file);
  const bool stated = format != nullptr && format->states_coordinates;
  Json json{{"up", scene.frame.up == UpAxis::z ? "z" : "y"},
            {"metres_per_unit", scene.frame.metres_per_unit},
            {"offset", list(scene.frame.origin)}};
  Json assumed = Json::array();
  if (!stated && !asked.up) assumed.push_back("up");
  if (!stated && !asked.metres_per_unit) assumed.push_back("metres_per_unit");
  if (asked.offset == formats::OffsetChoice::automatic && scene.frame.origin != glm::dvec3(0.0))
    assumed.push_back("offset");
  json["assumed"] = assumed;
  return json;
}

/// Low and high corners of the scene's bounds.
Json bounds_of(const FileFrame& frame, const session::Bounds& bounds) {
  const Json a = metres_in_file(frame, bounds.low), b = metres_in_file(frame, bounds.high);
  Json json;
  for (int axis = 0; axis < 3; ++axis) {  // Z that points up turns over
    const bool in_order = a[axis] <= b[axis];
    json["low"].push_back(in_order ? a[axis] : b[axis]);
    json["high"].push_back(in_order ? b[axis] : a[axis]);
  }
  return json;
}

double degrees(float radians) {
  return radians * 180.0 / std::numbers::pi;
}

Json counts_of(const Scene& scene, const session::SceneSummary& summary) {
  std::size_t morph_targets = 0;
  for (const Mesh& mesh : scene.meshes) morph_targets += mesh.morph_targets.size();
  return {{"triangles", summary.triangles},
          {"casting_triangles", summary.casting_triangles},
          {"dropped_non_finite", summary.dropped_non_finite},
          {"vertices", summary.vertices},
          {"nodes", scene.nodes.size()},
          {"meshes", scene.meshes.size()},
          {"materials", scene.materials.size()},
          {"skins", scene.skins.size()},
          {"morph_targets", morph_targets},
          {"instances", summary.instances},
          {"channels", summary.channels}};
}

/// Triangles of the first frame by what their materials say.
Json surfaces_of(const session::SurfaceCounts& counts) {
  return {{"textured", counts.textured},       {"normal_mapped", counts.normal_mapped},
          {"specular", counts.specular},       {"metallic", counts.metallic},
          {"emissive", counts.emissive},       {"unlit", counts.unlit},
          {"vertex_colors", counts.colored},   {"alpha_mask", counts.alpha_mask},
          {"alpha_blend", counts.alpha_blend}, {"transmission", counts.transmission},
          {"see_through", counts.see_through}};
}

Json images_of(const Scene& scene) {
  Json images = Json::array();
  for (const TextureImage& image : scene.images)
    images.push_back({{"name", image.name}, {"size_px", {image.width, image.height}}});
  return images;
}

Json unused_of(const Scene& scene) {
  Json unused = Json::array();
  for (const UnusedContent& content : scene.unused)
    unused.push_back({{"name", content.name}, {"count", content.count}});
  return unused;
}

Json lights_of(const Scene& scene, const session::SceneSummary& summary) {
  Json lights = Json::array();
  for (const WorldLight& placed : summary.lights) {
    const Light& light = scene.lights[static_cast<std::size_t>(placed.light)];
    Json entry{{"name", light.name}, {"type", session::light_type_name(light.type)}};
    if (light.type != LightType::directional)
      entry["position_m"] = metres_in_file(scene.frame, placed.position);
    if (light.type != LightType::point) entry["direction"] = turned_to_file(scene.frame, placed.direction);
    entry["color"] = list(light.color);
    entry["intensity"] = light.intensity;
    if (light.type == LightType::spot) {
      entry["half_angles_deg"] = {degrees(light.inner_cone_rad), degrees(light.outer_cone_rad)};
    }
    if (light.type == LightType::area_rect || light.type == LightType::area_disk) {
      entry["size_m"] = {2 * glm::length(placed.axis_x), 2 * glm::length(placed.axis_y)};
    }
    if (light.diameter_deg > 0) entry["diameter_deg"] = light.diameter_deg;
    if (light.range_m) entry["range_m"] = *light.range_m;
    lights.push_back(entry);
  }
  return lights;
}

Json cameras_of(const Scene& scene) {
  Json cameras = Json::array();
  for (const Camera& camera : scene.cameras) {
    const bool perspective = camera.projection == Projection::perspective;
    Json entry{{"name", camera.name}, {"projection", perspective ? "perspective" : "orthographic"}};
    if (perspective) entry["vertical_fov_deg"] = degrees(camera.vertical_fov_rad);
    if (!perspective) entry["vertical_extent_m"] = camera.vertical_extent_m;
    if (camera.aspect) entry["aspect"] = *camera.aspect;
    cameras.push_back(entry);
  }
  return cameras;
}

Json clips_of(const Scene& scene, double fps) {
  Json clips = Json::array();
  for (const Clip& clip : scene.clips) {
    clips.push_back({{"name", clip.name},
                     {"start_s", clip.start_s},
                     {"end_s", clip.end_s},
                     {"frames", frame_count(clip, fps)},
                     {"channels", clip.channels.size()}});
  }
  return clips;
}

/// How pictures show the scene's colours where no option says otherwise.
Json shown_of(const Scene& scene) {
  return {{"exposure", 1}, {"tone", shade::tone_name(tone_of({}, scene.transfer))}};
}

Json describe(const Scene& scene, const InfoOptions& options) {
  const session::SceneSummary summary = session::summarize_scene(scene);
  Json json{{"file", options.scene.file}, {"name", scene.name}, {"counts", counts_of(scene, summary)}};
  json["coordinates"] = coordinates_of(scene, options);
  json["bounds_m"] = nullptr;
  if (summary.bounds) json["bounds_m"] = bounds_of(scene.frame, *summary.bounds);
  json["triangles_with"] = surfaces_of(summary.surfaces);
  json["colors"] = scene.transfer == Transfer::display ? "display values" : "linear, shown as sRGB";
  json["shown"] = shown_of(scene);
  json["images"] = images_of(scene);
  json["extensions"] = scene.extensions;
  json["unused"] = unused_of(scene);
  json["lights"] = lights_of(scene, summary);
  json["cameras"] = cameras_of(scene);
  json["clips"] = clips_of(scene, options.fps);
  json["warnings"] = scene.warnings;
  return json;
}

/// To six digits or, where these do not reach, to a thousandth; without a negative zero.
std::string number_text(double number) {
  if (std::abs(number) < 1e4 || std::abs(number) >= 1e12) return fmt::format("{:.6g}", number + 0.0);
  return fmt::format("{}", std::round(number * 1000) / 1000);
}

/// For people: numbers in short, texts unquoted, vectors in parentheses.
std::string text_of(const Json& value) {
  if (value.is_string() && value.get_ref<const std::string&>().empty()) return "-";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return number_text(value.get<double>());
  if (!value.is_array()) return value.dump();
  if (value.empty()) return "none";
  std::string text;
  for (const Json& entry : value) text += (text.empty() ? "(" : ", ") + text_of(entry);
  return text + ")";
}

/// One line: "name value, name value, ...".
std::string line_of(const Json& object) {
  std::string line;
  for (const auto& [key, value] : object.items()) {
    line += fmt::format("{}{} {}", line.empty() ? "" : ", ", key, text_of(value));
  }
  return line;
}

void print_list(const Json& json, const char* key) {
  const Json& entries = json[key];
  print_out("{}: {}\n", key, entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    print_out("  {}: {}\n", i, entries[i].is_object() ? line_of(entries[i]) : text_of(entries[i]));
  }
}

void print_text(const Json& json) {
  print_out("{}\n", json["file"].get<std::string>());
  for (const auto& [key, value] : json["counts"].items()) print_out("{}: {}\n", key, value.dump());
  print_out("coordinates: {}\n", line_of(json["coordinates"]));
  print_out("bounds_m: {}\n", json["bounds_m"].is_null() ? "none" : line_of(json["bounds_m"]));
  print_out("triangles_with: {}\n", line_of(json["triangles_with"]));
  print_out("colors: {}\n", json["colors"].get<std::string>());
  print_out("shown: {}\n", line_of(json["shown"]));
  std::string unused;
  for (const Json& content : json["unused"])
    unused += fmt::format("{}{} ({})", unused.empty() ? "" : ", ", content["name"].get<std::string>(),
                          content["count"].dump());
  print_out("unused: {}\n", unused.empty() ? "none" : unused);
  for (const char* key : {"images", "extensions", "lights", "cameras", "clips", "warnings", "added"})
    print_list(json, key);
}

/// What drawing changes, last: parts that are added, emission that is left out, and what alpha cuts out.
void add_changes(Scene& scene, Json& json) {
  const auto move_said = [&](const char* key, std::size_t from) {
    json[key] = json.value(key, Json::array());
    for (std::size_t i = from; i < scene.warnings.size(); ++i) json[key].push_back(scene.warnings[i]);
  };
  std::size_t said = scene.warnings.size();
  stage::leave_out_blank_emission(scene);
  move_said("warnings", said);
  said = scene.warnings.size();
  stage::add_missing_parts(scene);
  move_said("added", said);
  said = scene.warnings.size();
  const stage::CutoutCounts counts = stage::cut_out_masks(scene);
  json["counts"]["cut_out_triangles"] = counts.triangles;
  json["counts"]["drawn_in_their_place"] = counts.left;
  move_said("warnings", said);
}

/// How pictures are exposed, and the sky that goes with it, where these have to be measured; and what
/// --exposure auto would be.
Expected<void> add_metered(const InfoOptions& options, bool unknown, Json& json) {
  if (!options.meter && !unknown) return {};
  SceneOptions of_scene = options.scene;
  of_scene.meter_exposure = true;
  const auto staged = session::stage_scene(of_scene);
  if (!staged) return tl::unexpected(staged.error());
  const settings::SceneDisplay& display = staged->display;
  json["shown"]["exposure"] = settings::render_settings({}, {}, display).exposure;
  const auto& said = staged->scene.warnings;  // the newest last
  const std::size_t newest = std::size_t{staged->added.sky} + std::size_t{display.needs_exposure};
  for (std::size_t i = said.size() - newest; i < said.size(); ++i) json["added"].push_back(said[i]);
  if (!options.meter) return {};
  for (const shade::Tone tone : shade::tones)
    json["shown"][fmt::format("auto_{}", shade::tone_name(tone))] =
        (*display.exposures)[static_cast<std::size_t>(tone)];
  return {};
}

/// Which files are read.
int print_formats(bool as_json) {
  Json list = Json::array();
  for (const formats::FileFormat& format : formats::file_formats())
    list.push_back({{"extensions", format.extensions},
                    {"name", format.name},
                    {"reader", format.reader},
                    {"kept", format.kept},
                    {"states_coordinates", format.states_coordinates}});
  if (as_json) print_out("{}\n", list.dump(2));
  if (!as_json)
    for (const formats::FileFormat& format : formats::file_formats())
      print_out("{:<20}{:<28}{:<8}{}\n", format.extensions, format.name, format.reader, format.kept);
  return 0;
}

Expected<int> info(const InfoOptions& options) {
  if (options.gl) return print_gl_survey(options.json);
  if (options.formats) return print_formats(options.json);
  if (options.scene.file.empty()) return base::fail("SCENE is required, or --gl or --formats");
  if (auto limited = limit_memory(options.memory_mb); !limited) return tl::unexpected(limited.error());
  auto scene = formats::import_scene(options.scene.file, options.scene.import);
  if (!scene) return tl::unexpected(scene.error());
  const bool unknown = session::has_units(*scene) && !session::states_surroundings(*scene);
  stage::leave_out_covers(*scene);
  Json json = describe(*scene, options);
  add_changes(*scene, json);
  if (auto metered = add_metered(options, unknown, json); !metered) return tl::unexpected(metered.error());
  if (options.json) {
    // File names and names in files may hold bytes that are not UTF-8, which JSON cannot.
    print_out("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
  } else {
    print_text(json);
  }
  return 0;
}

}  // namespace

void add_info_command(CLI::App& program, Run& run) {
  CLI::App& command =
      add_command(program, "info", "Say what a scene contains: counts, bounds, lights, cameras, animations");
  const auto options = std::make_shared<InfoOptions>();
  set_examples(command, info_examples);
  add_text(command, "SCENE", options->scene.file, "Scene file (--formats)");
  add_import_options(command, options->scene);
  add_flag(command, "--meter", options->meter, "Also measure what --exposure auto is, with each tone");
  add_flag(command, "--json", options->json, "Print JSON");
  add_flag(command, "--gl", options->gl, "Say which OpenGL this machine has, in place of a scene");
  add_flag(command, "--formats", options->formats,
           "List the kinds of files that are read, in place of a scene");
  add_memory_option(command, options->memory_mb);
  add_value(command, "--fps", options->fps, parse_positive, "Frames per second, to count frames [30]")
      .type_name("F");
  when_chosen(command, [options, &run] { run = [options] { return info(*options); }; });
}

}  // namespace tenebra::viewer
