#include "ao/presampled/bodies.h"

#include <algorithm>
#include <cmath>

#include "base/fail.h"
#include "base/sort_unique.h"
#include "parallel/parallel.h"

namespace tenebra::ao {

void Bodies::reset(const SceneObjects& objects, double reach) {
  save_all([&](const Body& body) { return body.made < frame_; });
  objects_ = &objects;
  reach_ = reach;
  bodies_.clear();
  at_.assign(objects.objects.size() + 1, -1);
}

void Bodies::begin_frame(std::uint64_t frame, const std::filesystem::path& cache) {
  frame_ = frame;
  const bool elsewhere = cache != cache_;
  cache_ = cache;
  for (Body& body : bodies_) {
    body.samples->begin_frame();
    if (elsewhere) body.saved = 0;
  }
}

/// The number of the object's body; a new one has no samples yet. -1: a stop was requested.
int Bodies::body_of(std::int32_t object, Casters& casters) {
  constexpr double alike = 1e-3;
  int& number = at_[index(object)];
  if (number >= 0) return number;
  int shape = -1;
  double reach = reach_;
  if (object != TriangleOwner::standing) {
    const MovingObject& rigid = objects_->objects[static_cast<std::size_t>(object)];
    shape = rigid.shape;
    reach /= double{static_cast<float>(rigid.scale)};  // in float, the same at every instant
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = bodies_[b];
    if (body.shape != shape || std::abs(body.samples->reach() - reach) > alike * reach) continue;
    return number = static_cast<int>(b);
  }
  const ObjectShape& geometry =
      shape < 0 ? objects_->standing : objects_->shapes[static_cast<std::size_t>(shape)];
  const trees::TriangleBvh* tree = shape < 0 ? casters.standing_tree() : casters.shape_tree(shape);
  if (tree == nullptr) return -1;
  Body body;  // added once it is whole: memory may run out before
  body.shape = shape;
  body.made = frame_;
  body.key = sample_key(geometry, reach);
  body.samples = std::make_unique<SelfOcclusion>(geometry, *tree, reach, SelfOcclusion::most_cells, budget_);
  bodies_.push_back(std::move(body));
  return number = static_cast<int>(bodies_.size()) - 1;
}

void Bodies::make(std::span<const int> objects, Casters& casters, const StopFlag* stop) {
  std::vector<int> chosen;
  for (const int object : objects) {
    const int body = body_of(object, casters);
    if (body < 0) return;
    chosen.push_back(body);
  }
  base::sort_unique(chosen);
  for (const int number : chosen) use(number);
  parallel::parallel_tasks(static_cast<int>(chosen.size()), [&](int i) {
    bodies_[static_cast<std::size_t>(chosen[static_cast<std::size_t>(i)])].samples->prepare(stop);
  });
  std::erase_if(chosen, [&](int number) {
    SelfOcclusion& samples = *bodies_[static_cast<std::size_t>(number)].samples;
    return samples.ready() || !samples.lay(stop);
  });
  if (!cache_.empty() && !stop_requested(stop)) load(chosen);
}

/// Those that are on disk, many at once.
void Bodies::load(std::span<const int> bodies) {
  std::vector<std::uint8_t> there(bodies.size());  // before it is read: others may write it just then
  std::vector<Expected<SurfaceSamples>> found(bodies.size());
  const auto body_at = [&](std::size_t i) -> Body& { return bodies_[static_cast<std::size_t>(bodies[i])]; };
  parallel::parallel_tasks(static_cast<int>(bodies.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const Body& body = body_at(at);
    there[at] = cache_file_exists(sample_path(cache_, body.key));
    found[at] = load_samples(cache_, body.key, body.samples->layout_samples());
  });
  for (std::size_t i = 0; i < found.size(); ++i) {
    Body& body = body_at(i);
    if (found[i]) {
      body.samples->learn(*found[i]);
      body.saved = body.samples->known();
    } else if (there[i]) {
      notes_.push_back(found[i].error().message + "; they are made anew");
    }
  }
}

void Bodies::save(Body& body) {
  const auto saved = save_samples(cache_, body.key, body.samples->samples(), body.samples->layout_samples());
  if (!saved && !unwritten_) notes_.push_back(saved.error().message);
  unwritten_ |= !saved;
  body.saved = body.samples->known();
}

void Bodies::save_grown() {
  if (cache_.empty()) return;
  for (Body& body : bodies_) {
    const std::uint64_t known = body.samples->known();
    if (body.made < frame_ && 2 * known > 3 * body.saved) save(body);
  }
}

void Bodies::save_all(const std::function<bool(const Body&)>& chosen) {
  if (cache_.empty()) return;
  for (Body& body : bodies_)
    if (body.samples->known() > body.saved && chosen(body)) save(body);
}

Expected<void> Bodies::fill(std::span<const MissingSample> missing, const RayKernels& kernels,
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
    if (!bodies_[body].samples->fill(of_body, kernels, report, stop)) return base::stopped();
  }
  return {};
}

std::vector<Bodies::Body>::const_iterator Bodies::find_oldest() const {
  auto oldest = bodies_.end();
  for (auto body = bodies_.begin(); body != bodies_.end(); ++body) {
    if (!body->samples->laid() || body->used == frame_) continue;
    if (oldest == bodies_.end() || body->last_use() < oldest->last_use()) oldest = body;
  }
  return oldest;
}

std::optional<LastUse> Bodies::oldest() const {
  const auto body = find_oldest();
  return body == bodies_.end() ? std::nullopt : std::optional(body->last_use());
}

void Bodies::drop_oldest() {
  Body& body = bodies_[static_cast<std::size_t>(find_oldest() - bodies_.begin())];
  if (!cache_.empty() && body.samples->known() > body.saved) save(body);
  body.samples->drop();
  body.saved = 0;
}

std::uint64_t Bodies::filled() const {
  std::uint64_t samples = 0;
  for (const Body& body : bodies_) samples += body.samples->filled();
  return samples;
}

std::uint64_t Bodies::known() const {
  std::uint64_t samples = 0;
  for (const Body& body : bodies_) samples += body.samples->known();
  return samples;
}

std::size_t Bodies::bytes() const {
  std::size_t bytes = 0;
  for (const Body& body : bodies_) bytes += body.samples->bytes();
  return bytes;
}

}  // namespace tenebra::ao
