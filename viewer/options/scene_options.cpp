#include "options/scene_options.h"
#include "options/edit_texts.h"

#include "base/fail.h"
#include "options/choices.h"

namespace tenebra::viewer {
namespace {

constexpr const char* scene_group = "Scene and moment";
constexpr const char* camera_group = "Camera";

Expected<int> parse_cone_sides(const std::string& text) {
  const auto sides = parse_count(text);
  if (!sides || *sides < 3 || *sides > 4096) return base::fail("found {}, expected 3 to 4096", text);
  return sides;
}

void add_files(CLI::App& command, SceneOptions& options) {
  add_text(command, "SCENE", options.file, "Scene file: .gltf .glb .aff .nff .obj");
  add_text(command, "--scene", options.import.scene,
           "glTF: which scene of the file, by name or number\n[the one that the file shows first]")
      .type_name("NAME|N")
      .group(scene_group);
  add_texts(command, "--no-cast", options.no_cast,
            "Keep a mesh, material or (AFF) FILE:LINE from casting\n"
            "shadows; may be repeated")
      .type_name("NAME")
      .group(scene_group);
  add_flag(command, "--cast-all", options.cast_all,
           "Let a sky that hides a light from the whole scene cast\n"
           "its shadow")
      .group(scene_group);
  add_value(command, "--cone-sides", options.import.cone_sides, parse_cone_sides,
            "AFF: sides of cones and cylinders [64; 8 for the paper's\nnumber of triangles]")
      .type_name("N")
      .group(scene_group);
  add_value(command, "--cutout-limit", options.cutout_limit, parse_count,
            "Triangles that may be added where alpha cuts a surface\n"
            "out; the cut is coarser if it takes more [1000000]")
      .type_name("N")
      .group(scene_group);
  add_texture_path(command, options.import);
}

Expected<Transfer> parse_transfer(const std::string& text) {
  if (is_word(text, "srgb")) return Transfer::srgb;
  if (is_word(text, "display")) return Transfer::display;
  return base::fail("found {}, expected srgb or display", text);
}

Expected<bool> parse_floor(const std::string& text) {
  if (is_word(text, "auto")) return true;
  if (is_word(text, "none")) return false;
  return base::fail("found {}, expected auto or none", text);
}

Expected<bool> parse_surfaces(const std::string& text) {
  if (is_word(text, "full")) return false;
  if (is_word(text, "plain")) return true;
  return base::fail("found {}, expected full or plain", text);
}

void add_looks(CLI::App& command, SceneOptions& options) {
  add_value(command, "--transfer", options.transfer, parse_transfer,
            "srgb: colours are linear light, pictures are encoded;\n"
            "display: colours are shown unchanged, as in 1999 [display\n"
            "for AFF and NFF, srgb for the others]")
      .type_name("srgb|display")
      .group(scene_group);
  add_text(command, "--environment", options.environment,
           "Radiance picture (.hdr, equirectangular) of the scene's\n"
           "surroundings: its background, its ambient light and what\n"
           "metals mirror")
      .type_name("FILE")
      .group(scene_group);
  add_value(command, "--floor", options.floor, parse_floor,
            "auto: a file without light, which gets a sun and a soft\n"
            "sky, also gets a floor that shows the shadow, if it has\n"
            "none and there is no --environment; none: no floor [auto]")
      .type_name("auto|none")
      .group(scene_group);
  add_value(command, "--surfaces", options.plain, parse_surfaces,
            "plain: without textures, gloss and vertex colours; masks\n"
            "stay the same [full]")
      .type_name("full|plain")
      .group(scene_group);
}

void add_edits(CLI::App& command, SceneOptions& options) {
  const auto add = [&](const char* name, auto parse, const char* help) {
    const auto read = [&options, parse](const std::vector<std::string>& texts) -> Expected<void> {
      for (const std::string& text : texts) {
        if (auto parsed = parse(text, options.edits); !parsed) return parsed;
      }
      return {};
    };
    add_texts(command, name, read, help).type_name("TEXT").group(scene_group);
  };
  add(
      "--set-light",
      [](const std::string& text, stage::SceneEdits& edits) { return parse_light_edit(text, edits.lights); },
      "\"N KEY=VALUE ...\" changes light N: on=0,\nintensity=FACTOR, color=R,G,B, "
      "direction=X,Y,Z,\nmove=X,Y,Z "
      "(metres), size=WxH (metres, for soft\nshadows), diameter=DEGREES (of directional lights);\nmay be "
      "repeated");
  add("--add-light", parse_added_light,
      "\"TYPE KEY=VALUE ...\" adds a light: point, spot or\ndirectional; position=X,Y,Z, direction=X,Y,Z,\n"
      "intensity=VALUE, color=R,G,B; may be repeated");
  add("--set-material", parse_material_edit,
      "\"N KEY=VALUE ...\" changes material N: color=R,G,B,\nemissive=R,G,B, specular=R,G,B, "
      "roughness=VALUE,\n"
      "metallic=VALUE; may be repeated");
  add("--set-node", parse_node_edit,
      "\"N KEY=VALUE ...\" changes node N and all below it:\nvisible=0, casts=0; may be repeated");
}

void add_moment(CLI::App& command, SceneOptions& options) {
  add_value(command, "--time", options.time_s, parse_time, "Time of the animation to show, in seconds")
      .type_name("S")
      .group(scene_group);
  add_value(command, "--fps", options.fps, parse_positive,
            "Frames per second where the scene does not number its\nframes itself (glTF) [30]")
      .type_name("F")
      .group(scene_group);
  add_text(command, "--clip", options.clip, "Animation to play, by name or number [the first]")
      .type_name("NAME|N")
      .group(scene_group);
}

void add_camera(CLI::App& command, SceneOptions& options) {
  const auto camera =
      add_text(command, "--camera", options.camera, "Camera of the scene, by name or number [the first]")
          .type_name("NAME|N");
  const auto eye =
      add_value(command, "--eye", options.eye, parse_vector, "A camera at this place instead, in world space")
          .type_name("X,Y,Z")
          .excludes(camera);
  const auto look_at =
      add_value(command, "--look-at", options.look_at, parse_vector, "Point that this camera looks at")
          .type_name("X,Y,Z");
  const auto up =
      add_value(command, "--up", options.up, parse_vector, "Direction that is up [0,1,0]").type_name("X,Y,Z");
  eye.needs(look_at);
  look_at.needs(eye);
  up.needs(eye);
  const auto fov = add_value(command, "--fov", options.fov_deg, parse_field_of_view,
                             "Full vertical field of view in degrees [the camera's; 45 with --eye]")
                       .type_name("D");
  const auto size =
      add_value(command, "--size", options.size, parse_size,
                "Size of the picture in pixels [800x600, or 800 wide with\nthe camera's aspect]")
          .type_name("WxH");
  for (const AddedOption option : {camera, eye, look_at, up, fov, size}) option.group(camera_group);
}

}  // namespace

void add_texture_path(CLI::App& command, formats::ImportOptions& options) {
  const auto read = [&options](const std::vector<std::string>& folders) -> Expected<void> {
    std::error_code none;
    for (const std::string& folder : folders)
      if (!std::filesystem::is_directory(folder, none))
        return base::fail("found no folder {}, expected one that is there", folder);
    options.texture_paths.assign(folders.begin(), folders.end());
    return {};
  };
  add_texts(command, "--texture-path", read,
            "Folder to look in for pictures that are not beside the\nscene; may be repeated")
      .type_name("DIR")
      .group(scene_group);
}

void add_scene_options(CLI::App& command, SceneOptions& options) {
  add_files(command, options);
  add_looks(command, options);
  add_edits(command, options);
  add_moment(command, options);
  add_camera(command, options);
}

void add_content_options(CLI::App& command, SceneOptions& options) {
  add_files(command, options);
  add_edits(command, options);
  add_moment(command, options);
}

SceneOptions options_for(const std::string& file, const SceneOptions& before) {
  SceneOptions options;
  options.file = file;
  options.import = before.import;
  options.import.scene.clear();
  options.cutout_limit = before.cutout_limit;
  options.cast_all = before.cast_all;
  options.transfer = before.transfer;
  options.environment = before.environment;
  options.floor = before.floor;
  options.plain = before.plain;
  options.meter_exposure = before.meter_exposure;
  options.fps = before.fps;
  return options;
}

Expected<void> check_scene_options(const SceneOptions& options) {
  if (options.eye && *options.eye == options.look_at)
    return base::fail("--eye and --look-at are the same point");
  if (options.eye && options.up == glm::vec3(0.0f)) return base::fail("--up is 0,0,0, expected a direction");
  return {};
}

}  // namespace tenebra::viewer
