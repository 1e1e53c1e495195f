// Cameras, lights and surroundings of a glTF file.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/gltf/model.h"

namespace tenebra::formats::gltf {
namespace {

glm::vec3 vec3_or(const std::vector<double>& numbers, glm::vec3 otherwise) {
  return numbers.size() < 3 ? otherwise : glm::vec3(numbers[0], numbers[1], numbers[2]);
}

/// `value` if it is right, else `otherwise`, with a sentence.
double right_or(bool right, double value, double otherwise, const std::string& place, const char* expected,
                std::vector<std::string>& warnings) {
  if (right) return value;
  warnings.push_back(fmt::format("{}: found {}, expected {}; made {}.", place, value, expected, otherwise));
  return otherwise;
}

double at_least_zero(double value, const std::string& place, std::vector<std::string>& warnings) {
  return right_or(value >= 0, value, 0, place, "0 or more", warnings);
}

Light read_area_light(const Value& value, const std::string& place, std::vector<std::string>& warnings) {
  Light light;
  const std::string type = member(value, "type")->Get<std::string>();
  if (type != "rect" && type != "disk") refuse("{}.type: found '{}', expected rect or disk", place, type);
  light.type = type == "rect" ? LightType::area_rect : LightType::area_disk;
  if (const Value* name = member(value, "name")) light.name = name->Get<std::string>();
  if (const Value* color = member(value, "color"))
    light.color = {color->Get(0).GetNumberAsDouble(), color->Get(1).GetNumberAsDouble(),
                   color->Get(2).GetNumberAsDouble()};
  light.intensity =
      static_cast<float>(at_least_zero(number_or(value, "intensity", 1), place + ".intensity", warnings));
  const double size = at_least_zero(number_or(value, "size", 1), place + ".size", warnings);
  const Value* rect = member(value, "rect");
  const double aspect =
      rect ? at_least_zero(number_or(*rect, "aspect", 1), place + ".rect.aspect", warnings) : 1;
  light.size_m = {size * (type == "rect" ? aspect : 1), size};
  return light;
}

/// Equal angles are a cone with a sharp edge.
void read_spot(const tinygltf::SpotLight& spot, const std::string& place, Light& light,
               std::vector<std::string>& warnings) {
  const double outer = std::clamp(spot.outerConeAngle, 0.0, std::numbers::pi / 2);
  const double inner = std::clamp(spot.innerConeAngle, 0.0, outer);
  if (inner != spot.innerConeAngle || std::abs(outer - spot.outerConeAngle) > 1e-6)
    warnings.push_back(fmt::format(
        "{}.spot: found cone angles {} and {}, expected 0 <= inner <= outer <= pi/2; made {} and {}.", place,
        spot.innerConeAngle, spot.outerConeAngle, inner, outer));
  light.type = LightType::spot;
  light.inner_cone_rad = static_cast<float>(inner);
  light.outer_cone_rad = static_cast<float>(outer);
}

void read_sun(const tinygltf::Light& source, const std::string& place, Light& light,
              std::vector<std::string>& warnings) {
  light.type = LightType::directional;
  const double diameter = number_or(source.extras, "diameter_deg", 0);
  light.diameter_deg =
      static_cast<float>(right_or(diameter >= 0 && diameter <= 90, diameter, 0,
                                  place + ".extras.diameter_deg", "0 to 90 degrees", warnings));
}

Light read_punctual_light(const tinygltf::Light& source, const std::string& place,
                          std::vector<std::string>& warnings) {
  Light light;
  light.name = source.name;
  light.color = vec3_or(source.color, glm::vec3(1));
  light.intensity = static_cast<float>(at_least_zero(source.intensity, place + ".intensity", warnings));
  if (at_least_zero(source.range, place + ".range", warnings) > 0 && source.type != "directional")
    light.range_m = static_cast<float>(source.range);
  if (const Value* falloff = member(source.extras, "falloff");
      falloff && falloff->Get<std::string>() == "none") {
    light.falloff = Falloff::none;  // written by export_glb, whose candela are for other programs
    light.intensity = static_cast<float>(number_or(source.extras, "intensity", source.intensity));
  }
  if (source.type == "spot")
    read_spot(source.spot, place, light, warnings);
  else if (source.type == "directional")
    read_sun(source, place, light, warnings);
  else if (source.type != "point") {
    warnings.push_back(fmt::format("{}.type: found '{}', expected point, spot or directional; it stays dark.",
                                   place, source.type.substr(0, 40)));
    light.intensity = 0;
  }
  return light;
}

void read_perspective(const tinygltf::PerspectiveCamera& source, const std::string& place, Camera& camera,
                      std::vector<std::string>& warnings) {
  constexpr double widest = 3.1, usual = 0.8;
  double yfov = right_or(source.yfov > 0, source.yfov, usual, place + ".yfov", "more than 0", warnings);
  yfov = right_or(yfov < std::numbers::pi, yfov, widest, place + ".yfov", "less than pi", warnings);
  camera.vertical_fov_rad = static_cast<float>(yfov);
  camera.near_m = static_cast<float>(
      right_or(source.znear > 0, source.znear, camera.near_m, place + ".znear", "more than 0", warnings));
  if (source.zfar != 0 && source.zfar <= source.znear)
    warnings.push_back(fmt::format("{}.zfar: found {}, expected more than znear {}; there is no far plane.",
                                   place, source.zfar, source.znear));
  if (source.aspectRatio > 0) camera.aspect = static_cast<float>(source.aspectRatio);
}

void read_orthographic(const tinygltf::OrthographicCamera& source, const std::string& place, Camera& camera,
                       std::vector<std::string>& warnings) {
  camera.projection = Projection::orthographic;
  camera.near_m = static_cast<float>(at_least_zero(source.znear, place + ".znear", warnings));
  if (source.zfar <= source.znear)
    warnings.push_back(fmt::format("{}.zfar: found {}, expected more than znear {}; there is no far plane.",
                                   place, source.zfar, source.znear));
  if (source.xmag == 0 || source.ymag == 0)
    return warnings.push_back(fmt::format("{}: found xmag {} and ymag {}, expected both not zero; made 1.",
                                          place, source.xmag, source.ymag));
  camera.vertical_extent_m = static_cast<float>(2 * std::abs(source.ymag));
  camera.aspect = static_cast<float>(std::abs(source.xmag / source.ymag));
}

}  // namespace

void build_cameras(Asset& asset) {
  for (std::size_t i = 0; i < asset.model.cameras.size(); ++i) {
    const auto& source = asset.model.cameras[i];
    const std::string place = fmt::format("cameras[{}]", i);
    Camera camera;
    camera.name = source.name;
    if (source.type == "perspective")
      read_perspective(source.perspective, place + ".perspective", camera, asset.scene.warnings);
    else if (source.type == "orthographic")
      read_orthographic(source.orthographic, place + ".orthographic", camera, asset.scene.warnings);
    else
      refuse("{}.type: found '{}', expected perspective or orthographic", place, source.type);
    asset.scene.cameras.push_back(std::move(camera));
  }
}

// Punctual lights first, then area lights: build_nodes counts on it.
void build_lights(Asset& asset) {
  for (std::size_t i = 0; i < asset.model.lights.size(); ++i)
    asset.scene.lights.push_back(read_punctual_light(
        asset.model.lights[i], fmt::format("extensions.KHR_lights_punctual.lights[{}]", i),
        asset.scene.warnings));
  const auto area = asset.model.extensions.find("EXT_lights_area");
  const Value* lights = area == asset.model.extensions.end() ? nullptr : member(area->second, "lights");
  for (std::size_t i = 0; lights && i < lights->ArrayLen(); ++i)
    asset.scene.lights.push_back(read_area_light(
        lights->Get(i), fmt::format("extensions.EXT_lights_area.lights[{}]", i), asset.scene.warnings));
}

void build_surroundings(Asset& asset) {
  const Model& model = asset.model;
  if (model.scenes.empty()) return;
  const Value& extras = model.scenes[static_cast<std::size_t>(std::max(model.defaultScene, 0))].extras;
  read_color(extras, "ambient_light", asset.scene.ambient_light);
  read_color(extras, "background", asset.scene.background);
  if (says(extras, "transfer", "display")) asset.scene.transfer = Transfer::display;
}

}  // namespace tenebra::formats::gltf
