// Scenes as the program reads and draws them, for the module: no Python here.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tenebra/stop_flag.h>
#include "beside.h"
#include "session/session.h"
#include "settings/tables.h"

namespace tenebra::python {

/// What a long call looks at and says.
struct Work {
  StopFlag stop;
  std::atomic<double> done{0};
};

/// Settings by their names in Python ("soft_error"), each with a value as texts have it; lists are named
/// several times.
using Keywords = std::vector<std::pair<std::string, std::string>>;

/// The names of the settings that load() takes, and render(): for messages and documentation.
std::vector<std::string> names_of_scene();
std::vector<std::string> names_of_render();

/// A scene made ready as `tenebra render` makes it, drawn on the CPU.
class LoadedScene {
public:
  /// `keywords`: of names_of_scene(): settings of the scene, but for the camera's and the moment's.
  static Expected<std::unique_ptr<LoadedScene>> load(const std::string& path, const Keywords& keywords);

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
  /// `keywords`: of names_of_render(): settings of the camera, of the size and of the method, and aov.
  Expected<Picture> render(int frame, std::optional<double> time_s, const Keywords& keywords, Wanted wanted,
                           Work& work);

  Expected<double> time_of(int frame) const;
  /// The triangles and lights of an instant.
  render::FrameInput at(double time_s) const;
  const stage::SceneEdits& edits() const { return settings_.edits; }
  const session::StagedScene& staged() const { return session_->staged(); }

  Beside beside;  ///< for calls of render()

private:
  LoadedScene() = default;
  /// Camera, method and what is kept.
  struct Wish {
    Keywords keywords;  ///< that it follows from
    settings::SceneSettings scene;
    settings::MethodSettings method;
    render::AovChoice aovs;
  };
  Expected<Wish> wish_of(const Keywords& keywords) const;
  Expected<render::RenderSettings> settings_of(const Wish& wish);

  settings::SceneSettings settings_;
  std::optional<session::Session> session_;
  settings::SceneDisplay display_;  ///< the scene's, with exposures once they were asked for
  std::optional<Wish> wish_;        ///< of the last call: many have the same
};

}  // namespace tenebra::python
