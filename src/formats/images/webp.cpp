// WebP by libwebp, where CMake found it.
#include "formats/images/decode.h"
#include "formats/import_failure.h"

#ifdef TENEBRA_WEBP
#include <webp/decode.h>
#endif

namespace tenebra::formats {

#ifdef TENEBRA_WEBP

bool reads_webp() {
  return true;
}

TextureImage decode_webp(std::string_view bytes, std::uint64_t& pixels_left) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  TextureImage image;
  if (WebPGetInfo(data, bytes.size(), &image.width, &image.height) == 0)
    refuse("found a broken WebP header, expected a whole picture");
  charge_pixels(static_cast<std::uint64_t>(image.width), static_cast<std::uint64_t>(image.height),
                pixels_left);
  image.rgba.resize(4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  if (WebPDecodeRGBAInto(data, bytes.size(), image.rgba.data(), image.rgba.size(), 4 * image.width) ==
      nullptr)
    refuse("found a broken WebP picture of {} x {} pixels, expected a whole one", image.width, image.height);
  return image;
}

#else

bool reads_webp() {
  return false;
}

TextureImage decode_webp(std::string_view, std::uint64_t&) {
  refuse(
      "found a WebP picture, which this build does not read, expected PNG, JPEG or PPM (install libwebp-dev "
      "and build again to read WebP)");
}

#endif

}  // namespace tenebra::formats
