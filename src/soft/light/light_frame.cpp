#include "soft/light/light_frame.h"

#include <algorithm>
#include <cmath>

namespace tenebra::soft {

LightFrame light_frame(const AreaLight& light) {
  double unit = 0;
  for (const glm::dvec2& v : light.polygon) unit = std::max({unit, std::abs(v.x), std::abs(v.y)});
  LightFrame frame{
      light.centre, unit * light.ex, unit * light.ey, light.normal, {}, 0, light.at_infinity ? 0.0 : 1.0};
  for (const glm::dvec2& v : light.polygon) frame.polygon.push_back(v / unit);
  for (std::size_t k = 0; k < frame.polygon.size(); ++k) {
    const glm::dvec2 &a = frame.polygon[k], &b = frame.polygon[(k + 1) % frame.polygon.size()];
    frame.area += (a.x * b.y - b.x * a.y) / 2;
  }
  return frame;
}

}  // namespace tenebra::soft
