#include "bench/common/bench_frame.h"

#include "base/fail.h"
#include "bench/common/bench_embree.h"
#include "formats/import_scene.h"
#include "parallel/parallel.h"
#include "stage/additions.h"
#include "stage/left_out.h"

namespace tenebra::bench {
namespace {

constexpr double frames_a_second = 30.0;  // of clips that state no frames, as in `tenebra render`

void measure_box(BenchFrame& frame) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const glm::uvec3& t : frame.geometry.triangles) {
    if (t == glm::uvec3(0)) continue;  // dropped
    for (int k = 0; k < 3; ++k) {
      low = glm::min(low, frame.geometry.positions[t[k]]);
      high = glm::max(high, frame.geometry.positions[t[k]]);
    }
  }
  frame.centre = (low + high) * 0.5f;
  frame.diagonal_m = glm::length(high - low);
}

}  // namespace

Expected<Scene> load_scene(const std::filesystem::path& file, const std::vector<std::string>& no_cast) {
  auto scene = formats::import_scene(file);
  if (!scene) return scene;
  std::string unmatched;
  if (!stage::leave_out_casters(*scene, no_cast, unmatched)) {
    return base::fail("{}: found no mesh, material or FILE:LINE {}, which is to cast no shadow",
                      file.string(), unmatched);
  }
  stage::add_missing_camera_and_light(*scene);
  return scene;
}

Instant frame_instant(const Scene& scene, int frame) {
  if (scene.clips.empty()) return {};
  return {0, frame_time_s(scene.clips[0], frame, frames_a_second)};
}

void evaluate_bench_frame(const Scene& scene, int frame, int width, int height, BenchFrame& out) {
  const auto [clip, time_s] = frame_instant(scene, frame);
  evaluate_frame(scene, clip, time_s, out.geometry);
  out.lights = evaluate_lights(scene, clip, time_s);
  out.view = evaluate_camera(scene, clip, time_s, 0, width, height);
  measure_box(out);
  const std::vector<std::uint32_t> ids = nearest_triangles(out.triangles(), out.view, width, height);
  compute_visible_points(ids, width, height, out.view, out.triangles(), out.points);
  compute_shading_normals(out.points, out.geometry.normals, out.triangles(), out.normals);
}

void make_opaque(Scene& scene) {
  for (Material& material : scene.materials) {
    if (!material.see_through()) continue;
    material.alpha_mode = AlphaMode::opaque;
    material.alpha = 1;
    material.transmission = 0;
    material.transmission_map = {};
  }
}

std::filesystem::path bart_folder(const std::filesystem::path& data) {
  return data.empty() ? std::filesystem::path(TENEBRA_SHARED_DIR) / "scenes" / "bart" : data;
}

}  // namespace tenebra::bench
