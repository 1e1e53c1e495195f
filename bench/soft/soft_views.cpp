#include "bench/soft/soft_views.h"

#include <algorithm>
#include <exception>

#include <fmt/core.h>

#include "base/fail.h"
#include "bench/common/bench_report.h"
#include "bench/common/bench_scenes.h"
#include "scene/view_basis.h"

namespace tenebra::bench {
namespace {

constexpr double side_percent_of_diagonal = 4;
constexpr double sun_deg = 0.53;
constexpr double large_percent = 50;
constexpr int large_width = 320, large_height = 180;

struct SceneEntry {
  std::string name;
  std::vector<int> frames;  // the first is the one that the goals are stated for
  bool under_the_sky = false, sun_only = false;
  bool large = false;  // the first with a light of half the diagonal, too
  bool large_only = false;
};

const std::vector<SceneEntry>& scene_entries() {
  static const std::vector<SceneEntry> entries{{"robots", {100, 400}, true, false, true},
                                               {"museum5", {20, 100}},
                                               {"kitchen", {100, 400}},
                                               {"museum5x64", {20, 100}},
                                               {"court", {60}, true},
                                               {"city", {150}, true, true},
                                               {"gallery", {150}, false, false, true, true}};
  return entries;
}

bool chosen(const ViewChoice& choice, const std::string& name) {
  return choice.only.empty() || std::find(choice.only.begin(), choice.only.end(), name) != choice.only.end();
}

/// The scene's own area light, or its first light made a square.
Expected<AreaLight> light_of(const Scene& scene, const BenchFrame& frame) {
  for (const WorldLight& placed : frame.lights) {
    if (scene.lights[static_cast<std::size_t>(placed.light)].type != LightType::area_rect) continue;
    const bool turned = glm::dot(glm::cross(placed.axis_x, placed.axis_y), placed.direction) < 0;
    return make_rectangle_light(placed.position, placed.axis_x, turned ? -placed.axis_y : placed.axis_y);
  }
  return square_light(frame, side_percent_of_diagonal);
}

/// A sun where the scene's directional light is, or its first light as the middle sees it.
Expected<AreaLight> sun_of(const Scene& scene, const BenchFrame& frame) {
  for (const WorldLight& placed : frame.lights)
    if (scene.lights[static_cast<std::size_t>(placed.light)].type == LightType::directional)
      return make_sun(-placed.direction, sun_deg);
  return make_sun(frame.lights.front().position - frame.centre, sun_deg);
}

Expected<void> visit_large(const SceneEntry& entry, const Scene& scene, const ViewChoice& choice,
                           const std::function<Expected<void>(const SoftView&)>& body) {
  SoftView view;
  view.name = fmt::format("{} {}, {} %", entry.name, entry.frames.front(), large_percent);
  view.large = true;
  evaluate_bench_frame(scene, entry.frames.front(), std::min(choice.width, large_width),
                       std::min(choice.height, large_height), view.frame);
  auto light = square_light(view.frame, large_percent);
  if (!light) return base::fail("{}: {}", view.name, light.error().message);
  view.light = std::move(*light);
  return body(view);
}

Expected<void> visit_frames(const SceneEntry& entry, const std::filesystem::path& file,
                            const ViewChoice& choice,
                            const std::function<Expected<void>(const SoftView&)>& body) {
  const BenchScene& known = bench_scene(entry.name);
  const auto scene = load_scene(file, known.no_cast);
  if (!scene) return tl::unexpected(scene.error());
  if (entry.large && choice.large_lights) {
    if (auto done = visit_large(entry, *scene, choice, body); !done || entry.large_only) return done;
  }
  for (const int number : entry.frames) {
    const bool first = number == entry.frames.front();
    if (!first && !choice.more_frames) continue;
    SoftView view{
        fmt::format("{} {}", entry.name, number), first && !known.bundled, entry.sun_only, false, {}, {}, {}};
    evaluate_bench_frame(*scene, number, choice.width, choice.height, view.frame);
    auto light = light_of(*scene, view.frame);
    if (!light) return base::fail("{}: {}", view.name, light.error().message);
    view.light = std::move(*light);
    if (entry.under_the_sky && first) {
      auto sun = sun_of(*scene, view.frame);
      if (!sun) return base::fail("{}: {}", view.name, sun.error().message);
      view.sun = std::move(*sun);
    }
    if (auto done = body(view); !done) return done;
  }
  return {};
}

}  // namespace

Expected<AreaLight> square_light(const BenchFrame& frame, double side_percent, glm::vec3 shift_m) {
  const glm::vec3 place = frame.lights.front().position + shift_m;
  const glm::dmat3 basis =
      scene::view_basis(glm::dvec3(frame.centre) - glm::dvec3(place), glm::dvec3(0, 1, 0));
  const double half_m = 0.005 * side_percent * static_cast<double>(frame.diagonal_m);
  return make_rectangle_light(place, glm::vec3(half_m * basis[0]), glm::vec3(-half_m * basis[1]));
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const SceneEntry& entry : scene_entries()) names.emplace_back(entry.name);
  return names;
}

Expected<void> for_each_view(const BenchOptions& options, const ViewChoice& choice,
                             std::vector<std::string>& skipped,
                             const std::function<Expected<void>(const SoftView&)>& body) {
  const auto data = bart_folder(options.data);
  for (const SceneEntry& entry : scene_entries()) {
    if (!chosen(choice, entry.name) || (entry.large_only && !choice.large_lights)) continue;
    std::unique_ptr<testing::TemporaryFolder> made;
    const auto file = find_scene(bench_scene(entry.name), data, made);
    if (file.empty()) {
      progress(fmt::format("{}: skipped, {} is not there", entry.name,
                           (data / bench_scene(entry.name).file).string()));
      skipped.push_back(skipped_sentence(entry.name));
      continue;
    }
    if (auto done = visit_frames(entry, file, choice, body); !done) return done;
  }
  return {};
}

}  // namespace tenebra::bench
