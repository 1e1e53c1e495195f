#include "render_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene_choice.h"

namespace tenebra::viewer {
namespace {

constexpr Size default_size{800, 600};
constexpr double default_fov_deg = 45.0;
/// With --eye the near plane lies at this part of the way to the point looked at.
constexpr float near_of_distance = 1e-3f;

float radians(double degrees) {
  return static_cast<float>(degrees * std::numbers::pi / 180.0);
}

Expected<std::vector<PlannedFrame>> plan_frames(const Scene& scene, int clip, const RenderOptions& options) {
  if (options.time_s) return std::vector<PlannedFrame>{{0, *options.time_s}};
  const int count = frames_of_clip(scene, clip, options.fps);
  const FrameRange range = options.frames.value_or(FrameRange{0, 0, 1});
  const int last = range.last.value_or(count - 1);
  if (range.first >= count || last >= count) {
    return fail("--frames: frame {} does not exist, {} has frames 0 to {}", std::max(range.first, last),
                clip < 0 ? "the scene without animation" : "the animation", count - 1);
  }
  std::vector<PlannedFrame> frames;
  for (long long frame = range.first; frame <= last; frame += range.step) {
    const int number = static_cast<int>(frame);
    frames.push_back({number, time_of_frame(scene, clip, number, options.fps)});
  }
  return frames;
}

Size plan_size(const Scene& scene, int camera, const RenderOptions& options) {
  if (options.size) return *options.size;
  const auto aspect = scene.cameras[static_cast<std::size_t>(camera)].aspect;
  if (options.eye || !aspect || !(*aspect > 0)) return default_size;
  const double height = std::clamp<double>(default_size.width / *aspect, 1.0, largest_side_px);
  return {default_size.width, static_cast<int>(std::lround(height))};
}

Expected<void> apply_field_of_view(Scene& scene, int camera, const RenderOptions& options) {
  if (!options.fov_deg || options.eye) return {};
  Camera& chosen = scene.cameras[static_cast<std::size_t>(camera)];
  if (chosen.projection == Projection::orthographic) {
    return fail("--fov: camera {} ({}) is orthographic and has no field of view", camera, chosen.name);
  }
  chosen.vertical_fov_rad = radians(*options.fov_deg);
  return {};
}

RenderSettings plan_settings(const RenderOptions& options, Size size) {
  RenderSettings settings = options.render;
  settings.width = size.width;
  settings.height = size.height;
  // Points from the depth buffer lie off their triangles: only the paper's front-face culling keeps those
  // from shadowing their own points.
  const bool from_depth = settings.samples == SampleSource::depth;
  settings.hard.cull_front = options.cull_front.value_or(from_depth);
  settings.hard.contact = from_depth ? ContactRule::none : ContactRule::triangle_ids;
  return settings;
}

Expected<void> plan_lights(RenderPlan& plan) {
  const auto lights = evaluate_lights(plan.scene, plan.clip, plan.frames.front().time_s);
  if (plan.settings.light >= static_cast<int>(lights.size())) {
    return fail("--light: found {}, the scene has lights 0 to {}", plan.settings.light,
                static_cast<int>(lights.size()) - 1);
  }
  plan.several_lights = plan.settings.light < 0 && lights.size() > 1;
  return {};
}

}  // namespace

Expected<RenderPlan> plan_render(const RenderOptions& options) {
  auto scene = import_scene(options.scene, options.import);
  if (!scene) return tl::unexpected(scene.error());
  RenderPlan plan;
  plan.scene = std::move(*scene);
  std::string unmatched;
  if (!leave_out_casters(plan.scene, options.no_cast, unmatched)) {
    return fail("--no-cast: {} names no mesh, material or FILE:LINE of the scene", unmatched);
  }
  add_missing_camera_and_light(plan.scene);

  const auto clip = choose_clip(plan.scene, options.clip);
  if (!clip) return tl::unexpected(clip.error());
  plan.clip = *clip;
  const auto camera = choose_camera(plan.scene, options.camera);
  if (!camera) return tl::unexpected(camera.error());
  plan.camera = *camera;
  auto frames = plan_frames(plan.scene, plan.clip, options);
  if (!frames) return tl::unexpected(frames.error());
  plan.frames = std::move(*frames);
  plan.settings = plan_settings(options, plan_size(plan.scene, plan.camera, options));
  if (auto applied = apply_field_of_view(plan.scene, plan.camera, options); !applied) {
    return tl::unexpected(applied.error());
  }
  if (auto planned = plan_lights(plan); !planned) return tl::unexpected(planned.error());
  return plan;
}

ViewRays view_of(const RenderPlan& plan, const RenderOptions& options, double time_s) {
  const auto& settings = plan.settings;
  if (!options.eye) {
    return evaluate_camera(plan.scene, plan.clip, time_s, plan.camera, settings.width, settings.height);
  }
  const float near_m = near_of_distance * glm::distance(*options.eye, options.look_at);
  return look_at(*options.eye, options.look_at, options.up,
                 radians(options.fov_deg.value_or(default_fov_deg)), near_m, settings.width, settings.height);
}

}  // namespace tenebra::viewer
