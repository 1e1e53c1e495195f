// The options of `tenebra bake`.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "options/method_options.h"
#include "options/scene_options.h"

namespace tenebra::viewer {

enum class BakeTarget { vertices, lightmap };
enum class BakeContent { light, ao, both };

struct BakeOptions {
  SceneOptions scene;
  std::optional<int> frame;
  BakeTarget target = BakeTarget::vertices;
  BakeContent content = BakeContent::both;
  int size = 1024;                   ///< of the lightmap's sides, texels
  int per_side = 2;                  ///< samples per texel, each way
  int rings = 16;                    ///< rings of texels by which covered areas are widened
  float exposure = 1;                ///< of vertex colours and PNG
  std::optional<glm::vec3> ambient;  ///< not given: the scene's
  MethodOptions method;
  std::string output, map;
  double timeout_s = std::numeric_limits<double>::infinity();
  std::optional<int> memory_mb;  ///< of the whole program
  bool quiet = false;
};

void add_bake_options(CLI::App& command, BakeOptions& options);

/// Checks what single options cannot; names the map where no name was given.
Expected<void> settle_bake_options(const CLI::App& command, BakeOptions& options);

/// How the light of a scene is computed.
render::RenderSettings bake_settings(const BakeOptions& options, const SceneDisplay& display);

}  // namespace tenebra::viewer
