#include "bench/hard/hard_views.h"

#include <fmt/core.h>

#include "bench/common/bench_embree.h"
#include "bench/common/bench_report.h"
#include "bench/common/bench_scenes.h"
#include "points/point_tiles.h"
#include "render/shadow_lights.h"

namespace tenebra::bench {

std::vector<HardFrames> hard_frames(bool quick) {
  std::vector<HardFrames> frames{{"robots", {100, 160, 400, 640}},
                                 {"museum5", {20, 100, 200}},
                                 {"museum5x64", {20, 100, 200}},
                                 {"kitchen", {100, 400}},
                                 {"city", {150}}};
  if (!quick) frames.insert(frames.end(), {{"gallery", {100}}, {"court", {60}}});
  return frames;
}

void evaluate_hard_view(const Scene& scene, int number, PictureSize size, HardView& view) {
  // Before first: both geometries then come from warm buffers of their own.
  const auto [clip, earlier_s] = frame_instant(scene, number > 0 ? number - 1 : 1);
  evaluate_frame(scene, clip, earlier_s, view.before);
  evaluate_bench_frame(scene, number, size.width, size.height, view.frame);
  points::make_point_tiles(view.frame.points, view.frame.triangles(), *view.frame.points.tiles);
  const WorldLight& placed = view.frame.lights.front();
  view.light = render::shadow_light(scene.lights[static_cast<std::size_t>(placed.light)], placed);
}

Expected<void> for_each_view(const BenchOptions& options, const std::vector<HardFrames>& chosen,
                             PictureSize size, std::vector<std::string>& skipped,
                             const std::function<Expected<void>(const Scene&, const HardView&)>& body) {
  const auto data = bart_folder(options.data);
  for (const HardFrames& part : chosen) {
    const BenchScene& known = bench_scene(part.scene);
    std::unique_ptr<testing::TemporaryFolder> made;
    const auto file = find_scene(known, data, made);
    if (file.empty()) {
      progress(fmt::format("{}: skipped, {} is not there", part.scene, (data / known.file).string()));
      skipped.push_back(skipped_sentence(part.scene));
      continue;
    }
    const auto scene = load_scene(file, known.no_cast);
    if (!scene) return tl::unexpected(scene.error());
    HardView view;
    for (const int number : part.frames) {
      view.name = fmt::format("{} {}", part.scene, number);
      view.counted = !known.bundled;
      evaluate_hard_view(*scene, number, size, view);
      if (auto done = body(*scene, view); !done) return done;
    }
  }
  return {};
}

void subdivide(FrameGeometry& g) {
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint8_t> casts;
  triangles.reserve(4 * g.triangles.size());
  for (std::size_t i = 0; i < g.triangles.size(); ++i) {
    const glm::uvec3 t = g.triangles[i];
    glm::uvec3 middle;
    for (int k = 0; k < 3; ++k) {
      middle[k] = static_cast<std::uint32_t>(g.positions.size());
      const glm::vec3 a = g.positions[t[k]], b = g.positions[t[(k + 1) % 3]];
      g.positions.push_back(0.5f * a + 0.5f * b);
    }
    triangles.push_back({t.x, middle.x, middle.z});
    triangles.push_back({middle.x, t.y, middle.y});
    triangles.push_back({middle.z, middle.y, t.z});
    triangles.push_back({middle.x, middle.y, middle.z});
    casts.insert(casts.end(), 4, g.casts_shadow[i]);
  }
  g.triangles = std::move(triangles);
  g.casts_shadow = std::move(casts);
  for (std::uint32_t& part : g.parts) part *= 4;
  g.normals.clear();
}

void see_anew(HardView& view, PictureSize size) {
  BenchFrame& f = view.frame;
  const auto ids = nearest_triangles(f.triangles(), f.view, size.width, size.height);
  compute_visible_points(ids, size.width, size.height, f.view, f.triangles(), f.points,
                         PointLayout::rows_and_tiles);
}

}  // namespace tenebra::bench
