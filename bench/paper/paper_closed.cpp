// Section 3.6 of Olsson and Assarsson 2011 on what it is said of: closed meshes.
#include "bench/ao/ao_objects.h"
#include "bench/paper/paper_hard.h"

namespace tenebra::bench {
namespace {

/// A box of 12 triangles, fronts outwards.
Object slab(glm::vec3 low, glm::vec3 high) {
  Object box;
  box.name = "slab";
  for (unsigned i = 0; i < 8; ++i)
    box.positions.emplace_back((i & 1u) != 0 ? high.x : low.x, (i & 2u) != 0 ? high.y : low.y,
                               (i & 4u) != 0 ? high.z : low.z);
  for (const glm::uvec4& q : {glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6), glm::uvec4(0, 1, 5, 4),
                              glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5)}) {
    box.triangles.emplace_back(q.x, q.y, q.z);
    box.triangles.emplace_back(q.x, q.z, q.w);
  }
  return box;
}

/// The knot over the slab; the camera and the light stand above both.
Scene closed_scene(glm::vec3 light_place) {
  Scene scene;
  scene.materials.emplace_back();
  scene.meshes = {mesh_of(make_knot(128, 16)), mesh_of(slab({-6, -6, -3}, {6, 6, -2}))};
  scene.lights.emplace_back();
  scene.cameras.emplace_back();
  scene.nodes.resize(4);
  scene.nodes[0].mesh = 0, scene.nodes[1].mesh = 1;
  scene.nodes[2].light = 0, scene.nodes[2].translation = light_place;
  scene.nodes[3].camera = 0, scene.nodes[3].translation = {0, 0, 12};
  return scene;
}

bool faces_light(const HardView& view, std::uint32_t id) {
  const glm::uvec3 t = view.frame.geometry.triangles[id];
  const auto& p = view.frame.geometry.positions;
  const glm::dvec3 a(p[t.x]), b(p[t.y]), c(p[t.z]);
  return glm::dot(glm::cross(b - a, c - a), glm::dvec3(view.light.position) - a) > 0;
}

}  // namespace

ClosedMeshes measure_closed_meshes(PictureSize size) {
  ClosedMeshes found;
  for (const glm::vec3 place : {glm::vec3(4, 5, 8), glm::vec3(-9, 1, 2), glm::vec3(0.1f, -0.2f, 5)}) {
    HardView view;
    evaluate_hard_view(closed_scene(place), 0, size, view);
    ShadowTracer tracer;
    ShadowMask masks[2];
    for (const bool cull : {false, true}) {
      HardShadowConfig config;
      config.variant = Variant::precise_sorted, config.cull_front = cull;
      tracer.trace_shadow_mask(view.frame.points, view.frame.triangles(), view.light, config,
                               masks[cull ? 1 : 0]);
    }
    for (std::size_t i = 0; i < masks[0].size(); ++i) {
      const std::uint32_t id = view.frame.points.triangles[i];
      if (id == no_triangle || !faces_light(view, id)) continue;
      ++found.pixels;
      found.shadowed += masks[0][i] == 0 ? 1 : 0;
      found.differing += masks[0][i] != masks[1][i] ? 1 : 0;
    }
  }
  return found;
}

}  // namespace tenebra::bench
