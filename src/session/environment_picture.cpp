#include "session/environment_picture.h"

#include <algorithm>
#include <cmath>

#include "base/fail.h"
#include "base/lower_case.h"
#ifdef TENEBRA_OPENEXR
#include "io/exr/exr_file.h"
#endif

namespace tenebra::session {
namespace {

bool is_exr(const std::filesystem::path& path) {
  return base::extension_of(path) == ".exr";
}

Expected<io::ImageF> read_exr(const std::filesystem::path& path) {
#ifdef TENEBRA_OPENEXR
  auto picture = io::exr::read(path);
  if (!picture || picture->channels == 3) return picture;
  io::ImageF grey{picture->width, picture->height, 3, {}};
  for (const float value : picture->pixels) grey.pixels.insert(grey.pixels.end(), 3, value);
  return grey;
#else
  return base::fail(
      "{}: this build has no OpenEXR (package libopenexr-dev), expected a Radiance picture (.hdr)",
      path.string());
#endif
}

}  // namespace

Expected<io::ImageF> read_environment(const std::filesystem::path& path) {
  auto picture = is_exr(path) ? read_exr(path) : io::read_hdr(path);
  if (!picture) return picture;
  const auto is_light = [](float value) { return std::isfinite(value) && value >= 0; };
  const auto wrong = std::find_if_not(picture->pixels.begin(), picture->pixels.end(), is_light);
  if (wrong == picture->pixels.end()) return picture;
  const auto pixel = (wrong - picture->pixels.begin()) / 3;
  return base::fail("{}: found {} at pixel {}, {}, expected light: finite and not below 0", path.string(),
                    *wrong, pixel % picture->width, pixel / picture->width);
}

}  // namespace tenebra::session
