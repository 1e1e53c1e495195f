// All pictures of a material, for those who treat them alike.
#pragma once

#include <array>

#include <tenebra/material.h>

namespace tenebra::scene {

/// Of a material that may be changed, pointers that may change it.
template <class OfMaterial>
auto texture_maps(OfMaterial& m) {
  return std::array{&m.base_color_map,   &m.emissive_map,       &m.metallic_roughness_map,
                    &m.specular_map,     &m.specular_share_map, &m.exponent_map,
                    &m.transmission_map, &m.normal_map,         &m.occlusion_map};
}

}  // namespace tenebra::scene
