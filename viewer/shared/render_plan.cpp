#include "shared/render_plan.h"

#include <algorithm>

#include "base/fail.h"

namespace tenebra::viewer {
namespace {

Expected<std::vector<PlannedFrame>> plan_frames(const session::StagedScene& staged,
                                                const RenderOptions& options) {
  if (options.scene.time_s) return std::vector<PlannedFrame>{{0, *options.scene.time_s}};
  const int count = staged.frames();
  const FrameRange range = options.frames.value_or(FrameRange{0, 0, 1});
  const int last = range.last.value_or(count - 1);
  if (range.first >= count || last >= count) {
    return base::fail("--frames: frame {} does not exist, {} has frames 0 to {}", std::max(range.first, last),
                      staged.clip < 0 ? "the scene without animation" : "the animation", count - 1);
  }
  std::vector<PlannedFrame> frames;
  for (long long frame = range.first; frame <= last; frame += range.step) {
    const int number = static_cast<int>(frame);
    frames.push_back({number, staged.time_of_frame(number)});
  }
  return frames;
}

/// Chunks follow each other and differ by one frame at most.
std::vector<PlannedFrame> frames_of_chunk(const std::vector<PlannedFrame>& frames, Chunk chunk) {
  const auto begin_of = [&](int index) {
    return frames.begin() + static_cast<std::ptrdiff_t>(frames.size() * static_cast<std::size_t>(index) /
                                                        static_cast<std::size_t>(chunk.count));
  };
  return {begin_of(chunk.index - 1), begin_of(chunk.index)};
}

}  // namespace

Expected<RenderPlan> plan_render(const RenderOptions& options) {
  SceneOptions of_scene = options.scene;
  of_scene.meter_exposure = options.method.auto_exposure;
  of_scene.exposure_given = options.method.exposure_given;
  of_scene.emissive_lights = makes_emissive_lights(options.method);
  auto staged = session::stage_scene(of_scene);
  if (!staged) return tl::unexpected(staged.error());
  RenderPlan plan;
  plan.staged = std::make_shared<const session::StagedScene>(std::move(*staged));
  plan.viewpoint = session::viewpoint_of(*plan.staged, options.scene);
  auto frames = plan_frames(*plan.staged, options);
  if (!frames) return tl::unexpected(frames.error());
  plan.frames = std::move(*frames);
  plan.settings = render_settings(options.method, plan.staged->size, plan.staged->display);
  plan.settings = session::with_edits(std::move(plan.settings), options.scene.edits);
  plan.settings.mask_means = !options.mask_means.empty();
  plan.settings.error_maps = !options.error_maps.empty();
  plan.settings.linear_mean = options.pictures.are_exr();
  plan.settings.aovs = options.pictures.aovs;
  plan.settings.sample_masks = !options.mask_samples.empty();
  const int light = plan.settings.light;
  // Emissive meshes follow the scene's lights; the renderer, which finds them, checks their number.
  const bool emissive = plan.settings.area_lights.emissive_quads;
  const auto lights =
      check_light(*plan.staged, options.scene.edits, emissive ? -1 : light, plan.frames.front().time_s);
  if (!lights) return tl::unexpected(lights.error());
  plan.several_lights = light < 0 && (*lights > 1 || emissive);
  plan.lights = plan.several_lights ? std::max(*lights, 1) : 1;
  plan.of_several_frames = plan.frames.size() > 1;
  plan.frames = frames_of_chunk(plan.frames, options.chunk);
  return plan;
}

Expected<session::Session> open_session(const RenderPlan& plan, const RenderOptions& options) {
  return session::Session::open(plan.staged, options.scene.edits, options.raster);
}

Expected<int> check_light(const session::StagedScene& staged, const stage::SceneEdits& edits, int light,
                          double time_s) {
  const auto lights = stage::unmoved_lights(staged.scene, edits, staged.clip, time_s);
  const int count = static_cast<int>(lights.size());
  if (light >= count) return base::fail("--light: found {}, the scene has lights 0 to {}", light, count - 1);
  return count;
}

}  // namespace tenebra::viewer
