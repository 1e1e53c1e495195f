// Scenes as the program reads and draws them, for the module: no Python here.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tenebra/stop_flag.h>
#include "beside.h"
#include "options/method_options.h"
#include "options/picture_options.h"
#include "options/scene_options.h"
#include "render/renderer.h"
#include "shared/scene_choice.h"
#include "shared/scene_plan.h"

namespace tenebra::python {

/// What a long call looks at and says.
struct Work {
  StopFlag stop;
  std::atomic<double> done{0};
};

/// A scene made ready as `tenebra render` makes it, and a renderer on the CPU.
class LoadedScene {
public:
  /// `arguments`: options of `tenebra render` that speak of the scene.
  static Expected<std::unique_ptr<LoadedScene>> load(const std::string& path, const std::string& arguments);

  struct Picture {
    render::FrameResult result;
    VisiblePoints points;            ///< ids, and positions if they were wanted
    std::vector<glm::vec3> normals;  ///< likewise
    ViewRays view;
    render::AovChoice aovs;  ///< what of the result's was asked for
  };
  /// What costs time and is not always asked for.
  struct Wanted {
    bool points = false;  ///< Picture::points' positions, and normals
    bool linear = false;
  };
  /// `arguments`: options of `tenebra render` that speak of camera and method, and --aov.
  Expected<Picture> render(int frame, std::optional<double> time_s, const std::string& arguments,
                           Wanted wanted, Work& work);

  Expected<double> time_of(int frame) const;
  FrameGeometry geometry(double time_s) const;
  std::vector<WorldLight> lights(double time_s) const {
    return stage::placed_lights(plan_.scene, options_.edits, plan_.clip, time_s);
  }
  int frames() const { return viewer::frames_of_clip(plan_.scene, plan_.clip, options_.fps); }
  const viewer::ScenePlan& plan() const { return plan_; }

  Beside beside;  ///< for calls of render()

private:
  LoadedScene() = default;
  /// Camera, method and what is kept, of `arguments`.
  struct Wish {
    std::string arguments;
    viewer::SceneOptions scene;
    viewer::MethodOptions method;
    render::AovChoice aovs;
  };
  void evaluate(double time_s, FrameGeometry& geometry) const;
  Expected<Wish> wish_of(const std::string& arguments) const;
  Expected<render::RenderSettings> settings_of(const Wish& wish);

  viewer::SceneOptions options_;
  viewer::ScenePlan plan_;
  std::optional<render::Renderer> renderer_;
  std::optional<Wish> wish_;  ///< of the last call: many have the same
  render::FrameInput input_;  ///< likewise, for its memory
};

}  // namespace tenebra::python
