#include "render/antialias/settled_edges.h"

#include <algorithm>

#include "parallel/parallel.h"
#include "render/antialias/pixel_surfaces.h"

namespace tenebra::render {
namespace {

constexpr std::size_t pixels_a_task = 512, most_samples = 16;

/// Samples of a pixel that look the same.
struct Group {
  std::size_t surface;
  std::uint32_t from;  // a pixel of the frame
  std::uint32_t ids[most_samples];
  glm::vec2 places[most_samples];
  std::size_t count;
  glm::vec2 sum;  // of places

  /// The sample that is nearest to the mean place.
  std::size_t middle() const {
    const glm::vec2 mean = sum / static_cast<float>(count);
    std::size_t best = 0;
    for (std::size_t i = 1; i < count; ++i)
      if (apart(i, mean) < apart(best, mean)) best = i;
    return best;
  }

private:
  float apart(std::size_t i, glm::vec2 mean) const {
    const glm::vec2 d = places[i] - mean;
    return glm::dot(d, d);
  }
};

/// The result of a range of edges.
struct Part {
  std::vector<std::uint32_t> others, pixels;
  ShadingList listed;
};

class Settler {
public:
  Settler(const CentreMasks& centres, std::span<const glm::vec2> offsets, const visibility::PlaceIds& seen,
          const SurfaceMatch& match)
      : centres_(centres),
        offsets_(offsets),
        seen_(seen),
        match_(match),
        agreement_(centres, match_),
        surfaces_(match_) {}
  Settler(const Settler&) = delete;
  Settler& operator=(const Settler&) = delete;

  void add(std::uint32_t pixel, Part& part) {
    const auto columns = static_cast<std::uint32_t>(centres_.width);
    const std::uint32_t x = pixel % columns, y = pixel / columns;
    const glm::vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    if (!group(pixel, centre, seen_.of_pixel(static_cast<int>(x), static_cast<int>(y))))
      return part.others.push_back(pixel);
    const std::size_t number = part.pixels.size();
    part.pixels.push_back(pixel);
    part.listed.centres.push_back(as_centre_);
    for (std::size_t i = 0; i < count_; ++i) {
      const Group& of = groups_[i];
      const std::size_t middle = of.middle();
      part.listed.add(of.ids[middle], of.places[middle], of.from, number, static_cast<float>(of.count));
    }
  }

private:
  /// Returns false if a sample needs its own masks, or sees glass.
  bool group(std::uint32_t pixel, glm::vec2 centre, const visibility::PixelPlaces& sees) {
    const std::uint32_t centre_id = centres_.ids[pixel];
    if (centres_.has_glass(pixel)) return false;
    std::uint32_t ids[most_samples], from[most_samples];
    std::size_t known = 0;
    surfaces_.begin(centre_id);
    count_ = 0;
    as_centre_ = 0;
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      if (sees.layer(k) != no_triangle) return false;
      const std::uint32_t id = sees.id(k);
      const glm::vec2 place = centre + offsets_[k];
      const auto i = static_cast<std::size_t>(std::find(ids, ids + known, id) - ids);
      if (i == known) {
        ids[known] = id;
        from[known] = agreement_.find(id, pixel, place);
        if (from[known] == MaskAgreement::none) return false;
        if (from[known] == MaskAgreement::unlit) from[known] = pixel;
        ++known;
      }
      const std::size_t surface = surfaces_.of(id, place);
      if (surface == 0 && (id == no_triangle || agreement_.same_masks(from[i], pixel))) {
        as_centre_ += 1;
      } else {
        add_to_group(id, place, surface, from[i]);
      }
    }
    return true;
  }

  void add_to_group(std::uint32_t id, glm::vec2 place, std::size_t surface, std::uint32_t from) {
    const auto same = [&](const Group& group) {
      return group.surface == surface && (id == no_triangle || agreement_.same_masks(group.from, from));
    };
    std::size_t i = 0;
    while (i < count_ && !same(groups_[i])) ++i;
    if (i == count_) {
      groups_[i].surface = surface, groups_[i].from = from;
      groups_[i].count = 0, groups_[i].sum = glm::vec2(0.0f);
      ++count_;
    }
    Group& group = groups_[i];
    group.ids[group.count] = id;
    group.places[group.count++] = place;
    group.sum += place;
  }

  const CentreMasks& centres_;
  std::span<const glm::vec2> offsets_;
  const visibility::PlaceIds& seen_;
  SurfaceMatch match_;
  MaskAgreement agreement_;
  PixelSurfaces surfaces_;
  Group groups_[most_samples];
  std::size_t count_ = 0;
  float as_centre_ = 0;
};

}  // namespace

void settle_edges(std::span<const std::uint32_t> edges, const CentreMasks& centres,
                  std::span<const glm::vec2> offsets, const visibility::PlaceIds& seen,
                  const SurfaceMatch& match, SettledEdges& out) {
  std::vector<Part> parts((edges.size() + pixels_a_task - 1) / pixels_a_task);
  parallel::parallel_ranges(edges.size(), pixels_a_task, [&](std::size_t first, std::size_t last) {
    Settler settler(centres, offsets, seen, match);
    for (std::size_t i = first; i < last; ++i) settler.add(edges[i], parts[first / pixels_a_task]);
  });
  out.others.clear();
  out.pixels.clear();
  std::vector<float> as_centres;
  std::vector<ShadingList> lists(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Part& part = parts[i];
    for (std::uint32_t& number : part.listed.pixels) number += static_cast<std::uint32_t>(out.pixels.size());
    as_centres.insert(as_centres.end(), part.listed.centres.begin(), part.listed.centres.end());
    out.others.insert(out.others.end(), part.others.begin(), part.others.end());
    out.pixels.insert(out.pixels.end(), part.pixels.begin(), part.pixels.end());
    lists[i] = std::move(part.listed);
  }
  join(lists, out.listed);
  out.listed.centres = std::move(as_centres);
}

}  // namespace tenebra::render
