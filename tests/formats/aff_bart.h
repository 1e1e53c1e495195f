// BART's three scenes, for tests that hold them against figures of an independent evaluator (aff-format.md, 8
// and 9).
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "formats/import_scene.h"
#include "support/bart.h"

namespace tenebra::testing {

inline const std::filesystem::path bart = bart_folder();

enum class Bart { robots, kitchen, museum };

inline const char* file_of(Bart which) {
  switch (which) {
    case Bart::robots:
      return "robots/Robot.aff";
    case Bart::kitchen:
      return "kitchen/kitchen.aff";
    case Bart::museum:
      break;
  }
  return "museum/museum5.aff";
}

/// Each scene is read once per test program.
inline const Scene& scene_of(Bart which) {
  static std::map<Bart, Scene> scenes;
  const auto found = scenes.find(which);
  if (found != scenes.end()) return found->second;
  Expected<Scene> scene = formats::import_aff(bart / file_of(which), {});
  EXPECT_TRUE(scene.has_value()) << scene.error().message;
  return scenes.emplace(which, std::move(*scene)).first->second;
}

/// Below an `x` or of a `tpa`: BART's x blocks are the only named nodes with children.
inline bool moves(const Scene& scene, int node) {
  if (!scene.meshes[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(node)].mesh)]
           .shapes.empty()) {
    return true;
  }
  for (; node >= 0; node = scene.nodes[static_cast<std::size_t>(node)].parent) {
    if (!scene.nodes[static_cast<std::size_t>(node)].name.empty()) return true;
  }
  return false;
}

inline bool is_cone(const Mesh& mesh) {
  return mesh.triangles.size() == 128;
}

}  // namespace tenebra::testing
