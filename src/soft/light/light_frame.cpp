#include "soft/light/light_frame.h"

#include <algorithm>
#include <cmath>

namespace tenebra::soft {

LightFrame light_frame(const AreaLight& light) {
  double unit = 0;
  for (const glm::dvec2& v : light.outline) unit = std::max({unit, std::abs(v.x), std::abs(v.y)});
  LightFrame frame{light.centre, unit * light.ex, unit * light.ey, light.normal, {}, 0};
  for (const glm::dvec2& v : light.outline) frame.outline.push_back(v / unit);
  for (std::size_t k = 0; k < frame.outline.size(); ++k) {
    const glm::dvec2 &a = frame.outline[k], &b = frame.outline[(k + 1) % frame.outline.size()];
    frame.area += (a.x * b.y - b.x * a.y) / 2;
  }
  return frame;
}

}  // namespace tenebra::soft
