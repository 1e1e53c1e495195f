#include "formats/gltf/textures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "formats/scene_file.h"

namespace tenebra::formats::gltf {
namespace {

Wrap wrap_of(int mode, const std::string& place, std::vector<std::string>& warnings) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp_to_edge;
  if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::mirrored_repeat;
  if (mode != TINYGLTF_TEXTURE_WRAP_REPEAT)
    warnings.push_back(
        fmt::format("{}: found {}, expected 10497, 33071 or 33648; the texture repeats.", place, mode));
  return Wrap::repeat;
}

void set_minify(int filter, const std::string& place, std::vector<std::string>& warnings, TextureMap& map) {
  switch (filter) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
      map.minify = Filter::nearest;
      break;
    case -1:
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
      break;
    default:
      warnings.push_back(
          fmt::format("{}.minFilter: found {}, expected 9728, 9729 or 9984 to 9987.", place, filter));
      return;
  }
  if (filter == TINYGLTF_TEXTURE_FILTER_NEAREST || filter == TINYGLTF_TEXTURE_FILTER_LINEAR)
    map.mip = MipFilter::none;
  else if (filter == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
           filter == TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST)
    map.mip = MipFilter::nearest;
}

void set_sampler(const tinygltf::Sampler& sampler, const std::string& place,
                 std::vector<std::string>& warnings, TextureMap& map) {
  map.wrap_u = wrap_of(sampler.wrapS, place + ".wrapS", warnings);
  map.wrap_v = wrap_of(sampler.wrapT, place + ".wrapT", warnings);
  if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST)
    map.magnify = Filter::nearest;
  else if (sampler.magFilter != -1 && sampler.magFilter != TINYGLTF_TEXTURE_FILTER_LINEAR)
    warnings.push_back(
        fmt::format("{}.magFilter: found {}, expected 9728 or 9729.", place, sampler.magFilter));
  set_minify(sampler.minFilter, place, warnings, map);
}

/// KHR_texture_transform: scale, then a turn that is counter-clockwise where v points down, then offset.
glm::mat3x2 transform_of(const Value& value) {
  glm::vec2 offset(0), scale(1);
  read_color(value, "offset", offset);
  read_color(value, "scale", scale);
  const double turn = number_or(value, "rotation", 0);
  const double c = std::cos(turn), s = std::sin(turn);
  return {glm::vec2(c * scale.x, -s * scale.x), glm::vec2(s * scale.y, c * scale.y), offset};
}

const std::string& text_of(const Value* value) {
  static const std::string none;
  return value && value->IsString() ? value->Get<std::string>() : none;
}

bool is_data(const std::string& uri) {
  return uri.starts_with("data:");
}

/// "image/png" of "data:image/png;base64,...".
std::string kind_in(const std::string& uri) {
  return uri.substr(5, std::min(uri.find_first_of(";,"), std::size_t{5 + 40}) - 5);
}

}  // namespace

Textures::Textures(Asset& asset, const std::filesystem::path& folder, SceneImages images)
    : asset_(asset), images_(std::move(images)) {
  const Value* sources = member(asset_.model.extras, "images");
  for (std::size_t i = 0; sources && i < sources->ArrayLen(); ++i) {
    check_source(static_cast<int>(i), folder);
    check_kind(static_cast<int>(i));
  }
}

const Value* Textures::source(int index) const {
  const Value* sources = member(asset_.model.extras, "images");
  const bool there = sources && index >= 0 && static_cast<std::size_t>(index) < sources->ArrayLen();
  return there ? &sources->Get(index) : nullptr;
}

void Textures::check_source(int index, const std::filesystem::path& folder) {
  const std::string place = fmt::format("images[{}]", index);
  const Value& image = *source(index);
  auto& warnings = asset_.scene.warnings;
  if (const Value* uri = member(image, "uri")) {
    if (is_data(text_of(uri))) return;
    try {
      confine(folder, text_of(uri), place + ".uri", true, asset_.root);
    } catch (const ImportFailure& failure) {
      warnings.push_back(fmt::format("{}; the image is not read.", failure.what()));
      known_[index] = -1;
    }
  } else if (const Value* view = member(image, "bufferView")) {
    if (asset_.model.bufferViews[static_cast<std::size_t>(view->GetNumberAsInt())].byteStride != 0)
      warnings.push_back(fmt::format("{}.bufferView: found a view with a byteStride, expected none.", place));
  }
}

void Textures::check_kind(int index) {
  static constexpr std::string_view kinds[] = {"image/png", "image/jpeg", "image/webp", "image/ktx2"};
  const auto is_known = [](const std::string& kind) {
    return std::find(std::begin(kinds), std::end(kinds), kind) != std::end(kinds);
  };
  const std::string &stated = text_of(member(*source(index), "mimeType")),
                    &uri = text_of(member(*source(index), "uri"));
  auto& warnings = asset_.scene.warnings;
  if (!stated.empty() && !is_known(stated))
    warnings.push_back(fmt::format("images[{}].mimeType: found '{}', expected image/png or image/jpeg.",
                                   index, stated.substr(0, 40)));
  if (!is_data(uri)) return;
  const std::string kind = kind_in(uri);
  if (!is_known(kind) && kind != "application/octet-stream")
    warnings.push_back(
        fmt::format("images[{}].uri: found '{}', expected image/png or image/jpeg.", index, kind));
  else if (!stated.empty() && kind.starts_with("image/") && kind != stated)
    warnings.push_back(fmt::format("images[{}].mimeType: found '{}', expected the '{}' of its URI.", index,
                                   stated.substr(0, 40), kind));
}

int Textures::image(int index) {
  if (const auto known = known_.find(index); known != known_.end()) return known->second;
  const std::string place = fmt::format("images[{}]", index);
  const Value* const found = source(index);
  int& result = known_[index] = -1;
  if (!found) return result;
  const std::string& name = text_of(member(*found, "name"));
  const std::string shown = name.empty() ? place : name;
  if (const Value* uri = member(*found, "uri")) {
    if (!is_data(text_of(uri))) return result = images_.find_uri(text_of(uri), place + ".uri");
    try {
      return result = images_.add(decode_data_uri(text_of(uri), place + ".uri"), shown);
    } catch (const ImportFailure& failure) {
      asset_.scene.warnings.push_back(fmt::format("{}; the image is not read.", failure.what()));
      return result;
    }
  }
  if (const Value* view = member(*found, "bufferView")) {
    const auto& range = asset_.model.bufferViews[static_cast<std::size_t>(view->GetNumberAsInt())];
    const std::string_view bytes = asset_.buffers[static_cast<std::size_t>(range.buffer)];
    return result = images_.add(bytes.substr(range.byteOffset, range.byteLength), shown);
  }
  asset_.scene.warnings.push_back(
      fmt::format("{}: found neither uri nor bufferView, expected one; the image is not read.", place));
  return result;
}

/// The picture of a texture: KTX2 or WebP where this build reads it, else what stands beside it for others.
int Textures::image_of(int texture, const std::string& place) {
  const tinygltf::Texture& source = asset_.model.textures[static_cast<std::size_t>(texture)];
  const auto by_extension = [&](const char* name) {
    const auto found = source.extensions.find(name);
    return found == source.extensions.end() ? -1 : static_cast<int>(number_or(found->second, "source", -1));
  };
  const int ktx2 = by_extension("KHR_texture_basisu"), webp = by_extension("EXT_texture_webp");
  if (ktx2 >= 0 && (reads_ktx2() || (source.source < 0 && webp < 0))) {
    const int found = image(ktx2);
    if (found >= 0 || (source.source < 0 && webp < 0)) return found;
  }
  if (webp >= 0 && (reads_webp() || source.source < 0)) {
    const int found = image(webp);
    if (found >= 0 || source.source < 0) return found;
  }
  if (source.source >= 0) return image(source.source);
  asset_.scene.warnings.push_back(
      fmt::format("{}: found textures[{}] without an image; the factor alone is used.", place, texture));
  return -1;
}

TextureMap Textures::map(Use use, const std::string& place) {
  TextureMap map;
  if (use.texture < 0) return map;
  if (use.transform) use.uv_set = static_cast<int>(number_or(*use.transform, "texCoord", use.uv_set));
  auto& warnings = asset_.scene.warnings;
  if (use.uv_set < 0 || use.uv_set > 1) {
    warnings.push_back(
        fmt::format("{}: found TEXCOORD_{}, expected 0 or 1; the texture is not used.", place, use.uv_set));
    return map;
  }
  map.image = image_of(use.texture, place);
  if (map.image < 0) return map;
  map.uv_set = use.uv_set;
  if (use.transform) map.transform = transform_of(*use.transform);
  const int sampler = asset_.model.textures[static_cast<std::size_t>(use.texture)].sampler;
  if (sampler >= 0)
    set_sampler(asset_.model.samplers[static_cast<std::size_t>(sampler)],
                fmt::format("samplers[{}]", sampler), warnings, map);
  return map;
}

TextureMap Textures::map(const Value& extension, const char* name, const std::string& place) {
  const Value* info = member(extension, name);
  if (!info) return {};
  Use use{static_cast<int>(number_or(*info, "index", -1)), static_cast<int>(number_or(*info, "texCoord", 0)),
          nullptr};
  if (const Value* extensions = member(*info, "extensions"))
    use.transform = member(*extensions, "KHR_texture_transform");
  return map(use, place + "." + name);
}

}  // namespace tenebra::formats::gltf
