#include "shared/loaded_picture.h"

#include <array>
#include <cstddef>

#include "base/fail.h"
#include "io/exr/exr_file.h"
#include "math/srgb.h"

namespace tenebra::viewer {
namespace {

/// Three channels, each `value` of what is stored.
template <class T>
io::ImageF in_three(const io::Image<T>& image, auto value) {
  const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const auto channels = static_cast<std::size_t>(image.channels);
  io::ImageF out{image.width, image.height, 3, std::vector<float>(3 * count)};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      out.pixels[3 * i + c] = value(image.pixels[i * channels + (channels < 3 ? 0 : c)]);
  return out;
}

std::array<float, 256> linear_levels() {
  std::array<float, 256> levels{};
  for (std::size_t i = 0; i < levels.size(); ++i)
    levels[i] = static_cast<float>(math::linear_of_srgb(static_cast<double>(i) / 255.0));
  return levels;
}

}  // namespace

Expected<LoadedPicture> load_picture(const std::filesystem::path& path, const std::string& layer) {
  const auto as_picture = [](auto image) -> Expected<LoadedPicture> {
    if (!image) return tl::unexpected(image.error());
    return LoadedPicture(std::move(*image));
  };
  if (path.extension() == ".exr") return as_picture(io::exr::read(path, layer));
  if (!layer.empty()) return base::fail("--layer is for OpenEXR pictures; found {}", path.string());
  if (path.extension() == ".pfm") return as_picture(io::read_pfm(path));
  return as_picture(io::read_png(path));
}

io::ImageF linear_colors(const LoadedPicture& picture) {
  if (const auto* const floats = std::get_if<io::ImageF>(&picture)) {
    if (floats->channels == 3) return *floats;
    return in_three(*floats, [](float value) { return value; });
  }
  return in_three(std::get<io::Image8>(picture),
                  [levels = linear_levels()](std::uint8_t level) { return levels[level]; });
}

}  // namespace tenebra::viewer
