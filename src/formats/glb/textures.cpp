// Textures of a GLB: pictures embedded as PNG, samplers, and where they lie on the coordinates.
#include "formats/glb/writer.h"
#include "io/image.h"

namespace tenebra::formats {
namespace {

/// In three channels where no pixel lets anything through.
io::Image8 picture_of(const TextureImage& image) {
  bool opaque = true;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) opaque &= image.rgba[i] == 255;
  io::Image8 picture{image.width, image.height, opaque ? 3 : 4, {}};
  if (!opaque) {
    picture.pixels = image.rgba;
    return picture;
  }
  picture.pixels.reserve(image.rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    picture.pixels.insert(picture.pixels.end(), &image.rgba[i], &image.rgba[i] + 3);
  return picture;
}

int number_of(Wrap wrap) {
  return wrap == Wrap::repeat ? 10497 : wrap == Wrap::clamp_to_edge ? 33071 : 33648;
}

int minify_number_of(const TextureMap& map) {
  const int linear = map.minify == Filter::linear ? 1 : 0;
  if (map.mip == MipFilter::none) return 9728 + linear;
  return (map.mip == MipFilter::nearest ? 9984 : 9986) + linear;
}

}  // namespace

int GlbWriter::image_of(int image) {
  const auto [entry, is_new] = image_of_.try_emplace(image, static_cast<int>(image_of_.size()));
  if (!is_new) return entry->second;
  const TextureImage& source = scene_.images[static_cast<std::size_t>(image)];
  const auto png = io::encode_png(picture_of(source));
  if (!png) refuse("texture '{}': {}", source.name, png.error().message);
  const std::size_t view = binary_.add_view(png->data(), png->size());  // may move what root_ holds
  root_["images"].push_back({{"name", source.name}, {"mimeType", "image/png"}, {"bufferView", view}});
  return entry->second;
}

int GlbWriter::sampler_of(const TextureMap& map) {
  const std::array<int, 4> numbers{map.magnify == Filter::nearest ? 9728 : 9729, minify_number_of(map),
                                   number_of(map.wrap_u), number_of(map.wrap_v)};
  const auto [entry, is_new] = sampler_of_.try_emplace(numbers, static_cast<int>(sampler_of_.size()));
  if (is_new)
    root_["samplers"].push_back(
        {{"magFilter", numbers[0]}, {"minFilter", numbers[1]}, {"wrapS", numbers[2]}, {"wrapT", numbers[3]}});
  return entry->second;
}

int GlbWriter::texture_of(const TextureMap& map) {
  const std::pair<int, int> key{image_of(map.image), sampler_of(map)};
  const auto [entry, is_new] = texture_of_.try_emplace(key, static_cast<int>(texture_of_.size()));
  if (is_new) root_["textures"].push_back({{"source", key.first}, {"sampler", key.second}});
  return entry->second;
}

/// KHR_texture_transform knows scale, then a turn, then offset. What it cannot say is written without its
/// skew.
void GlbWriter::write_transform(const glm::mat3x2& transform, GlbJson& info) {
  if (transform == glm::mat3x2{1, 0, 0, 1, 0, 0}) return;
  const glm::dvec2 u = transform[0], v = transform[1];
  double turn = 0;
  glm::dvec2 scale(u.x, v.y);
  if (u.y != 0 || v.x != 0) {
    turn = u == glm::dvec2(0) ? std::atan2(v.x, v.y) : std::atan2(-u.y, u.x);
    const glm::dvec2 turned_v(std::sin(turn), std::cos(turn));
    scale = {glm::length(u), glm::dot(v, turned_v)};
    skewed_ += glm::length(v - scale.y * turned_v) > 1e-5 * glm::length(v);
  }
  GlbJson& written = info["extensions"]["KHR_texture_transform"];
  written["offset"] = {transform[2].x, transform[2].y};
  if (turn != 0) written["rotation"] = turn;
  written["scale"] = {scale.x, scale.y};
  use("KHR_texture_transform");
}

void GlbWriter::write_map(const TextureMap& map, const char* name, GlbJson& object) {
  if (!map) return;
  GlbJson info = {{"index", texture_of(map)}};
  if (map.uv_set != 0) info["texCoord"] = map.uv_set;
  write_transform(map.transform, info);
  object[name] = std::move(info);
}

}  // namespace tenebra::formats
