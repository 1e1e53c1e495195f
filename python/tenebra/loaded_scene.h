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
#include "session/session.h"

namespace tenebra::python {

/// What a long call looks at and says.
struct Work {
  StopFlag stop;
  std::atomic<double> done{0};
};

/// A scene made ready as `tenebra render` makes it, drawn on the CPU.
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
  /// The triangles and lights of an instant.
  render::FrameInput at(double time_s) const;
  const stage::SceneEdits& edits() const { return options_.edits; }
  const session::StagedScene& staged() const { return session_->staged(); }

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
  Expected<Wish> wish_of(const std::string& arguments) const;
  Expected<render::RenderSettings> settings_of(const Wish& wish);

  viewer::SceneOptions options_;
  std::optional<session::Session> session_;
  settings::SceneDisplay display_;  ///< the scene's, with exposures once they were asked for
  std::optional<Wish> wish_;        ///< of the last call: many have the same
};

}  // namespace tenebra::python
