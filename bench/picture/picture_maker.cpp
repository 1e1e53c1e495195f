#include "bench/picture/picture_maker.h"

#include "bench/common/bench_frame.h"
#include "stage/cutout/cutout.h"
#include "stage/looks.h"

namespace tenebra::bench {

Expected<Scene> load_picture_scene(const std::filesystem::path& file,
                                   const std::vector<std::string>& no_cast) {
  auto scene = load_scene(file, no_cast);
  if (!scene) return scene;
  stage::cut_out_masks(*scene);
  stage::leave_out_blank_emission(*scene);
  return scene;
}

Expected<PictureMaker> PictureMaker::create(const DrawTask& task) {
  auto renderer = SceneRenderer::create(task);
  if (!renderer) return tl::unexpected(renderer.error());
  return PictureMaker(std::move(*renderer));
}

Expected<const io::Image8*> PictureMaker::draw(const Sampling& sampling, const glm::dvec2& shift) {
  render::RenderSettings settings = renderer_.settings();
  settings.terminator = render::Terminator::smooth;
  settings.antialias = sampling.samples;
  settings.antialias_everywhere = sampling.everywhere;
  ViewRays& view = renderer_.input().view;
  const ViewRays seen = view;
  const glm::dvec3 across = shift.x * glm::dvec3(seen.dx) + shift.y * glm::dvec3(seen.dy);
  glm::vec3& from = seen.orthographic ? view.eye : view.d0;
  from = glm::vec3(glm::dvec3(from) + across);
  const auto drawn = renderer_.draw(settings);
  view = seen;
  if (!drawn) return tl::unexpected(drawn.error());
  return &(*drawn)->image;
}

}  // namespace tenebra::bench
