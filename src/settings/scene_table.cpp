// What is looked at: file, light and materials, moment, camera.
#include "base/fail.h"
#include "settings/edit_texts.h"
#include "settings/rows.h"
#include "settings/tables.h"

namespace tenebra::settings {
namespace {

using SceneRow = Rows<SceneSettings>;
using SceneRows = std::vector<Setting<SceneSettings>>;

constexpr std::array transfer_choices{Choice<Transfer>{"srgb", Transfer::srgb},
                                      Choice<Transfer>{"display", Transfer::display}};
constexpr std::array floor_choices{Choice<bool>{"auto", true}, Choice<bool>{"none", false}};
constexpr std::array surface_choices{Choice<bool>{"full", false}, Choice<bool>{"plain", true}};
constexpr std::array up_choices{Choice<UpAxis>{"z", UpAxis::z}, Choice<UpAxis>{"y", UpAxis::y}};
constexpr std::array unit_choices{Choice<double>{"m", 1}, Choice<double>{"cm", 0.01},
                                  Choice<double>{"mm", 0.001}, Choice<double>{"ft", 0.3048},
                                  Choice<double>{"in", 0.0254}};
constexpr double above_0 = 1e-300, any_number = 1e300;

Setting<SceneSettings> no_cast() {
  return SceneRow::own(
      {.name = "no-cast",
       .value = "NAME",
       .help = "Keep a mesh, material or (AFF) FILE:LINE from casting shadows; may be repeated",
       .group = Group::scene,
       .several = true},
      [](SceneSettings& scene, const std::string& text) -> Expected<void> {
        scene.no_cast.push_back(text);
        return {};
      },
      [](const SceneSettings& scene) { return scene.no_cast; });
}

/// auto, none or X,Y,Z.
Setting<SceneSettings> offset() {
  using formats::OffsetChoice;
  const auto read = [](SceneSettings& scene, const std::string& text) -> Expected<void> {
    formats::Placement& placement = scene.import.placement;
    const auto place = parse_place(text);
    placement.offset = is_word(text, "auto")   ? OffsetChoice::automatic
                       : is_word(text, "none") ? OffsetChoice::none
                                               : OffsetChoice::given;
    if (placement.offset != OffsetChoice::given) return {};
    if (!place) return base::fail("found {}, expected auto, none or three numbers X,Y,Z", text);
    placement.given_offset = *place;
    return {};
  };
  const auto texts = [](const SceneSettings& scene) -> std::vector<std::string> {
    const formats::Placement& placement = scene.import.placement;
    if (placement.offset == OffsetChoice::given) return {place_text(placement.given_offset)};
    return {placement.offset == OffsetChoice::none ? "none" : "auto"};
  };
  return SceneRow::own(
      {.name = "offset",
       .value = "auto|none|X,Y,Z",
       .help = "What is subtracted from the file's coordinates, in double, before they become floats; "
               "auto: whole numbers near the middle of a scene that is far from the origin for its size "
               "(but of AFF), else nothing",
       .group = Group::scene},
      read, texts);
}

Setting<SceneSettings> texture_path() {
  const auto read = [](SceneSettings& scene, const std::string& text) -> Expected<void> {
    std::error_code none;
    if (!std::filesystem::is_directory(text, none))
      return base::fail("found no folder {}, expected one that is there", text);
    scene.import.texture_paths.emplace_back(text);
    return {};
  };
  const auto texts = [](const SceneSettings& scene) {
    std::vector<std::string> folders;
    for (const auto& folder : scene.import.texture_paths) folders.push_back(folder.string());
    return folders;
  };
  return SceneRow::own(
      {.name = "texture-path",
       .value = "DIR",
       .help = "Folder to look in for pictures that are not beside the scene; may be repeated",
       .group = Group::scene,
       .affects = Affects::files,
       .several = true},
      read, texts);
}

Setting<SceneSettings> file_root() {
  const auto read = [](SceneSettings& scene, const std::string& text) -> Expected<void> {
    std::error_code none;
    if (!std::filesystem::is_directory(text, none))
      return base::fail("found no folder {}, expected one that is there", text);
    scene.import.root = text;
    return {};
  };
  const auto texts = [](const SceneSettings& scene) {
    const std::string folder = scene.import.root.string();
    return folder.empty() ? std::vector<std::string>() : std::vector{folder};
  };
  return SceneRow::own({.name = "file-root",
                        .value = "DIR",
                        .help = "Folder anywhere in which the files that a scene names may lie, by ../ too",
                        .standard = "the scene's folder",
                        .group = Group::scene,
                        .affects = Affects::files},
                       read, texts);
}

/// --set-light and the like: texts are those of edit_options.
Setting<SceneSettings> edit(About about, Expected<void> (*parse)(const std::string&, stage::SceneEdits&)) {
  about.value = "TEXT";
  about.group = Group::scene;
  about.several = true;
  const std::string option = fmt::format("--{}", about.name);
  const auto read = [parse](SceneSettings& scene, const std::string& text) {
    return parse(text, scene.edits);
  };
  const auto texts = [option](const SceneSettings& scene) {
    std::vector<std::string> values;
    for (const EditOption& edit : edit_options(scene.edits))
      if (edit.name == option) values.push_back(edit.value);
    return values;
  };
  return SceneRow::own(std::move(about), read, texts);
}

/// Of the camera that --eye makes.
Setting<SceneSettings> look_at() {
  Setting<SceneSettings> row = SceneRow::value(
      {.name = "look-at",
       .value = "X,Y,Z",
       .help = "Point that this camera looks at",
       .group = Group::camera,
       .needs = "eye"},
      [](auto& scene) -> auto& { return scene.look_at; }, parse_place, place_text);
  row.texts = [](const SceneSettings& scene) {
    return scene.eye ? std::vector<std::string>{place_text(scene.look_at)} : std::vector<std::string>();
  };
  row.same = [texts = row.texts](const SceneSettings& a, const SceneSettings& b) {
    return texts(a) == texts(b);
  };
  return row;
}

void add_files(SceneRows& rows) {
  rows.push_back(SceneRow::text(
      {.name = "scene",
       .value = "NAME|N",
       .help = "glTF: which scene of the file, by name or number",
       .standard = "the one that the file shows first",
       .group = Group::scene},
      [](auto& scene) -> auto& { return scene.import.scene; }));
  rows.push_back(SceneRow::words(
      {.name = "up-axis",
       .help = "The file's axis that points up",
       .standard = "what the format says, else y",
       .group = Group::scene},
      [](auto& scene) -> auto& { return scene.import.placement.up; }, up_choices));
  rows.push_back(SceneRow::words(
      {.name = "unit",
       .help = "The unit of the file's coordinates",
       .standard = "what the format says, else m",
       .group = Group::scene},
      [](auto& scene) -> auto& { return scene.import.placement.metres_per_unit; }, unit_choices));
  rows.push_back(offset());
  rows.push_back(no_cast());
  rows.push_back(SceneRow::flag(
      {.name = "cast-all",
       .help = "Let a sky that hides a light from the whole scene cast its shadow",
       .group = Group::scene},
      [](auto& scene) -> auto& { return scene.cast_all; }));
  rows.push_back(SceneRow::number(
      {.name = "cone-sides",
       .value = "N",
       .help = "AFF: sides of cones and cylinders; 8 for the paper's number of triangles",
       .audience = Audience::paper,
       .range = {3, 4096},
       .expected = "3 to 4096"},
      [](auto& scene) -> auto& { return scene.import.cone_sides; }));
  rows.push_back(SceneRow::number(
      {.name = "cutout-limit",
       .value = "N",
       .help =
           "Triangles that may be added where alpha cuts a surface out; the cut is coarser if it takes more",
       .group = Group::scene,
       .range = {0, 1e6},
       .expected = "a whole number from 0 to 1000000"},
      [](auto& scene) -> auto& { return scene.cutout_limit; }));
  rows.push_back(texture_path());
  rows.push_back(file_root());
}

void add_looks(SceneRows& rows) {
  rows.push_back(SceneRow::words(
      {.name = "transfer",
       .help = "srgb: colours are linear light, pictures are encoded; display: colours are shown unchanged, "
               "as in 1999",
       .standard = "display for AFF and NFF, srgb for the others",
       .group = Group::scene},
      [](auto& scene) -> auto& { return scene.transfer; }, transfer_choices));
  rows.push_back(SceneRow::text(
      {.name = "environment",
       .value = "FILE",
       .help = "Radiance or OpenEXR picture (.hdr, .exr; equirectangular) of the scene's surroundings: its "
               "background, its "
               "ambient light and what metals mirror"},
      [](auto& scene) -> auto& { return scene.environment; }));
  rows.push_back(SceneRow::words(
      {.name = "sky",
       .help =
           "Light that is added. sun: a sun and a soft sky; soft: the sky alone; auto: sun where nothing "
           "gives light (file, --add-light, --emissive-lights, --environment), soft where lights with units "
           "leave the rest black",
       .group = Group::scene},
      [](auto& scene) -> auto& { return scene.sky; }, sky_choices));
  rows.push_back(SceneRow::words(
      {.name = "floor",
       .help =
           "auto: a file that gets a sun also gets a floor that shows the shadow, if it has none and there "
           "is no --environment; none: no floor",
       .group = Group::scene},
      [](auto& scene) -> auto& { return scene.floor; }, floor_choices));
  rows.push_back(SceneRow::words(
      {.name = "surfaces",
       .help = "plain: without textures, gloss and vertex colours; masks stay the same",
       .group = Group::scene},
      [](auto& scene) -> auto& { return scene.plain; }, surface_choices));
}

void add_edits(SceneRows& rows) {
  rows.push_back(edit({.name = "set-light",
                       .help = "\"N KEY=VALUE ...\" changes light N: on=0, intensity=FACTOR, color=R,G,B, "
                               "direction=X,Y,Z, move=X,Y,Z (metres), size=WxH (metres, for soft shadows), "
                               "diameter=DEGREES (of directional lights); may be repeated"},
                      [](const std::string& text, stage::SceneEdits& edits) {
                        return parse_light_edit(text, edits.lights);
                      }));
  rows.push_back(
      edit({.name = "add-light",
            .help = "\"TYPE KEY=VALUE ...\" adds a light: point, spot or directional; position=X,Y,Z, "
                    "direction=X,Y,Z, intensity=VALUE (candela, lux where the file's lights have units), "
                    "color=R,G,B; may be repeated"},
           parse_added_light));
  rows.push_back(edit({.name = "set-material",
                       .help = "\"N KEY=VALUE ...\" changes material N: color=R,G,B, emissive=R,G,B, "
                               "specular=R,G,B, roughness=VALUE, metallic=VALUE; may be repeated"},
                      parse_material_edit));
  rows.push_back(edit(
      {.name = "set-node",
       .help = "\"N KEY=VALUE ...\" changes node N and all below it: visible=0, casts=0; may be repeated"},
      parse_node_edit));
}

void add_moment(SceneRows& rows) {
  rows.push_back(SceneRow::value(
      {.name = "time",
       .value = "S",
       .help = "Time of the animation to show, in seconds",
       .group = Group::scene},
      [](auto& scene) -> auto& { return scene.time_s; }, parse_time,
      [](double time_s) { return fmt::format("{}", time_s); }));
  rows.push_back(SceneRow::number(
      {.name = "fps",
       .value = "F",
       .help = "Frames per second where the scene does not number its frames itself (glTF)",
       .group = Group::scene,
       .range = {above_0, any_number},
       .expected = "a number above 0"},
      [](auto& scene) -> auto& { return scene.fps; }));
  rows.push_back(SceneRow::text(
      {.name = "clip",
       .value = "NAME|N",
       .help = "Animation to play, by name or number",
       .standard = "the first",
       .group = Group::scene},
      [](auto& scene) -> auto& { return scene.clip; }));
}

void add_camera(SceneRows& rows) {
  rows.push_back(SceneRow::text(
      {.name = "camera",
       .value = "NAME|N",
       .help = "Camera of the scene, by name or number",
       .standard = "the first"},
      [](auto& scene) -> auto& { return scene.camera; }));
  rows.push_back(SceneRow::value(
      {.name = "eye",
       .value = "X,Y,Z",
       .help = "A camera at this place instead, in the coordinates of the file",
       .group = Group::camera,
       .needs = "look-at",
       .excludes = "camera"},
      [](auto& scene) -> auto& { return scene.eye; }, parse_place, place_text));
  rows.push_back(look_at());
  rows.push_back(SceneRow::value(
      {.name = "up",
       .value = "X,Y,Z",
       .help = "Direction that is up",
       .standard = "the file's up axis",
       .group = Group::camera,
       .needs = "eye"},
      [](auto& scene) -> auto& { return scene.up; }, parse_vector, vector_text));
  rows.push_back(SceneRow::value(
      {.name = "fov",
       .value = "D",
       .help = "Full vertical field of view in degrees",
       .standard = "the camera's; 45 with --eye",
       .group = Group::camera},
      [](auto& scene) -> auto& { return scene.fov_deg; }, parse_field_of_view,
      [](double degrees) { return fmt::format("{}", degrees); }));
  rows.push_back(SceneRow::value(
      {.name = "size",
       .value = "WxH",
       .help = "Size of the picture in pixels",
       .standard = "800x600, or 800 wide with the camera's aspect"},
      [](auto& scene) -> auto& { return scene.size; }, parse_size,
      [](Size size) { return fmt::format("{}x{}", size.width, size.height); }));
}

SceneRows scene_rows() {
  SceneRows rows;
  add_camera(rows);
  add_files(rows);
  add_looks(rows);
  add_edits(rows);
  add_moment(rows);
  return rows;
}

}  // namespace

std::span<const Setting<SceneSettings>> scene_table() {
  static const SceneRows rows = scene_rows();
  return rows;
}

}  // namespace tenebra::settings
