#include "stage/left_out.h"

#include <fmt/core.h>

#include <algorithm>

#include <tenebra/frame_geometry.h>
#include "stage/light_cover.h"

namespace tenebra::stage {
namespace {

std::vector<std::size_t> instances_per_mesh(const Scene& scene) {
  std::vector<std::size_t> counts(scene.meshes.size(), 0);
  for (const Node& node : scene.nodes) {
    if (node.mesh >= 0) ++counts[static_cast<std::size_t>(node.mesh)];
  }
  return counts;
}

/// Marks what is called `name`. Returns how many triangles that takes out, or -1 if nothing is called so.
std::ptrdiff_t leave_out(Scene& scene, const std::string& name, const std::vector<std::size_t>& instances) {
  bool found = false;
  std::vector<bool> named(scene.materials.size(), false);
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (scene.materials[m].name != name) continue;
    scene.materials[m].casts_shadow = false;
    named[m] = found = true;
  }
  std::size_t triangles = 0;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    Mesh& mesh = scene.meshes[m];
    const bool whole = mesh.name == name || mesh.source == name;
    if (whole) mesh.casts_shadow = false;
    found = found || whole;
    const auto hit = std::count_if(mesh.materials.begin(), mesh.materials.end(),
                                   [&](std::uint32_t material) { return whole || named[material]; });
    triangles += static_cast<std::size_t>(hit) * instances[m];
  }
  return found ? static_cast<std::ptrdiff_t>(triangles) : -1;
}

/// As --no-cast takes it where the file has a name for it.
std::string name_of_mesh(const Scene& scene, int node_index) {
  const Node& node = scene.nodes[static_cast<std::size_t>(node_index)];
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
  if (!mesh.source.empty()) return mesh.source;
  if (!mesh.name.empty()) return mesh.name;
  return fmt::format("The mesh of node {}{}", node_index, node.name.empty() ? "" : " (" + node.name + ")");
}

}  // namespace

bool leave_out_casters(Scene& scene, const std::vector<std::string>& names, std::string& unmatched) {
  const std::vector<std::size_t> instances = instances_per_mesh(scene);
  for (const std::string& name : names) {
    const std::ptrdiff_t triangles = name.empty() ? -1 : leave_out(scene, name, instances);
    if (triangles < 0) {
      unmatched = name;
      return false;
    }
    scene.warnings.push_back(fmt::format("{} casts no shadow: {} triangles left out.", name, triangles));
  }
  return true;
}

void leave_out_covers(Scene& scene) {
  const int clip = scene.clips.empty() ? -1 : 0;
  const double time_s = scene.clips.empty() ? 0.0 : scene.clips.front().start_s;
  FrameGeometry frame;
  evaluate_frame(scene, clip, time_s, frame);
  const std::vector<WorldLight> lights = evaluate_lights(scene, clip, time_s);
  for (const LightCover& cover : find_light_covers(scene, frame, lights)) {
    const int number = lights[cover.light].light;
    Light& light = scene.lights[static_cast<std::size_t>(number)];
    const std::string what = name_of_mesh(scene, cover.node);
    const std::string whom = light.name.empty() ? fmt::format("light {}", number)
                                                : fmt::format("light {} ({})", number, light.name);
    if (!cover.is_sky) {
      scene.warnings.push_back(fmt::format(
          "{} hides {} from everything else: nothing else is lit by it, unless --no-cast leaves it out.",
          what, whom));
      continue;
    }
    light.left_out_nodes.push_back(cover.node);
    scene.warnings.push_back(
        fmt::format("{} hides {} from everything else, like a sky: it casts no shadow from that light (with "
                    "--cast-all it does).",
                    what, whom));
  }
}

}  // namespace tenebra::stage
