#include "render/antialias/edge_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "parallel/parallel.h"
#include "points/sample_points.h"
#include "render/antialias/pixel_surfaces.h"

namespace tenebra::render {
namespace {

constexpr std::size_t pixels_a_task = 1024, alike_pixels = 32;

/// A pixel, and the centres around it that the picture has, by place: 4 is its own.
class Around {
public:
  Around(const CentreShadows& centres, std::uint32_t pixel)
      : width_(centres.width),
        x_(static_cast<int>(pixel) % width_),
        y_(static_cast<int>(pixel) / width_),
        left_(x_ > 0 ? -1 : 0),
        right_(x_ + 1 < width_ ? 1 : 0),
        top_(y_ > 0 ? -1 : 0),
        bottom_(y_ + 1 < centres.height ? 1 : 0) {}

  int x() const { return x_; }
  int y() const { return y_; }
  glm::vec2 centre() const { return {static_cast<float>(x_) + 0.5f, static_cast<float>(y_) + 0.5f}; }
  static int place(int dx, int dy) { return 4 + 3 * dy + dx; }
  static glm::vec2 offset(int place) {
    return {static_cast<float>(place % 3 - 1), static_cast<float>(place / 3 - 1)};
  }
  template <class Act>
  void for_each(Act act) const {
    for (int dy = top_; dy <= bottom_; ++dy)
      for (int dx = left_; dx <= right_; ++dx)
        act(place(dx, dy), static_cast<std::size_t>((y_ + dy) * width_ + x_ + dx));
  }

private:
  int width_, x_, y_, left_, right_, top_, bottom_;
};

/// What a range of pixels gives.
struct Part {
  std::vector<EdgeSamples::Own> own, later;

  /// Sixteen points that follow each other are a tile: of a few pixels, those that see what their centre sees
  /// come first.
  void end_alike() {
    own.insert(own.end(), later.begin(), later.end());
    later.clear();
  }
};

/// The samples of one pixel.
struct Samples {
  Samples(const EdgeTask& task, std::size_t number)
      : pixel(task.pixels[number]),
        around(task.centres, pixel),
        sees(task.seen.of_pixel(around.x(), around.y())),
        first(number * task.offsets.size()) {}

  void ask(const EdgeTask& task, std::size_t k, Part& part) const {
    const std::uint32_t id = sees.id(k);
    (id == task.centres.ids[pixel] ? part.own : part.later)
        .push_back({static_cast<std::uint32_t>(first + k), id, around.centre() + task.offsets[k]});
  }

  std::uint32_t pixel;
  Around around;
  visibility::PixelPlaces sees;
  std::size_t first;  // number of its first sample
};

class Finder {
public:
  Finder(const EdgeTask& task, EdgeSamples& out, Part& part)
      : task_(task),
        out_(out),
        part_(part),
        match_(task.match),
        surfaces_(match_),
        has_masks_(std::any_of(task.centres.masks.begin(), task.centres.masks.end(),
                               [](const std::uint8_t* mask) { return mask != nullptr; })) {}
  Finder(const Finder&) = delete;
  Finder& operator=(const Finder&) = delete;

  void add(std::size_t number) {
    const Samples samples(task_, number);
    const Around& around = samples.around;
    surfaces_.begin(task_.centres.ids[samples.pixel]);
    std::fill_n(samples_of_, PixelSurfaces::most, 0u);
    std::uint32_t met = 0, last_id = task_.centres.ids[samples.pixel];
    std::size_t surface = 0;  // of last_id
    const auto look = [&](std::uint32_t id, glm::vec2 place) {
      if (id != last_id) surface = surfaces_.of(last_id = id, place);
    };
    for (std::size_t k = 0; k < out_.per_pixel; ++k) {
      look(samples.sees.id(k), around.centre() + task_.offsets[k]);
      out_.surfaces[samples.first + k] = static_cast<std::uint8_t>(surface);
      samples_of_[surface] |= 1u << k;
      met |= 1u << surface;
    }
    if (!has_masks_) return;
    std::fill_n(surface_at_, 9, none);
    around.for_each([&](int place, std::size_t next) {
      look(task_.centres.ids[next], around.centre());
      surface_at_[place] = surface;
      lit_at_[place] = task_.centres.lit(next);
    });
    for (; met != 0; met &= met - 1) light(samples, static_cast<std::size_t>(std::countr_zero(met)));
  }

private:
  static constexpr std::size_t none = ~std::size_t{0};

  /// The samples that see a surface.
  void light(const Samples& of, std::size_t surface) {
    if (surfaces_.first_id(surface) == no_triangle) return;
    int seeing = 0, first = 0;
    bool agree = true;
    for (int place = 0; place < 9; ++place) {
      if (surface_at_[place] != surface) continue;
      if (seeing++ == 0) first = place;
      agree = agree && lit_at_[place] == lit_at_[first];
    }
    const bool all_alike = seeing >= 2 && agree;
    for (std::uint32_t samples = samples_of_[surface]; samples != 0; samples &= samples - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(samples));
      if (all_alike || is_between(surface, task_.offsets[k])) {
        out_.lit[of.first + k] = lit_at_[all_alike ? first : 4];
      } else {
        of.ask(task_, k, part_);
      }
    }
  }

  /// Whether a place lies in a triangle between its pixel's centre and two others that all see a surface in
  /// the same light.
  bool is_between(std::size_t surface, glm::vec2 offset) const {
    const int dx = offset.x < 0 ? -1 : 1, dy = offset.y < 0 ? -1 : 1;
    const auto as_here = [&](int place) {
      return surface_at_[place] == surface && lit_at_[place] == lit_at_[4];
    };
    if (surface_at_[4] != surface) return false;
    const bool beside = as_here(Around::place(dx, 0)), below = as_here(Around::place(0, dy));
    if (beside && below) return true;
    if (!as_here(Around::place(dx, dy))) return false;
    return std::abs(offset.x) >= std::abs(offset.y) ? beside : below;
  }

  const EdgeTask& task_;
  EdgeSamples& out_;
  Part& part_;
  SurfaceMatch match_;
  PixelSurfaces surfaces_;
  bool has_masks_;
  std::uint32_t samples_of_[PixelSurfaces::most];
  std::size_t surface_at_[9];
  LitBits lit_at_[9];
};

void join(const std::vector<Part>& parts, EdgeSamples& out) {
  out.own.clear();
  for (const Part& part : parts) out.own.insert(out.own.end(), part.own.begin(), part.own.end());
}

/// Samples of a pixel that look the same.
struct Group {
  std::uint8_t surface;
  LitBits lit;
  std::uint32_t samples;  // bits
  glm::vec2 sum;          // of offsets

  /// The sample that is nearest to the mean place.
  std::size_t middle(std::span<const glm::vec2> offsets) const {
    const glm::vec2 mean = sum / static_cast<float>(std::popcount(samples));
    std::size_t best = 0;
    float least = 9;
    for (std::uint32_t left = samples; left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      const glm::vec2 d = offsets[k] - mean;
      if (glm::dot(d, d) < least) least = glm::dot(d, d), best = k;
    }
    return best;
  }
};

/// Lists one pixel.
void list_pixel(const EdgeTask& task, const EdgeSamples& samples, std::size_t number, ShadingList& list,
                float& as_centre) {
  const Samples of(task, number);
  const LitBits lit_here = task.centres.lit(of.pixel);
  Group groups[PixelSurfaces::most];
  std::size_t count = 0;
  for (std::size_t k = 0; k < samples.per_pixel; ++k) {
    const std::uint8_t surface = samples.surfaces[of.first + k];
    const LitBits lit = samples.lit[of.first + k];
    if (surface == 0 && lit == lit_here) {
      as_centre += 1;
      continue;
    }
    std::size_t i = 0;
    while (i < count && (groups[i].surface != surface || groups[i].lit != lit)) ++i;
    if (i == count) groups[count++] = {surface, lit, 0, glm::vec2(0.0f)};
    groups[i].samples |= 1u << k;
    groups[i].sum += task.offsets[k];
  }
  for (const Group& group : std::span(groups, count)) {
    const std::size_t k = group.middle(task.offsets);
    list.add(of.sees.id(k), of.around.centre() + task.offsets[k], group.lit, number,
             static_cast<float>(std::popcount(group.samples)));
  }
}

}  // namespace

void find_edge_samples(const EdgeTask& task, EdgeSamples& out) {
  out.per_pixel = task.offsets.size();
  out.surfaces.resize(task.pixels.size() * out.per_pixel);
  out.lit.assign(task.pixels.size() * out.per_pixel, 0);
  std::vector<Part> parts((task.pixels.size() + pixels_a_task - 1) / pixels_a_task);
  parallel::parallel_ranges(task.pixels.size(), pixels_a_task, [&](std::size_t first, std::size_t last) {
    Part& part = parts[first / pixels_a_task];
    Finder finder(task, out, part);
    for (std::size_t i = first; i < last; ++i) {
      finder.add(i);
      if ((i + 1) % alike_pixels == 0 || i + 1 == last) part.end_alike();
    }
  });
  join(parts, out);
}

void place_own(std::span<const EdgeSamples::Own> own, std::vector<std::uint32_t>& ids,
               std::vector<glm::vec2>& places) {
  const points::SampleGrid grid(own.size());
  ids.assign(grid.pixels(), no_triangle);
  places.resize(grid.pixels());
  parallel::parallel_ranges(own.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      ids[grid.pixel(i)] = own[i].id;
      places[grid.pixel(i)] = own[i].place;
    }
  });
}

void list_edges(const EdgeTask& task, const EdgeSamples& samples, ShadingList& out) {
  std::vector<ShadingList> lists((task.pixels.size() + pixels_a_task - 1) / pixels_a_task);
  out.centres.assign(task.pixels.size(), 0.0f);
  parallel::parallel_ranges(task.pixels.size(), pixels_a_task, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      list_pixel(task, samples, i, lists[first / pixels_a_task], out.centres[i]);
  });
  join(lists, out);
}

std::size_t part_by_glass(const EdgeTask& task, std::vector<std::uint32_t>& pixels) {
  std::vector<std::uint8_t> has_glass(pixels.size());
  parallel::parallel_ranges(pixels.size(), pixels_a_task, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Around around(task.centres, pixels[i]);
      bool any = false;
      around.for_each([&](int, std::size_t next) { any = any || task.centres.has_glass(next); });
      const visibility::PixelPlaces sees = task.seen.of_pixel(around.x(), around.y());
      for (std::size_t k = 0; k < task.offsets.size(); ++k) any = any || sees.layer(k) != no_triangle;
      has_glass[i] = any ? 1 : 0;
    }
  });
  std::vector<std::uint32_t> with, without;
  for (std::size_t i = 0; i < pixels.size(); ++i) (has_glass[i] != 0 ? with : without).push_back(pixels[i]);
  std::copy(without.begin(), without.end(), std::copy(with.begin(), with.end(), pixels.begin()));
  return with.size();
}

}  // namespace tenebra::render
