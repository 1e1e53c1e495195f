// Ambient occlusion of triangles from bytes, in all ways of our own: the same bits at every vector level, and
// an openness of 0 to 1.
#include <tenebra/ambient_occlusion.h>
#include "fuzz/soup_bytes.h"

namespace {

using namespace tenebra;

std::vector<float> openness(const Scene& scene, const FrameGeometry& geometry, const VisiblePoints& points,
                            const AoConfig& config) {
  const std::vector<glm::vec3> normals(points.positions.size(), glm::vec3(0, 1, 0));
  std::vector<float> out;
  if (!AmbientOcclusion().compute(scene, geometry, points, normals, config, out)) return {};
  for (const float value : out)
    if (!(value >= 0 && value <= 1)) fuzz::found("an openness of " + std::to_string(value));
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::InputBytes bytes(data, size);
  const int how = bytes.byte();
  const fuzz::SoupCase c = fuzz::soup_case(bytes, 24);
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  mesh.positions = c.soup.positions;
  mesh.triangles = c.soup.triangles;
  mesh.materials.assign(mesh.triangles.size(), 0);
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.resize(1 + static_cast<std::size_t>(how & 1));  // as it is, and once more beside itself
  for (Node& node : scene.nodes) node.mesh = 0;
  scene.nodes.back().translation = how & 1 ? glm::dvec3(bytes.vector(c.unit)) : glm::dvec3(0);
  FrameGeometry geometry;
  evaluate_frame(scene, -1, 0, geometry);
  if (geometry.triangles.size() < c.soup.triangles.size()) return 0;  // some were not finite
  AoConfig config;
  config.mode = (how & 2) != 0 ? AoMode::adaptive : AoMode::field;
  config.rays = 4;
  config.positions = config.directions = 64;
  config.bits = (how & 4) != 0 ? 1 : 8;
  config.layout = (how & 8) != 0 ? FieldLayout::chords : FieldLayout::positions_directions;
  config.distance_m = static_cast<double>(c.unit) * (1 + bytes.byte());
  config.simd = SimdLevel::scalar;
  const std::vector<float> first = openness(scene, geometry, c.points, config);
  for (const SimdLevel level : {SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    config.simd = level;
    if (openness(scene, geometry, c.points, config) != first)
      fuzz::found("other bits at " + std::string(simd_level_name(level)));
  }
  return 0;
}
