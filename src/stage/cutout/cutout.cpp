#include "stage/cutout/cutout.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "stage/cutout/mask_material.h"
#include "stage/cutout/new_vertices.h"

namespace tenebra::stage {
namespace {

/// A material that cuts, and how finely it has come to be cut.
struct Task {
  std::size_t material = 0;
  Fineness fineness;
  std::unique_ptr<MaskMaterial> mask;

  std::size_t added() const {
    const std::size_t before = mask->triangles_before(), after = mask->triangles_after();
    return after > before ? after - before : 0;
  }
  void cut(std::size_t most_added) {
    while (!mask->cut(fineness, most_added)) ++fineness.step;
  }
};

std::vector<std::size_t> instances_of(const Scene& scene) {
  std::vector<std::size_t> counts(scene.meshes.size(), 0);
  for (const Node& node : scene.nodes)
    if (node.mesh >= 0) ++counts[static_cast<std::size_t>(node.mesh)];
  return counts;
}

std::vector<std::vector<MaskedTriangle>> masked_triangles(const Scene& scene) {
  std::vector<std::vector<MaskedTriangle>> lists(scene.materials.size());
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (scene.materials[mesh.materials[t]].alpha_mode == AlphaMode::mask)
        lists[mesh.materials[t]].push_back({static_cast<std::uint32_t>(m), static_cast<std::uint32_t>(t)});
    }
  }
  return lists;
}

std::vector<Task> make_tasks(const Scene& scene, const std::vector<std::size_t>& instances,
                             double tolerance_px) {
  std::vector<Task> tasks;
  std::vector<std::vector<MaskedTriangle>> lists = masked_triangles(scene);
  for (std::size_t m = 0; m < lists.size(); ++m) {
    if (lists[m].empty()) continue;
    const Fineness fineness{0, std::max(tolerance_px, 1.0 / 64)};
    tasks.push_back({m, fineness, std::make_unique<MaskMaterial>(scene, m, std::move(lists[m]), instances)});
  }
  return tasks;
}

/// Cuts all; while they add too much together, the one that adds most is made coarser.
void cut_within_limit(std::vector<Task>& tasks, std::size_t most_added) {
  for (Task& task : tasks) task.cut(most_added);
  for (;;) {
    std::size_t sum = 0;
    Task* largest = nullptr;
    for (Task& task : tasks) {
      sum += task.added();
      if (task.mask->can_be_coarser() && (!largest || task.added() > largest->added())) largest = &task;
    }
    if (sum <= most_added || !largest || largest->added() == 0) return;
    ++largest->fineness.step;
    largest->cut(most_added);
  }
}

/// The triangles that replace each triangle of a mesh: none where its material does not cut.
using Replacements = std::vector<const CutTriangle*>;

std::vector<Replacements> collect(const Scene& scene, const std::vector<Task>& tasks) {
  std::vector<Replacements> result(scene.meshes.size());
  for (const Task& task : tasks) {
    for (std::size_t i = 0; i < task.mask->triangles().size(); ++i) {
      const MaskedTriangle& masked = task.mask->triangles()[i];
      Replacements& of_mesh = result[masked.mesh];
      of_mesh.resize(scene.meshes[masked.mesh].triangles.size(), nullptr);
      of_mesh[masked.triangle] = &task.mask->results()[i];
    }
  }
  return result;
}

/// Returns how many new vertices had too many joints.
std::size_t replace_triangles(Mesh& mesh, const Replacements& replacements) {
  NewVertices vertices(mesh);
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> materials;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const CutTriangle* cut = replacements[t];
    if (!cut || cut->whole) {
      triangles.push_back(mesh.triangles[t]);
      materials.push_back(mesh.materials[t]);
      continue;
    }
    std::vector<std::uint32_t> index;
    for (const CutVertex& vertex : cut->vertices) index.push_back(vertices.add(mesh.triangles[t], vertex));
    for (const glm::uvec3& corners : cut->triangles) {
      triangles.emplace_back(index[corners.x], index[corners.y], index[corners.z]);
      materials.push_back(mesh.materials[t]);
    }
  }
  mesh.triangles = std::move(triangles);
  mesh.materials = std::move(materials);
  return vertices.lost_joints();
}

std::string name_of(const Scene& scene, std::size_t material) {
  const std::string& name = scene.materials[material].name;
  return name.empty() ? fmt::format("materials[{}]", material) : name;
}

void warn(Scene& scene, const std::vector<Task>& tasks, const CutoutLimits& limits, std::size_t lost_joints) {
  for (const Task& task : tasks) {
    if (task.fineness.step == 0) continue;
    scene.warnings.push_back(
        fmt::format("{}: alpha is cut out to {:g} pixels of its texture, not {:g}: finer would add more than "
                    "{} triangles to the scene.",
                    name_of(scene, task.material), task.fineness.texture_tolerance(),
                    task.fineness.tolerance_px, limits.most_added));
  }
  if (lost_joints > 0) {
    scene.warnings.push_back(fmt::format(
        "Cutting out alpha made {} vertices between corners with more than eight joints together; the eight "
        "with most weight were kept.",
        lost_joints));
  }
}

}  // namespace

CutoutCounts cut_out_masks(Scene& scene, const CutoutLimits& limits) {
  const std::vector<std::size_t> instances = instances_of(scene);
  std::vector<Task> tasks = make_tasks(scene, instances, limits.tolerance_px);
  CutoutCounts counts;
  if (!tasks.empty()) {
    cut_within_limit(tasks, limits.most_added);
    for (const Task& task : tasks) {
      counts.triangles += task.mask->triangles_before();
      counts.left += task.mask->triangles_after();
    }
    const std::vector<Replacements> replacements = collect(scene, tasks);
    std::size_t lost_joints = 0;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
      if (!replacements[m].empty()) lost_joints += replace_triangles(scene.meshes[m], replacements[m]);
    warn(scene, tasks, limits, lost_joints);
  }
  for (Material& material : scene.materials)
    if (material.alpha_mode == AlphaMode::mask) material.alpha_mode = AlphaMode::opaque;
  return counts;
}

}  // namespace tenebra::stage
