// Lights, cameras and skins of a GLB.
#include <fmt/core.h>
#include <glm/gtc/constants.hpp>

#include <tenebra/frame_geometry.h>
#include "formats/glb/writer.h"

namespace tenebra::formats {
namespace {

constexpr const char* light_names[] = {"point", "spot", "directional", "rect", "disk"};

}  // namespace

void GlbWriter::use(const char* extension) {
  GlbJson& used = root_["extensionsUsed"];
  if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
}

/// From each light to the middle of the scene where its first clip begins; at least a tenth of the scene's
/// size.
std::vector<double> GlbWriter::light_distances() const {
  const int clip = scene_.clips.empty() ? -1 : 0;
  const double time_s = scene_.clips.empty() ? 0 : scene_.clips[0].start_s;
  FrameGeometry frame;
  evaluate_frame(scene_, clip, time_s, frame);
  if (frame.triangles.empty()) return std::vector<double>(scene_.lights.size(), 1.0);
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const glm::uvec3& t : frame.triangles)
    for (int c = 0; c < 3; ++c) {
      low = glm::min(low, glm::dvec3(frame.positions[t[c]]));
      high = glm::max(high, glm::dvec3(frame.positions[t[c]]));
    }
  std::vector<double> distances(scene_.lights.size(), 0.1 * glm::length(high - low));
  for (const WorldLight& placed : evaluate_lights(scene_, clip, time_s)) {
    double& distance = distances[static_cast<std::size_t>(placed.light)];
    distance = std::max(distance, glm::length(glm::dvec3(placed.position) - 0.5 * (low + high)));
  }
  return distances;
}

void GlbWriter::write_lights() {
  std::size_t without_falloff = 0;
  std::vector<double> distances;  // found for the first light that needs them
  for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
    const Light& light = scene_.lights[i];
    const bool area = light.type >= LightType::area_rect;
    const bool steady = light.falloff == Falloff::none && light.type != LightType::directional && !area;
    const char* extension = area ? "EXT_lights_area" : "KHR_lights_punctual";
    use(extension);
    const float peak = peak_of(light.color);
    if (steady && distances.empty()) distances = light_distances();
    // Lambert's 1 / pi holds for lights with units only, here as in other programs.
    const double candela_share = steady ? glm::pi<double>() * distances[i] * distances[i] : 1.0;
    GlbJson written = {{"name", light.name},
                       {"type", light_names[static_cast<int>(light.type)]},
                       {"color", to_json(light.color / peak)},
                       {"intensity", candela_share * light.intensity * peak}};
    intensity_factor_.push_back(candela_share * peak);
    color_factor_.push_back(1.0 / peak);
    if (steady) {
      written["extras"] = {{"falloff", "none"}, {"intensity", light.intensity * peak}};
      ++without_falloff;
    }
    if (light.type == LightType::directional && light.diameter_deg > 0)
      written["extras"]["diameter_deg"] = light.diameter_deg;
    if (light.range_m) written["range"] = *light.range_m;
    if (light.type == LightType::spot)
      written["spot"] = {{"innerConeAngle", light.inner_cone_rad}, {"outerConeAngle", light.outer_cone_rad}};
    if (area) written["size"] = light.size_m.y;
    if (light.type == LightType::area_rect) written["rect"]["aspect"] = light.size_m.x / light.size_m.y;
    GlbJson& table = root_["extensions"][extension]["lights"];
    light_of_.push_back(static_cast<int>(table.size()));
    table.push_back(std::move(written));
  }
  if (without_falloff > 0)
    losses.push_back(
        fmt::format("{} lights do not fade with distance: other programs see lights that do, as bright at "
                    "the middle of the scene.",
                    without_falloff));
}

void GlbWriter::write_cameras() {
  for (const Camera& camera : scene_.cameras) {
    const double aspect = camera.aspect.value_or(1.0f);
    GlbJson written = {{"name", camera.name}};
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
    root_["cameras"].push_back(std::move(written));
  }
}

void GlbWriter::write_skins() {
  std::vector<bool> used(scene_.skins.size(), false);
  for (const Node& node : scene_.nodes)
    if (node.skin >= 0) used[static_cast<std::size_t>(node.skin)] = true;
  for (std::size_t s = 0; s < scene_.skins.size(); ++s) {
    skin_of_.push_back(-1);
    const Skin& skin = scene_.skins[s];
    const bool whole = std::none_of(skin.joints.begin(), skin.joints.end(), [](int j) { return j < 0; });
    if (!used[s] || skin.joints.empty() || !whole) continue;
    std::vector<float> numbers;
    for (const glm::mat4& m : skin.inverse_bind)
      for (int i = 0; i < 16; ++i) numbers.push_back(m[i / 4][i % 4]);
    const int matrices = binary_.add_floats(numbers, 16, false);
    GlbJson written = {{"joints", skin.joints}, {"inverseBindMatrices", matrices}};
    skin_of_.back() = static_cast<int>(root_["skins"].size());
    root_["skins"].push_back(std::move(written));
  }
}

}  // namespace tenebra::formats
