#include "shade/surfaces.h"

namespace tenebra::shade {

SurfaceTable::SurfaceTable(std::span<const Material> materials) {
  if (!materials.empty()) surfaces_.clear();
  for (const Material& m : materials) {
    surfaces_.push_back({.base = m.base_color,
                         .ambient = m.ambient.x < 0 ? m.base_color : m.ambient,
                         .emissive = m.emissive});
  }
}

}  // namespace tenebra::shade
