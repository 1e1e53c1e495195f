#include "bench/ao/scenes/ao_scene_views.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "bench/ao/ao_crowd.h"
#include "bench/common/bench_scenes.h"

namespace tenebra::bench {
namespace {

struct Place {
  const char* name;
  const char* scene;  ///< of bench_scene(); empty: a crowd
  int frame;
};
constexpr std::array places{Place{"robots 100", "robots", 100}, Place{"robots 160", "robots", 160},
                            Place{"robots 400", "robots", 400}, Place{"city 60", "city", 60},
                            Place{"city 150", "city", 150},     Place{"court 60", "court", 60},
                            Place{"gallery 60", "gallery", 60}, Place{"kitchen 100", "kitchen", 100},
                            Place{"museum5 20", "museum5", 20}, Place{"crowd far", "", 0},
                            Place{"crowd near", "", 0}};

constexpr double crowd_time_s = 3.7, crowd_step_s = 1.0 / 30;
constexpr float crowd_reach_m = 1.0f;  // about the objects' radius

void see(AoSceneView& view, const CrowdView& from, int size) {
  see_crowd(view.scene, from, crowd_time_s - crowd_step_s, size, view.before);
  see_crowd(view.scene, from, crowd_time_s, size, view.now);
  view.reach_m = crowd_reach_m;
}

}  // namespace

std::vector<std::string> ao_scene_names() {
  std::vector<std::string> names;
  for (const Place& place : places) names.emplace_back(place.name);
  return names;
}

float default_reach(const Scene& scene) {
  FrameGeometry frame;
  const bool moves = !scene.clips.empty();
  evaluate_frame(scene, moves ? 0 : -1, moves ? scene.clips.front().start_s : 0, frame);
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const glm::uvec3& t : frame.triangles) {
    if (t == glm::uvec3(0)) continue;  // dropped
    for (int k = 0; k < 3; ++k) {
      low = glm::min(low, glm::dvec3(frame.positions[t[k]]));
      high = glm::max(high, glm::dvec3(frame.positions[t[k]]));
    }
  }
  return static_cast<float>(glm::length(high - low) / 20);
}

Expected<std::unique_ptr<AoSceneView>> load_ao_scene(const std::string& name, int size, int walkers,
                                                     const std::filesystem::path& data,
                                                     std::vector<std::string>& notes) {
  const auto place =
      std::find_if(places.begin(), places.end(), [&](const Place& p) { return p.name == name; });
  auto view = std::make_unique<AoSceneView>();
  view->name = name;
  if (*place->scene == 0) {
    const CrowdView& from = name == "crowd far" ? far_view : near_view;
    view->scene = make_crowd(crowd_objects(data, notes), walkers, from.spacing_m);
    see(*view, from, size);
    return view;
  }
  const BenchScene& known = bench_scene(place->scene);
  std::unique_ptr<testing::TemporaryFolder> made;
  const auto file = find_scene(known, bart_folder(data), made);
  if (file.empty()) {
    notes.push_back(fmt::format("{} is left out: {} is missing", name, known.file));
    return nullptr;
  }
  auto scene = load_scene(file, known.no_cast);
  if (!scene) return tl::unexpected(scene.error());
  view->scene = std::move(*scene);
  make_opaque(view->scene);
  evaluate_bench_frame(view->scene, place->frame - 1, size, size, view->before);
  evaluate_bench_frame(view->scene, place->frame, size, size, view->now);
  view->reach_m = default_reach(view->scene);
  return view;
}

}  // namespace tenebra::bench
