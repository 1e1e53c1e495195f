#include "render/antialias/borrowed_light.h"

#include "parallel/parallel.h"
#include "points/sample_points.h"

namespace tenebra::render {
namespace {

constexpr std::uint32_t first_own = std::uint32_t{1} << 31;  // values of from_ below it are pixels

}  // namespace

void BorrowedLight::find_nearest_centres(const SampleStages& stages, const SamplePicture& samples) {
  const visibility::VisibleIds& seen = stages.centres.seen;
  const int width = seen.width, height = seen.height;
  const SurfaceMatch match = stages.surface_match();
  from_.assign(samples.grid.pixels(), 0);
  parallel::parallel_ranges(samples.count, 4096, [&](std::size_t first, std::size_t last) {
    SurfaceMatch own_match(match);
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t slot = samples.slots[i];
      const std::uint32_t pixel = samples.pixels[slot], id = samples.ids[slot];
      const int x = static_cast<int>(pixel) % width, y = static_cast<int>(pixel) / width;
      from_[slot] = first_own;
      float nearest = 1e9f;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= height) continue;
          const auto next = static_cast<std::uint32_t>((y + dy) * width + x + dx);
          const glm::vec2 apart =
              glm::vec2(static_cast<float>(x + dx) + 0.5f, static_cast<float>(y + dy) + 0.5f) -
              samples.places[slot];
          const float distance = next == pixel ? 0.0f : glm::dot(apart, apart);
          if (distance >= nearest || !own_match.same(id, seen.ids[next], samples.places[slot])) continue;
          nearest = distance;
          from_[slot] = next;
        }
      }
    }
  });
}

void BorrowedLight::choose(const SampleStages& stages, const SamplePicture& samples) {
  find_nearest_centres(stages, samples);
  SurfaceMatch match = stages.surface_match();
  own_slots_.clear();
  for (std::size_t i = 0; i < samples.count; ++i) {
    const std::size_t slot = samples.slots[i];
    if (from_[slot] != first_own) continue;
    const std::size_t of_pixel = i / samples.per_pixel * samples.per_pixel;
    for (std::size_t k = of_pixel; k < i && from_[slot] == first_own; ++k) {
      const std::size_t other = samples.slots[k];
      if (from_[other] > first_own && match.same(samples.ids[slot], samples.ids[other], samples.places[slot]))
        from_[slot] = from_[other];
    }
    if (from_[slot] != first_own) continue;
    own_slots_.push_back(static_cast<std::uint32_t>(slot));
    from_[slot] = first_own + static_cast<std::uint32_t>(own_slots_.size());
  }
}

template <class Values>
auto BorrowedLight::value(const Values& of_centres, const Values& own, std::size_t slot) const {
  const std::uint32_t from = from_[slot];
  return from < first_own ? of_centres[from]
                          : own[points::SampleGrid(own_slots_.size()).pixel(from - first_own - 1)];
}

template <class Values>
void BorrowedLight::gather(const SamplePicture& samples, const Values& of_centres, Values& own,
                           Values& out) const {
  out.resize(from_.size());
  for (std::size_t i = 0; i < from_.size(); ++i)
    out[i] = samples.ids[i] == no_triangle ? 0.0f : value(of_centres, own, i);
}

Expected<void> BorrowedLight::add(const SampleStages& stages, const SamplePicture& samples, LitSamples& at) {
  const Frame& frame = stages.frame;
  const LitSamples& centres = stages.centres.lit;
  choose(stages, samples);
  points::take_points(at.points, own_slots_, own_.points);
  compute_shading_normals(own_.points, frame.input.geometry.normals, frame.triangles(), own_.normals);
  if (auto lit = stages.lighter.light(frame, LightKinds::areas, own_); !lit) return lit;
  for (std::size_t i = 0; i < frame.lights.size(); ++i) {
    if (!frame.lights[i].area) continue;
    const SampleLight& of_centres = centres.lights[i];
    SampleLight &own = own_.lights[i], &out = at.lights[i];
    gather(samples, of_centres.soft.irradiance, own.soft.irradiance, out.soft.irradiance);
    gather(samples, of_centres.soft.visible_fraction, own.soft.visible_fraction, out.soft.visible_fraction);
    if (!frame.has_glass()) continue;
    for (std::uint32_t slot = 0; slot < from_.size(); ++slot) {
      if (samples.ids[slot] == no_triangle) continue;
      const glm::vec3 factor = value(of_centres.tint.factors().factors, own.tint.factors().factors, slot);
      if (factor == glm::vec3(1.0f)) continue;
      out.tint.mask.pixels.push_back(slot);
      out.tint.mask.factors.push_back(factor);
    }
    out.tint.spread();
  }
  if (frame.has_occlusion()) gather(samples, centres.openness, own_.openness, at.openness);
  return {};
}

}  // namespace tenebra::render
