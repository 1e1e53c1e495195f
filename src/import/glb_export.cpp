// export_glb: a Scene as one binary glTF 2.0 file.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "base/output_file.h"
#include "import/import_scene.h"

namespace tenebra {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t max_glb_bytes = 0xFFFFFFFF;  // lengths are 32 bits

Json to_json(const glm::vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

/// The binary chunk and the tables that describe it.
struct Binary {
  Json& root;
  std::string bytes;

  /// One accessor over values of `components` floats or integers; bounds on request (positions, key times).
  template <class T>
  int add(const std::vector<T>& values, int components, int component_type, bool bounds) {
    static const std::map<int, const char*> types = {{1, "SCALAR"}, {3, "VEC3"}, {4, "VEC4"}, {16, "MAT4"}};
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    const std::size_t offset = bytes.size(), size = values.size() * sizeof(T);
    bytes.resize(offset + size);
    std::memcpy(bytes.data() + offset, values.data(), size);
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    Json accessor = {{"bufferView", root["bufferViews"].size() - 1},
                     {"componentType", component_type},
                     {"count", values.size() / static_cast<std::size_t>(components)},
                     {"type", types.at(components)}};
    if (bounds) add_bounds(accessor, values, static_cast<std::size_t>(components));
    root["accessors"].push_back(std::move(accessor));
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  int add_vec3(const std::vector<glm::vec3>& values, bool bounds) {
    std::vector<float> flat;
    flat.reserve(values.size() * 3);
    for (const glm::vec3& v : values) flat.insert(flat.end(), {v.x, v.y, v.z});
    return add(flat, 3, 5126, bounds);
  }

private:
  template <class T>
  static void add_bounds(Json& accessor, const std::vector<T>& values, std::size_t components) {
    for (std::size_t c = 0; c < components; ++c) {
      T low = values[c], high = values[c];
      for (std::size_t i = c; i < values.size(); i += components)
        low = std::min(low, values[i]), high = std::max(high, values[i]);
      accessor["min"].push_back(low);
      accessor["max"].push_back(high);
    }
  }
};

struct GlbExport {
  const Scene& scene;
  double fps;
  Json root = {{"asset", {{"version", "2.0"}, {"generator", "Tenebra"}}}};
  Binary binary{root, {}};
  std::vector<int> mesh_of;     ///< mesh of the file for each of the scene; -1: no triangles
  std::map<int, int> light_of;  ///< index in its extension's table

  void write_materials() {
    for (const Material& source : scene.materials) {
      Json material = {
          {"name", source.name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {source.base_color.x, source.base_color.y, source.base_color.z, 1.0}},
            {"metallicFactor", 0}}}};
      if (source.emissive != glm::vec3(0)) write_emissive(source.emissive, material);
      if (!source.casts_shadow) material["extras"]["casts_shadow"] = false;
      root["materials"].push_back(std::move(material));
    }
  }

  void write_emissive(glm::vec3 emissive, Json& material) {
    const float strength = std::max({emissive.x, emissive.y, emissive.z, 1.0f});
    material["emissiveFactor"] = to_json(emissive / strength);
    if (strength == 1) return;
    material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
    use("KHR_materials_emissive_strength");
  }

  void use(const char* extension) {
    Json& used = root["extensionsUsed"];
    if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
  }

  void write_attributes(const Mesh& mesh, Json& attributes) {
    const bool shaped = !mesh.shapes.empty();
    attributes["POSITION"] = binary.add_vec3(shaped ? mesh.shapes[0].positions : mesh.positions, true);
    const auto& normals = shaped ? mesh.shapes[0].normals : mesh.normals;
    if (!normals.empty()) attributes["NORMAL"] = binary.add_vec3(normals, false);
    if (mesh.joints.empty()) return;
    std::vector<std::uint16_t> joints;
    std::vector<float> weights;
    for (const auto& j : mesh.joints) joints.insert(joints.end(), {j.x, j.y, j.z, j.w});
    for (const auto& w : mesh.weights) weights.insert(weights.end(), {w.x, w.y, w.z, w.w});
    attributes["JOINTS_0"] = binary.add(joints, 4, 5123, false);
    attributes["WEIGHTS_0"] = binary.add(weights, 4, 5126, false);
  }

  Json write_target(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals) {
    Json target = Json::object();
    if (!positions.empty()) target["POSITION"] = binary.add_vec3(positions, true);
    if (!normals.empty()) target["NORMAL"] = binary.add_vec3(normals, false);
    return target;
  }

  /// Displacements of the shapes after the first, against the first.
  static std::vector<glm::vec3> minus(std::vector<glm::vec3> values, const std::vector<glm::vec3>& base) {
    for (std::size_t i = 0; i < values.size() && i < base.size(); ++i) values[i] -= base[i];
    return values;
  }

  Json write_targets(const Mesh& mesh) {
    Json targets = Json::array();
    for (std::size_t s = 1; s < mesh.shapes.size(); ++s)
      targets.push_back(write_target(minus(mesh.shapes[s].positions, mesh.shapes[0].positions),
                                     minus(mesh.shapes[s].normals, mesh.shapes[0].normals)));
    if (mesh.shapes.empty())
      for (const MorphTarget& target : mesh.morph_targets)
        targets.push_back(target.positions.empty() && target.normals.empty()
                              ? write_target(std::vector<glm::vec3>(mesh.positions.size()), {})
                              : write_target(target.positions, target.normals));
    return targets;
  }

  void write_meshes() {
    for (const Mesh& mesh : scene.meshes) {
      mesh_of.push_back(-1);
      if (mesh.triangles.empty()) continue;
      std::map<std::uint32_t, std::vector<std::uint32_t>> indices;  // by material
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int c = 0; c < 3; ++c) indices[mesh.materials[i]].push_back(mesh.triangles[i][c]);
      Json attributes, written = {{"name", mesh.name.empty() ? mesh.source : mesh.name}};
      write_attributes(mesh, attributes);
      const Json targets = write_targets(mesh);
      for (const auto& [material, list] : indices) {
        Json primitive = {{"attributes", attributes},
                          {"indices", binary.add(list, 1, 5125, false)},
                          {"material", material}};
        if (!targets.empty()) primitive["targets"] = targets;
        written["primitives"].push_back(std::move(primitive));
      }
      if (mesh.shapes.empty() && !mesh.default_weights.empty()) written["weights"] = mesh.default_weights;
      if (!mesh.casts_shadow) written["extras"]["casts_shadow"] = false;
      mesh_of.back() = static_cast<int>(root["meshes"].size());
      root["meshes"].push_back(std::move(written));
    }
  }

  void write_lights() {
    static constexpr const char* names[] = {"point", "spot", "directional", "rect", "disk"};
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
      const Light& light = scene.lights[i];
      const bool area = light.type >= LightType::area_rect;
      const char* extension = area ? "EXT_lights_area" : "KHR_lights_punctual";
      use(extension);
      Json written = {{"name", light.name},
                      {"type", names[static_cast<int>(light.type)]},
                      {"color", to_json(light.color)},
                      {"intensity", light.intensity}};
      if (light.range_m) written["range"] = *light.range_m;
      if (light.type == LightType::spot)
        written["spot"] = {{"innerConeAngle", light.inner_cone_rad},
                           {"outerConeAngle", light.outer_cone_rad}};
      if (area) written["size"] = light.size_m.y;
      if (light.type == LightType::area_rect) written["rect"]["aspect"] = light.size_m.x / light.size_m.y;
      Json& table = root["extensions"][extension]["lights"];
      light_of[static_cast<int>(i)] = static_cast<int>(table.size());
      table.push_back(std::move(written));
    }
  }

  void write_cameras() {
    for (const Camera& camera : scene.cameras) {
      const double aspect = camera.aspect.value_or(1.0f);
      Json written = {{"name", camera.name}};
      if (camera.projection == Projection::perspective) {
        written["type"] = "perspective";
        written["perspective"] = {{"yfov", camera.vertical_fov_rad}, {"znear", camera.near_m}};
        if (camera.aspect) written["perspective"]["aspectRatio"] = aspect;
      } else {
        written["type"] = "orthographic";
        written["orthographic"] = {{"xmag", camera.vertical_extent_m / 2 * aspect},
                                   {"ymag", camera.vertical_extent_m / 2},
                                   {"znear", camera.near_m},
                                   {"zfar", camera.near_m + 1e4}};
      }
      root["cameras"].push_back(std::move(written));
    }
  }

  void write_skins() {
    for (const Skin& skin : scene.skins) {
      std::vector<float> numbers;
      for (const glm::mat4& m : skin.inverse_bind)
        for (int i = 0; i < 16; ++i) numbers.push_back(m[i / 4][i % 4]);
      root["skins"].push_back(
          {{"joints", skin.joints}, {"inverseBindMatrices", binary.add(numbers, 16, 5126, false)}});
    }
  }

  static void write_transform(const Node& node, Json& written) {
    if (node.matrix) {
      for (int i = 0; i < 16; ++i) written["matrix"].push_back((*node.matrix)[i / 4][i % 4]);
      return;
    }
    const glm::dvec3 scale = node.visible ? node.scale : glm::dvec3(0);  // glTF has no hidden nodes
    written["translation"] = {node.translation.x, node.translation.y, node.translation.z};
    written["rotation"] = {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
    written["scale"] = {scale.x, scale.y, scale.z};
  }

  void write_nodes() {
    Json roots = Json::array();
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
      const Node& node = scene.nodes[i];
      Json written = {{"name", node.name}};
      write_transform(node, written);
      if (node.mesh >= 0 && mesh_of[static_cast<std::size_t>(node.mesh)] >= 0) {
        written["mesh"] = mesh_of[static_cast<std::size_t>(node.mesh)];
        if (node.skin >= 0) written["skin"] = node.skin;
        if (!node.weights.empty()) written["weights"] = node.weights;
      }
      if (node.camera >= 0) written["camera"] = node.camera;
      if (node.light >= 0) {
        const bool area = scene.lights[static_cast<std::size_t>(node.light)].type >= LightType::area_rect;
        written["extensions"][area ? "EXT_lights_area" : "KHR_lights_punctual"]["light"] =
            light_of[node.light];
      }
      root["nodes"].push_back(std::move(written));
      if (node.parent >= 0)
        root["nodes"][static_cast<std::size_t>(node.parent)]["children"].push_back(i);
      else
        roots.push_back(i);
    }
    root["scene"] = 0;
    root["scenes"].push_back(roots.empty() ? Json::object() : Json{{"nodes", roots}});
  }

  void add_channel(Json& animation, int node, const char* path, const char* how,
                   const std::vector<float>& times, const std::vector<float>& values, int components) {
    const int input = binary.add(times, 1, 5126, true);
    const int output = binary.add(values, components, 5126, false);
    animation["samplers"].push_back({{"input", input}, {"interpolation", how}, {"output", output}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }

  std::vector<float> frame_times(const Clip& clip) const {
    std::vector<float> times;
    for (int i = 0; i < frame_count(clip, fps); ++i) {
      const auto time = static_cast<float>(frame_time_s(clip, i, fps));
      if (times.empty() || time > times.back()) times.push_back(time);
    }
    return times;
  }

  void bake(const Clip& clip, const Track& track, bool rotation, std::vector<float>& times,
            std::vector<float>& values) {
    times = frame_times(clip);
    std::vector<double> value(static_cast<std::size_t>(track.components));
    for (const float time : times) {
      evaluate_track(track, time, rotation, value);
      values.insert(values.end(), value.begin(), value.end());
    }
  }

  void write_channel(const Clip& clip, const Channel& channel, Json& animation) {
    static constexpr const char* paths[] = {"translation", "rotation", "scale", "weights"};
    const Track& track = clip.tracks[static_cast<std::size_t>(channel.track)];
    const Node& node = scene.nodes[static_cast<std::size_t>(channel.node)];
    if (track.times_s.empty() || node.matrix) return;
    std::vector<float> times(track.times_s.begin(), track.times_s.end()), values;
    const bool rising = std::is_sorted(times.begin(), times.end(), std::less_equal<>()) && times[0] >= 0;
    const char* how = track.interpolation == Interpolation::step           ? "STEP"
                      : track.interpolation == Interpolation::cubic_spline ? "CUBICSPLINE"
                                                                           : "LINEAR";
    if (channel.path == ChannelPath::visibility) return write_visibility(clip, channel, animation);
    if (track.interpolation == Interpolation::kochanek_bartels || !rising) {
      how = "LINEAR";
      bake(clip, track, channel.path == ChannelPath::rotation, times, values);
    } else {
      values.assign(track.values.begin(), track.values.end());
    }
    const int components = channel.path == ChannelPath::weights ? 1 : track.components;
    add_channel(animation, channel.node, paths[static_cast<int>(channel.path)], how, times, values,
                components);
  }

  /// Hidden frames have scale 0; a track of scales of the same node is baked in.
  void write_visibility(const Clip& clip, const Channel& channel, Json& animation) {
    const glm::dvec3 scale = scene.nodes[static_cast<std::size_t>(channel.node)].scale;
    const Track& track = clip.tracks[static_cast<std::size_t>(channel.track)];
    const auto is_scale = [&](const Channel& c) {
      return c.node == channel.node && c.path == ChannelPath::scale;
    };
    const auto scaled = std::find_if(clip.channels.begin(), clip.channels.end(), is_scale);
    const std::vector<float> times = frame_times(clip);
    std::vector<float> values;
    for (const float time : times) {
      double visible = 0, s[3] = {scale.x, scale.y, scale.z};
      evaluate_track(track, time, false, std::span(&visible, 1));
      if (scaled != clip.channels.end())
        evaluate_track(clip.tracks[static_cast<std::size_t>(scaled->track)], time, false, s);
      for (const double value : s) values.push_back(visible > 0.5 ? static_cast<float>(value) : 0.0f);
    }
    add_channel(animation, channel.node, "scale", "STEP", times, values, 3);
  }

  /// Weights that lead from shape to shape: shape k > 0 is target k - 1, shape 0 the base.
  void write_shapes(Json& animation) {
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
      const int mesh = scene.nodes[n].mesh;
      if (mesh < 0 || scene.meshes[static_cast<std::size_t>(mesh)].shapes.size() < 2) continue;
      const auto& shapes = scene.meshes[static_cast<std::size_t>(mesh)].shapes;
      std::vector<float> times, values;
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        const auto time = static_cast<float>(shapes[k].time_s);
        if (!times.empty() && time <= times.back()) continue;
        times.push_back(time);
        for (std::size_t t = 1; t < shapes.size(); ++t) values.push_back(t == k ? 1.0f : 0.0f);
      }
      add_channel(animation, static_cast<int>(n), "weights", "LINEAR", times, values, 1);
    }
  }

  void write_clips() {
    const auto is_hidden_by = [](const Clip& clip, const Channel& c) {
      return c.path == ChannelPath::scale &&
             std::any_of(clip.channels.begin(), clip.channels.end(), [&](const Channel& o) {
               return o.node == c.node && o.path == ChannelPath::visibility;
             });
    };
    const std::vector<Clip> shapes_alone(1);
    for (const Clip& clip : scene.clips.empty() ? shapes_alone : scene.clips) {
      Json animation = {{"name", clip.name}};
      for (const Channel& channel : clip.channels)
        if (!is_hidden_by(clip, channel)) write_channel(clip, channel, animation);
      write_shapes(animation);
      if (animation.contains("channels")) root["animations"].push_back(std::move(animation));
    }
  }

  static void add_word(std::string& out, std::uint32_t word) {
    for (int i = 0; i < 4; ++i) out += static_cast<char>(word >> (8 * i) & 0xFF);
  }

  std::string write() {
    write_materials();
    write_meshes();
    write_lights();
    write_cameras();
    write_skins();
    write_nodes();
    write_clips();
    binary.bytes.resize((binary.bytes.size() + 3) / 4 * 4, '\0');
    if (!binary.bytes.empty()) root["buffers"].push_back({{"byteLength", binary.bytes.size()}});
    std::string json = root.dump(-1, ' ', false, Json::error_handler_t::replace);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string out = "glTF";
    add_word(out, 2);
    const std::size_t chunk = binary.bytes.empty() ? 0 : 8 + binary.bytes.size();
    add_word(out, static_cast<std::uint32_t>(20 + json.size() + chunk));
    add_word(out, static_cast<std::uint32_t>(json.size()));
    out += "JSON" + json;
    if (chunk == 0) return out;
    add_word(out, static_cast<std::uint32_t>(binary.bytes.size()));
    out += std::string("BIN\0", 4) + binary.bytes;
    return out;
  }
};

}  // namespace

Expected<void> export_glb(const Scene& scene, const std::filesystem::path& path, double fps) {
  try {
    GlbExport writer{scene, fps, {{"asset", {{"version", "2.0"}, {"generator", "Tenebra"}}}}};
    const std::string bytes = writer.write();
    if (bytes.size() > max_glb_bytes)
      return fail("{}: found {} bytes to write, expected at most {} in a GLB.", path.string(), bytes.size(),
                  max_glb_bytes);
    return write_file(path, bytes);
  } catch (const std::exception& error) {
    return fail("{}: found a scene that cannot be written ({}), expected a smaller one.", path.string(),
                error.what());
  }
}

}  // namespace tenebra
