// Which property of a scene a JSON pointer of KHR_animation_pointer drives.
#pragma once

#include <optional>
#include <string_view>

#include "formats/gltf/model.h"

namespace tenebra::formats::gltf {

enum class PointerTable { nodes, meshes, cameras, lights, area_lights };

struct PointerTarget {
  PointerTable table = PointerTable::nodes;
  std::size_t index = 0;  ///< in the file's table
  ChannelPath path = ChannelPath::translation;
  double factor = 1;  ///< from the file's numbers to Scene's
};

/// std::nullopt: a property that is not read (of materials, say), or no such thing in the file.
std::optional<PointerTarget> read_pointer(const Asset& asset, std::string_view pointer);

}  // namespace tenebra::formats::gltf
