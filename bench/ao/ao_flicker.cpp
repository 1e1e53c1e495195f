// Steadiness: by how much still points change from frame to frame though nothing near has moved past them.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <tenebra/ambient_occlusion.h>
#include "bench/ao/ao_held_view.h"
#include "bench/ao/ao_moving.h"
#include "bench/ao/ao_objects.h"
#include "bench/ao/ao_session.h"
#include "bench/common/bench_frame.h"

namespace tenebra::bench {
namespace {

struct Footage {
  const char* name;
  std::filesystem::path file;
  int first_frame;
};

/// Pixel of a point as `view` sees it; -1 where it does not.
int pixel_of(const ViewRays& view, const glm::dvec3& point, int width, int height) {
  const glm::dvec3 at = glm::inverse(glm::dmat3(view.dx, view.dy, view.d0)) * (point - glm::dvec3(view.eye));
  if (!(at.z > 0) || view.orthographic) return -1;
  const double x = at.x / at.z, y = at.y / at.z;
  if (!(x >= 0 && y >= 0 && x < width && y < height)) return -1;
  return static_cast<int>(y) * width + static_cast<int>(x);
}

/// The same points of the world, each at the pixel where the next frame's camera sees it.
struct Carried {
  VisiblePoints points;
  std::vector<glm::vec3> normals;
  std::vector<std::size_t>
      from;  ///< pixel of the frame before, one per pixel; meaningless without a triangle
};
Carried carry(const BenchFrame& now, const std::vector<bool>& moves, const ViewRays& next_view) {
  Carried c;
  const int width = now.points.width, height = now.points.height;
  c.points = {width, height, now.points.positions,
              std::vector<std::uint32_t>(now.pixel_count(), no_triangle)};
  c.normals.assign(now.pixel_count(), glm::vec3(0, 1, 0));
  c.from.assign(now.pixel_count(), 0);
  for (std::size_t i = 0; i < now.pixel_count(); ++i) {
    const std::uint32_t id = now.points.triangles[i];
    if (id == no_triangle || moves[id]) continue;
    const int pixel = pixel_of(next_view, now.points.positions[i], width, height);
    if (pixel < 0) continue;
    const auto p = static_cast<std::size_t>(pixel);
    c.points.positions[p] = now.points.positions[i];
    c.points.triangles[p] = id;
    c.normals[p] = now.normals[i];
    c.from[p] = i;
  }
  return c;
}

/// Changes of still points, in 1/255, by whether something moves within the reach.
struct Changes {
  std::vector<double> undisturbed;
  std::vector<double> disturbed;
};

struct Viewing {
  const AoSession& session;
  const Scene& scene;
  int width, height;
  AmbientOcclusion ao{};
  double reach = 0;
};

Expected<void> compare(Viewing& run, const BenchFrame& now, const BenchFrame& next, Changes& changes) {
  const AoConfig config = run.session.field_config(64, run.reach);
  const MovingTriangles moving(now.geometry, next.geometry);
  const Carried carried = carry(now, moving.moves(), next.view);
  std::vector<float> before, after;
  if (auto done = run.ao.compute(run.scene, now.geometry, now.points, now.normals, config, before); !done)
    return done;
  if (auto done = run.ao.compute(run.scene, next.geometry, carried.points, carried.normals, config, after);
      !done)
    return done;
  for (std::size_t p = 0; p < after.size(); ++p) {
    if (carried.points.triangles[p] == no_triangle) continue;
    const double change = 255 * std::abs(double{after[p]} - double{before[carried.from[p]]});
    const bool near = moving.within(carried.points.positions[p], run.reach);
    (near ? changes.disturbed : changes.undisturbed).push_back(change);
  }
  return {};
}

double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

using Rows = std::vector<std::vector<std::string>>;

Expected<void> measure_clip(AoSession& session, const Footage& clip, Rows& rows, Rows& held_rows) {
  const auto scene = load_scene(clip.file);
  if (!scene) {
    session.notes.push_back(
        fmt::format("{} is left out of the steadiness: {}", clip.name, scene.error().message));
    return {};
  }
  Viewing run{session, *scene, session.by_effort(64, 320, 640), session.by_effort(48, 240, 480)};
  BenchFrame now, next;
  evaluate_bench_frame(*scene, clip.first_frame, run.width, run.height, now);
  run.reach = static_cast<double>(now.diagonal_m) / 20;
  Changes changes;
  const int frames = session.by_effort(1, 6, 30);
  for (int f = 1; f <= frames; ++f) {
    progress(fmt::format("steadiness: {}, frame {}", clip.name, clip.first_frame + f));
    evaluate_bench_frame(*scene, clip.first_frame + f, run.width, run.height, next);
    if (auto done = compare(run, now, next, changes); !done) return done;
    std::swap(now, next);
  }
  const double still = largest(changes.undisturbed), near = largest(changes.disturbed);
  rows.push_back({clip.name, fmt::format("{}..{}", clip.first_frame, clip.first_frame + frames),
                  fmt::format("{}", changes.undisturbed.size()), fmt::format("{:.3f}", still),
                  fmt::format("{}", changes.disturbed.size()), fmt::format("{:.1f}", near)});
  session.report.add(
      {"flicker", clip.name, "field", "", "largest change of undisturbed points", still, "1/255"});
  session.report.add({"flicker", clip.name, "field", "", "undisturbed points",
                      static_cast<double>(changes.undisturbed.size()), ""});
  session.report.add({"flicker", clip.name, "field", "", "largest change near what moves", near, "1/255"});
  if (changes.undisturbed.empty())
    session.notes.push_back(
        fmt::format("{}: no point stood still with nothing near: steadiness was not measured", clip.name));
  return measure_held_view(session, clip.name, *scene, clip.first_frame, held_rows);
}

}  // namespace

Expected<void> measure_flicker(AoSession& session) {
  const std::filesystem::path bundled = TENEBRA_SCENES_DIR;
  std::vector<Footage> clips{{"city", bundled / "city.glb", 60}};
  if (session.effort != Effort::tiny) {
    const auto robots = scene_root(session.options.data) / "bart" / "robots" / "Robot.aff";
    clips.push_back({"robots", robots, 160});
  }
  Rows rows{{"scene", "frames", "still points", "largest change", "near what moves", "largest change there"}},
      held_rows{{"scene", "frames", "pixels", "mean", "RMS", "largest", "% beyond 1"}};
  for (const Footage& clip : clips) {
    if (auto done = measure_clip(session, clip, rows, held_rows); !done) return done;
  }
  print_table("Steadiness of fields: still points from frame to frame, in 1/255", rows);
  print_table("Steadiness of --ao adaptive: changes at undisturbed pixels with the camera held, in 1/255",
              held_rows);
  return {};
}

}  // namespace tenebra::bench
