#include "formats/images/decode.h"

#include "formats/import_failure.h"
#include "io/image.h"

namespace tenebra::formats {
namespace {

TextureImage decode_png_or_jpeg(std::string_view bytes, std::uint64_t& pixels_left) {
  const auto size = io::stated_size(bytes);
  if (!size) throw ImportFailure(size.error().message + ", expected a whole picture");
  charge_pixels(size->width, size->height, pixels_left);
  auto decoded = io::decode_rgba(bytes);
  if (!decoded) throw ImportFailure(decoded.error().message + ", expected a whole picture");
  TextureImage image;
  image.width = decoded->width;
  image.height = decoded->height;
  image.rgba = std::move(decoded->pixels);
  return image;
}

bool is_ppm(std::string_view bytes) {
  return bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == '6' || bytes[1] == '3');
}

TextureImage decode(std::string_view bytes, std::uint64_t& pixels_left) {
  if (io::is_png_or_jpeg(bytes)) return decode_png_or_jpeg(bytes, pixels_left);
  if (is_ppm(bytes)) return decode_ppm(bytes, pixels_left);
  if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP"))
    return decode_webp(bytes, pixels_left);
  if (bytes.starts_with("\xABKTX 20\xBB")) return decode_ktx2(bytes, pixels_left);
  refuse("found a file of no known kind, expected PNG, JPEG, WebP, KTX2 or PPM");
}

}  // namespace

void charge_pixels(std::uint64_t width, std::uint64_t height, std::uint64_t& pixels_left) {
  if (width == 0 || height == 0) refuse("found {} x {} pixels, expected at least one", width, height);
  if (width > most_image_pixels / height)
    refuse("found {} x {} pixels, expected at most {} in one picture", width, height, most_image_pixels);
  if (width * height > pixels_left)
    refuse("found {} x {} pixels, expected at most {} in all pictures of a scene", width, height,
           most_scene_pixels);
  pixels_left -= width * height;
}

TextureImage decode_image(std::string_view bytes, std::string name, std::uint64_t& pixels_left) {
  TextureImage image = decode(bytes, pixels_left);
  image.name = std::move(name);
  return image;
}

}  // namespace tenebra::formats
