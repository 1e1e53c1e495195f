#include "ao/shade/bodies.h"

#include "base/fail.h"

#include <cmath>

namespace tenebra::ao {

void Bodies::reset(const SceneObjects& objects, double reach) {
  objects_ = &objects;
  reach_ = reach;
  bodies_.clear();
  at_.assign(objects.objects.size() + 1, -1);
}

void Bodies::make(std::int32_t object, Occluders& occluders) {
  constexpr double alike = 1e-3;
  int shape = -1;
  double reach = reach_;
  if (object != TriangleOwner::standing) {
    const MovingObject& rigid = objects_->objects[static_cast<std::size_t>(object)];
    shape = rigid.shape;
    reach /= rigid.scale;
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = bodies_[b];
    if (body.shape != shape || std::abs(body.samples->reach() - reach) > alike * reach) continue;
    at_[index(object)] = static_cast<int>(b);
    return;
  }
  const ObjectShape& geometry =
      shape < 0 ? objects_->standing : objects_->shapes[static_cast<std::size_t>(shape)];
  at_[index(object)] = static_cast<int>(bodies_.size());
  bodies_.push_back({shape, std::make_unique<SelfOcclusion>(geometry, occluders.casters(shape), reach)});
}

Expected<void> Bodies::fill(std::span<const MissingSample> missing, const AoKernels& kernels,
                            const AoProgress& progress, const StopFlag* stop) {
  for (std::size_t first = 0, last = 0; first < missing.size(); first = last) {
    std::vector<std::uint64_t> of_body;
    const std::uint32_t body = missing[first].body;
    for (; last < missing.size() && missing[last].body == body; ++last)
      of_body.push_back(missing[last].sample);
    const auto report = [&](double done) {
      if (progress)
        progress("surface samples",
                 (static_cast<double>(first) + done * static_cast<double>(of_body.size())) /
                     static_cast<double>(missing.size()));
    };
    if (!bodies_[body].samples->fill(of_body, kernels, report, stop)) return base::fail("stopped");
  }
  return {};
}

std::uint64_t Bodies::filled() const {
  std::uint64_t samples = 0;
  for (const Body& body : bodies_) samples += body.samples->filled();
  return samples;
}

}  // namespace tenebra::ao
