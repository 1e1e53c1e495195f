#include "render/antialias/sample_picture.h"

#include <algorithm>

#include "parallel/parallel.h"

namespace tenebra::render {

void pack_samples(std::span<const std::uint32_t> chosen, int width, std::span<const glm::vec2> offsets,
                  const visibility::PlaceIds& seen, std::span<const std::uint32_t> centre_ids,
                  SamplePicture& out) {
  const std::size_t per_pixel = offsets.size(), count = chosen.size() * per_pixel;
  const bool layered = seen.has_layer();
  out.grid = points::SampleGrid(count);
  out.count = count;
  out.per_pixel = per_pixel;
  out.ids.assign(out.grid.pixels(), no_triangle);
  out.layer.assign(layered ? out.grid.pixels() : 0, no_triangle);
  out.places.resize(out.grid.pixels());
  out.pixels.resize(out.grid.pixels());
  out.slots.resize(count);
  const auto columns = static_cast<std::uint32_t>(width);
  const std::size_t at_once = std::max<std::size_t>(1, 256 / per_pixel);
  parallel::parallel_ranges(chosen.size(), at_once, [&](std::size_t first, std::size_t last) {
    std::size_t next = first * per_pixel;
    for (const bool as_centre : {true, false}) {
      for (std::size_t i = first; i < last; ++i) {
        const std::uint32_t pixel = chosen[i], id = centre_ids[pixel];
        const glm::vec2 centre(static_cast<float>(pixel % columns) + 0.5f,
                               static_cast<float>(pixel / columns) + 0.5f);
        const visibility::PixelPlaces sees =
            seen.of_pixel(static_cast<int>(pixel % columns), static_cast<int>(pixel / columns));
        for (std::size_t k = 0; k < per_pixel; ++k) {
          if ((sees.id(k) == id) != as_centre) continue;
          const std::size_t slot = out.grid.pixel(next++);
          out.slots[i * per_pixel + k] = static_cast<std::uint32_t>(slot);
          out.ids[slot] = sees.id(k);
          if (layered) out.layer[slot] = sees.layer(k);
          out.pixels[slot] = pixel;
          out.places[slot] = centre + offsets[k];
        }
      }
    }
  });
}

}  // namespace tenebra::render
