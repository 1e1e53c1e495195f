#include "bench/picture/picture_maker.h"

#include "bench/common/bench_frame.h"
#include "cutout/cutout.h"
#include "scene/looks.h"

namespace tenebra::bench {

Expected<Scene> load_picture_scene(const std::filesystem::path& file,
                                   const std::vector<std::string>& no_cast) {
  auto scene = load_scene(file, no_cast);
  if (!scene) return scene;
  cutout::cut_out_masks(*scene);
  scene::leave_out_blank_emission(*scene);
  return scene;
}

Expected<PictureMaker> PictureMaker::create(const PictureTask& task) {
  auto raster = render::FrameRaster::create(render::RasterChoice{});  // as tenebra render chooses
  if (!raster) return tl::unexpected(raster.error());
  return PictureMaker(task, render::Renderer::create(std::move(*raster), task.scene));
}

void PictureMaker::evaluate(int frame) {
  const Scene& scene = task_.scene;
  const int clip = scene.clips.empty() ? -1 : 0;
  const double time_s = scene.clips.empty() ? 0 : frame_time_s(scene.clips[0], frame, 30.0);
  evaluate_frame(scene, clip, time_s, input_.geometry);
  input_.lights = evaluate_lights(scene, clip, time_s);
  input_.view = evaluate_camera(scene, clip, time_s, 0, task_.width, task_.height);
}

Expected<const base::Image8*> PictureMaker::draw(const Sampling& sampling, const glm::dvec2& shift) {
  render::RenderSettings settings{.width = task_.width, .height = task_.height, .threads = task_.threads};
  settings.terminator = render::Terminator::smooth;
  settings.antialias = sampling.samples;
  settings.antialias_everywhere = sampling.everywhere;
  const ViewRays seen = input_.view;
  const glm::dvec3 across = shift.x * glm::dvec3(seen.dx) + shift.y * glm::dvec3(seen.dy);
  glm::vec3& from = seen.orthographic ? input_.view.eye : input_.view.d0;
  from = glm::vec3(glm::dvec3(from) + across);
  const auto drawn = renderer_.render_frame(input_, settings, result_);
  input_.view = seen;
  if (!drawn) return tl::unexpected(drawn.error());
  return &result_.image;
}

}  // namespace tenebra::bench
