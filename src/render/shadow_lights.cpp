#include "render/shadow_lights.h"

#include <cmath>

namespace tenebra::render {

ShadowLight shadow_light(const Light& light, const WorldLight& placed) {
  ShadowLight result;
  result.position = placed.position;
  result.range_m = light.range_m.value_or(0.0f);
  result.spot_axis = placed.direction;
  switch (light.type) {
    case LightType::point:
      break;
    case LightType::spot:
      result.spot_cos_outer = std::cos(light.outer_cone_rad);
      break;
    case LightType::directional:
      result.directional = true;
      result.to_light = -placed.direction;
      break;
    case LightType::area_rect:
    case LightType::area_disk:
      result.spot_cos_outer = 0;
      break;
  }
  return result;
}

}  // namespace tenebra::render
