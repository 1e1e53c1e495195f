#include "render/antialias/shading_list.h"

#include <algorithm>
#include <array>

#include "parallel/parallel.h"
#include "render/antialias/pixel_surfaces.h"

namespace tenebra::render {
namespace {

constexpr std::size_t pixels_a_part = 1024, most_groups = 16;

/// Samples of a pixel that look the same.
struct SurfaceGroup {
  std::size_t surface;  // of PixelSurfaces
  std::size_t slots[most_groups];
  std::size_t count = 0;
  glm::vec2 sum{0.0f};  // of places
};

class PixelGroups {
public:
  PixelGroups(const SamplePicture& samples, const SampleLights& lit) : samples_(samples), lit_(lit) {}

  void clear() { count_ = 0; }
  void add(std::size_t slot, std::size_t surface) {
    std::size_t i = 0;
    while (i < count_ && !(groups_[i].surface == surface && lit_.same(groups_[i].slots[0], lit_, slot))) ++i;
    if (i == count_) groups_[count_++] = {surface, {}, 0, glm::vec2(0.0f)};
    SurfaceGroup& group = groups_[i];
    group.slots[group.count++] = slot;
    group.sum += samples_.places[slot];
  }
  std::span<const SurfaceGroup> all() const { return {groups_.data(), count_}; }

private:
  const SamplePicture& samples_;
  const SampleLights& lit_;
  std::array<SurfaceGroup, most_groups> groups_;
  std::size_t count_ = 0;
};

std::size_t middle_of(const SurfaceGroup& group, const SamplePicture& samples) {
  const glm::vec2 mean = group.sum / static_cast<float>(group.count);
  const auto apart = [&](std::size_t slot) {
    const glm::vec2 d = samples.places[slot] - mean;
    return glm::dot(d, d);
  };
  return *std::min_element(group.slots, group.slots + group.count,
                           [&](std::size_t a, std::size_t b) { return apart(a) < apart(b); });
}

}  // namespace

void join(std::span<const ShadingList> parts, ShadingList& to) {
  std::vector<std::size_t> firsts(parts.size() + 1, 0);
  for (std::size_t i = 0; i < parts.size(); ++i) firsts[i + 1] = firsts[i] + parts[i].ids.size();
  to.resize(firsts.back());
  parallel::parallel_tasks(static_cast<int>(parts.size()), [&](int number) {
    const auto i = static_cast<std::size_t>(number);
    const auto put = [&](const auto& list, auto& out) {
      std::copy(list.begin(), list.end(), out.begin() + static_cast<std::ptrdiff_t>(firsts[i]));
    };
    put(parts[i].ids, to.ids);
    put(parts[i].places, to.places);
    put(parts[i].from, to.from);
    put(parts[i].pixels, to.pixels);
    put(parts[i].shares, to.shares);
  });
}

bool SampleLights::same(std::size_t a, const SampleLights& other, std::size_t b) const {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!lights[i].mask.empty() && lights[i].mask[a] != other.lights[i].mask[b]) return false;
    if (!lights[i].irradiance.empty() && lights[i].irradiance[a] != other.lights[i].irradiance[b])
      return false;
    const auto tint = lights[i].tint.factors, other_tint = other.lights[i].tint.factors;
    if (!tint.empty() && tint[a] != other_tint[b]) return false;
  }
  return openness.empty() || openness[a] == other.openness[b];
}

void list_groups(std::span<const std::uint32_t> chosen, const SamplePicture& samples, const SampleLights& lit,
                 const CentreSamples& centres, const SurfaceMatch& match, ShadingList& out) {
  out.clear();
  out.centres.assign(chosen.size(), 0.0f);
  const std::size_t parts = (chosen.size() + pixels_a_part - 1) / pixels_a_part;
  std::vector<ShadingList> lists(parts);
  parallel::parallel_ranges(chosen.size(), pixels_a_part, [&](std::size_t first, std::size_t last) {
    ShadingList& list = lists[first / pixels_a_part];
    PixelGroups groups(samples, lit);
    SurfaceMatch own_match(match);
    PixelSurfaces surfaces(own_match);
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t pixel = chosen[i];
      groups.clear();
      surfaces.begin(centres.ids[pixel]);
      for (std::size_t k = 0; k < samples.per_pixel; ++k) {
        const std::size_t slot = samples.slots[i * samples.per_pixel + k];
        if (samples.has_layer(slot)) {
          list.add(samples.ids[slot], samples.places[slot], slot, i, 1.0f);
          continue;
        }
        const std::size_t surface = surfaces.of(samples.ids[slot], samples.places[slot]);
        if (surface == 0 && !centres.has_layer(pixel) && lit.same(slot, centres.lit, pixel)) {
          out.centres[i] += 1;
        } else {
          groups.add(slot, surface);
        }
      }
      for (const SurfaceGroup& group : groups.all()) {
        const std::size_t slot = middle_of(group, samples);
        list.add(samples.ids[slot], samples.places[slot], slot, i, static_cast<float>(group.count));
      }
    }
  });
  join(lists, out);
}

void list_samples(std::span<const std::uint32_t> chosen, const SamplePicture& samples, ShadingList& out) {
  out.centres.assign(chosen.size(), 0.0f);
  out.resize(samples.count);
  parallel::parallel_ranges(samples.count, pixels_a_part, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t slot = samples.slots[i];
      out.set(i, samples.ids[slot], samples.places[slot], slot, i / samples.per_pixel, 1.0f);
    }
  });
}

void list_as_centres(std::span<const std::uint32_t> chosen, int width, const StandIns& stand_ins,
                     std::span<const std::uint32_t> centre_ids, const visibility::PlaceIds& seen,
                     ShadingList& out) {
  const std::span<const glm::vec2> offsets = stand_ins.offsets, places = stand_ins.places;
  const float centre_counts = stand_ins.centre_counts;
  const std::size_t count = places.size();
  std::vector<std::size_t> nearest;  // sample of each place; offsets.size(): the centre
  for (const glm::vec2 place : places) {
    const auto apart = [&](glm::vec2 offset) { return glm::dot(place - offset, place - offset); };
    std::size_t best = offsets.size();
    for (std::size_t k = 0; k < offsets.size(); ++k)
      if (apart(offsets[k]) < (best == offsets.size() ? apart({}) : apart(offsets[best]))) best = k;
    nearest.push_back(best);
  }
  out.centres.assign(chosen.size(), -centre_counts);
  const float share = (static_cast<float>(offsets.size()) + centre_counts) / static_cast<float>(count);
  const auto columns = static_cast<std::uint32_t>(width);
  out.resize(chosen.size() * count);
  parallel::parallel_ranges(chosen.size(), pixels_a_part, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t pixel = chosen[i];
      const glm::vec2 centre(static_cast<float>(pixel % columns) + 0.5f,
                             static_cast<float>(pixel / columns) + 0.5f);
      const visibility::PixelPlaces sees =
          seen.of_pixel(static_cast<int>(pixel % columns), static_cast<int>(pixel / columns));
      for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t id = nearest[k] == offsets.size() ? centre_ids[pixel] : sees.id(nearest[k]);
        out.set(i * count + k, id, centre + places[k], pixel, i, share);
      }
    }
  });
}

}  // namespace tenebra::render
