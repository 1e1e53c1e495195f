#include "window/frames/explainer.h"

#include <algorithm>

#include <tenebra/tint.h>

#include "session/session.h"
#include "window/frames/within_memory.h"

namespace tenebra::viewer {
namespace {

TriangleCorners corners_of(const FrameGeometry& geometry, std::uint32_t triangle) {
  const glm::uvec3 t = geometry.triangles[triangle];
  return {geometry.positions[t.x], geometry.positions[t.y], geometry.positions[t.z]};
}

/// The triangles of a picture, evaluated again; kept for the next question about the same.
class PictureGeometry {
public:
  const FrameGeometry& of(const Picture& picture) {
    const PictureEvidence& e = picture.evidence;
    const SeeThrough see_through = e.settings.see_through;
    const bool same = scene_ == picture.scene && clip_ == e.clip && time_s_ == e.time_s &&
                      nodes_ == e.edits.nodes && see_through_ == see_through;
    if (same) return input_.geometry;
    session::evaluate(picture.scene->scene, e.edits, e.clip, e.time_s, input_);
    FrameGeometry& geometry = input_.geometry;
    if (see_through != SeeThrough::tint && !geometry.see_through.empty())
      cast_see_through(see_through, geometry);
    scene_ = picture.scene;
    clip_ = e.clip;
    time_s_ = e.time_s;
    nodes_ = e.edits.nodes;
    see_through_ = see_through;
    return geometry;
  }

private:
  std::shared_ptr<const session::StagedScene> scene_;
  int clip_ = -1;
  double time_s_ = 0;
  std::map<int, stage::NodeEdit> nodes_;
  SeeThrough see_through_ = SeeThrough::tint;
  render::FrameInput input_;
};

std::vector<render::DrawnLight> lights_of(const sun::Suns& suns) {
  std::vector<render::DrawnLight> lights;
  for (const sun::Sun& sun : suns.list) {
    render::DrawnLight& light = lights.emplace_back();
    light.light.type = LightType::directional;
    light.placed.direction = glm::vec3(-sun.to_sun);
  }
  return lights;
}

PictureAnswer answer(PictureQuestion question, PictureGeometry& geometries) {
  const Picture& picture = *question.picture;
  const PictureEvidence& evidence = picture.evidence;
  const FrameGeometry& geometry = geometries.of(picture);
  const auto explained = [&](std::span<const render::DrawnLight> lights) {
    return render::explain_pixel({picture.scene->scene, geometry, picture.view, evidence.ids,
                                  picture.a.result.image.width, lights, evidence.fractions, evidence.settings,
                                  question.pixel});
  };
  PictureAnswer out;
  const bool explains = question.kind == QuestionKind::explain;
  out.pixel = explained(explains ? std::span(evidence.lights) : std::span<const render::DrawnLight>());
  if (explains && question.suns) out.day = explained(lights_of(*question.suns)).lights;
  if (!out.pixel.background) out.seen = corners_of(geometry, out.pixel.seen.triangle);
  for (const render::LightExplanation& light : out.pixel.lights)
    out.occluders.push_back(light.occluder ? corners_of(geometry, light.occluder->triangle)
                                           : TriangleCorners{});
  out.ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - question.asked).count();
  out.question = std::move(question);
  return out;
}

}  // namespace

Explainer::Explainer(std::function<void()> wake) : wake_(std::move(wake)), thread_([this] { run(); }) {}

Explainer::~Explainer() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Explainer::ask(PictureQuestion question) {
  const std::lock_guard lock(mutex_);
  std::erase_if(questions_, [&](const PictureQuestion& old) { return old.kind == question.kind; });
  questions_.push_back(std::move(question));
  changed_.notify_all();
}

std::vector<Expected<PictureAnswer>> Explainer::take_answers() {
  const std::lock_guard lock(mutex_);
  return std::exchange(answers_, {});
}

void Explainer::run() {
  PictureGeometry geometries;
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return quit_ || !questions_.empty(); });
    if (quit_) return;
    PictureQuestion question = std::move(questions_.front());
    questions_.erase(questions_.begin());
    lock.unlock();
    auto answered =
        within_memory([&]() -> Expected<PictureAnswer> { return answer(std::move(question), geometries); },
                      [&] { geometries = {}; });
    lock.lock();
    answers_.push_back(std::move(answered));
    lock.unlock();
    wake_();
    lock.lock();
  }
}

}  // namespace tenebra::viewer
