// The JSON pointers of KHR_animation_pointer that have a place in Tenebra's scene.
#include "formats/gltf/pointer.h"

#include <charconv>
#include <cmath>

namespace tenebra::formats::gltf {
namespace {

struct Pattern {
  const char* head;  ///< before the index
  const char* tail;  ///< after it
  PointerTable table;
  ChannelPath path;
};

constexpr const char* punctual = "/extensions/KHR_lights_punctual/lights/";
constexpr const char* area = "/extensions/EXT_lights_area/lights/";

constexpr Pattern patterns[] = {
    {"/nodes/", "/translation", PointerTable::nodes, ChannelPath::translation},
    {"/nodes/", "/rotation", PointerTable::nodes, ChannelPath::rotation},
    {"/nodes/", "/scale", PointerTable::nodes, ChannelPath::scale},
    {"/nodes/", "/weights", PointerTable::nodes, ChannelPath::weights},
    {"/nodes/", "/extensions/KHR_node_visibility/visible", PointerTable::nodes, ChannelPath::visibility},
    {"/meshes/", "/weights", PointerTable::meshes, ChannelPath::weights},
    {"/cameras/", "/perspective/yfov", PointerTable::cameras, ChannelPath::camera_fov},
    {"/cameras/", "/perspective/znear", PointerTable::cameras, ChannelPath::camera_near},
    {"/cameras/", "/orthographic/ymag", PointerTable::cameras, ChannelPath::camera_extent},
    {"/cameras/", "/orthographic/znear", PointerTable::cameras, ChannelPath::camera_near},
    {punctual, "/color", PointerTable::lights, ChannelPath::light_color},
    {punctual, "/intensity", PointerTable::lights, ChannelPath::light_intensity},
    {punctual, "/range", PointerTable::lights, ChannelPath::light_range},
    {punctual, "/spot/innerConeAngle", PointerTable::lights, ChannelPath::light_inner_cone},
    {punctual, "/spot/outerConeAngle", PointerTable::lights, ChannelPath::light_outer_cone},
    {area, "/color", PointerTable::area_lights, ChannelPath::light_color},
    {area, "/intensity", PointerTable::area_lights, ChannelPath::light_intensity},
    {area, "/size", PointerTable::area_lights, ChannelPath::light_size},
};

std::size_t table_size(const Asset& asset, PointerTable table) {
  switch (table) {
    case PointerTable::nodes:
      return asset.model.nodes.size();
    case PointerTable::meshes:
      return asset.model.meshes.size();
    case PointerTable::cameras:
      return asset.model.cameras.size();
    case PointerTable::lights:
      return asset.model.lights.size();
    default:
      return asset.scene.lights.size() - asset.model.lights.size();
  }
}

/// The factor from the file's numbers to Scene's.
double factor_of(const Asset& asset, const PointerTarget& target) {
  if (target.path == ChannelPath::camera_extent) return 2;  // ymag is half the height
  if (target.table != PointerTable::lights || target.path != ChannelPath::light_intensity) return 1;
  // Lights without falloff have candela for other programs alone (read_punctual_light).
  const double stored = asset.model.lights[target.index].intensity;
  const Light& light = asset.scene.lights[target.index];
  return light.falloff == Falloff::none && stored > 0 ? light.intensity / stored : 1;
}

}  // namespace

std::optional<PointerTarget> read_pointer(const Asset& asset, std::string_view pointer) {
  for (const Pattern& pattern : patterns) {
    const std::string_view head = pattern.head, tail = pattern.tail;
    if (pointer.size() <= head.size() + tail.size()) continue;
    if (!pointer.starts_with(head) || !pointer.ends_with(tail)) continue;
    const char* first = pointer.data() + head.size();
    const char* last = pointer.data() + pointer.size() - tail.size();
    PointerTarget target{pattern.table, 0, pattern.path};
    const auto [end, error] = std::from_chars(first, last, target.index);
    if (error != std::errc() || end != last || target.index >= table_size(asset, target.table)) continue;
    target.factor = factor_of(asset, target);
    return target;
  }
  return std::nullopt;
}

}  // namespace tenebra::formats::gltf
