#include "render/antialias/sample_picture.h"

#include <algorithm>
#include <array>

#include "parallel/parallel.h"

namespace tenebra::render {
namespace {

constexpr std::size_t square = 256;

}  // namespace

void pack_samples(std::span<const std::uint32_t> chosen, int width, std::span<const glm::vec2> offsets,
                  std::span<const SampleIds> seen, SamplePicture& out) {
  const std::size_t per_pixel = offsets.size(), count = chosen.size() * per_pixel;
  const bool layered = !seen.empty() && !seen.front().layer.empty();
  out.grid = points::SampleGrid(count);
  out.count = count;
  out.per_pixel = per_pixel;
  out.ids.assign(out.grid.pixels(), no_triangle);
  out.layer.assign(layered ? out.grid.pixels() : 0, no_triangle);
  out.places.assign(out.grid.pixels(), glm::vec2(0.0f));
  out.pixels.assign(out.grid.pixels(), 0);
  out.slots.resize(count);
  const auto columns = static_cast<std::uint32_t>(width);
  parallel::parallel_ranges(count, square, [&](std::size_t first, std::size_t last) {
    std::array<std::uint64_t, square> order;  // the id, then the sample
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t id = seen[i % per_pixel].ids[chosen[i / per_pixel]];
      order[i - first] = std::uint64_t{id} << 32 | i;
    }
    std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(last - first));
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t sample = order[i - first] & 0xffffffffu, slot = out.grid.pixel(i),
                        k = sample % per_pixel;
      const std::uint32_t pixel = chosen[sample / per_pixel];
      out.slots[sample] = static_cast<std::uint32_t>(slot);
      out.ids[slot] = static_cast<std::uint32_t>(order[i - first] >> 32);
      if (layered) out.layer[slot] = seen[k].layer[pixel];
      out.pixels[slot] = pixel;
      out.places[slot] = glm::vec2(static_cast<float>(pixel % columns), static_cast<float>(pixel / columns)) +
                         0.5f + offsets[k];
    }
  });
}

}  // namespace tenebra::render
