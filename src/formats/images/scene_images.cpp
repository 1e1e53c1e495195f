#include "formats/images/scene_images.h"

#include <fmt/core.h>

#include <algorithm>

#include "formats/images/derived.h"
#include "formats/import_failure.h"
#include "formats/scene_file.h"

namespace tenebra::formats {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t most_picture_bytes = std::uintmax_t{1} << 28;

/// What `judge` says of the picture `image` of `scene`, asked once.
bool judge_once(const Scene& scene, int image, bool (*judge)(const TextureImage&),
                std::map<int, bool>& known) {
  const auto [entry, is_new] = known.try_emplace(image, false);
  if (is_new) entry->second = judge(scene.images[static_cast<std::size_t>(image)]);
  return entry->second;
}

}  // namespace

SceneImages::SceneImages(Scene& scene, const fs::path& folder, const ImportOptions& options)
    : scene_(scene),
      folders_{folder, folder / "textures", folder / "TextureFiles"},
      root_(options.root),
      files_read_(options.files_read) {
  folders_.insert(folders_.end(), options.texture_paths.begin(), options.texture_paths.end());
}

int SceneImages::fail(const std::string& name, const std::string& why) {
  scene_.warnings.push_back(
      fmt::format("texture '{}': {}; its surfaces have their factors alone.", shown(name), why));
  return -1;
}

/// Where the picture lies; empty if nowhere.
fs::path SceneImages::search(const std::string& name, const std::string& place, bool percent_encoded) {
  std::string refusal;
  for (const fs::path& folder : folders_) {
    const bool beside_scene = &folder == &folders_.front();
    try {
      const fs::path file = confine(folder, name, place, percent_encoded, beside_scene ? root_ : fs::path());
      std::error_code error;
      if (fs::exists(file, error)) return file;
    } catch (const ImportFailure& failure) {
      if (refusal.empty()) refusal = failure.what();
    }
  }
  const std::string last(last_part(name));
  if (!percent_encoded && last != name && !last.empty()) return search(last, place, false);
  if (!refusal.empty()) throw ImportFailure(refusal);
  return {};
}

int SceneImages::load(const std::string& name, const std::string& place, bool percent_encoded) {
  const fs::path file = search(name, place, percent_encoded);
  if (file.empty())
    refuse(
        "{}: found no such file beside the scene, in its folders textures or TextureFiles, or in a "
        "--texture-path, expected a picture",
        place);
  if (const auto known = index_of_file_.find(file); known != index_of_file_.end()) return known->second;
  std::error_code error;
  if (const auto bytes = fs::file_size(file, error); !error && bytes > most_picture_bytes)
    refuse("{}: found {} bytes, expected at most {}", place, bytes, most_picture_bytes);
  TextureImage image =
      decode_image(read_scene_file(file, files_read_), file.filename().string(), pixels_left_);
  scene_.images.push_back(std::move(image));
  return index_of_file_[file] = static_cast<int>(scene_.images.size()) - 1;
}

int SceneImages::find(const std::string& name, const std::string& place) {
  const auto [entry, is_new] = index_of_.try_emplace(name, -1);
  if (!is_new) return entry->second;
  try {
    return entry->second = load(name, place, false);
  } catch (const UnreadableFile& failure) {
    throw UnreadableFile(fmt::format("texture '{}': {}", shown(name), failure.what()));
  } catch (const ImportFailure& failure) {
    return fail(name, failure.what());
  }
}

int SceneImages::find_uri(const std::string& uri, const std::string& place) {
  const auto [entry, is_new] = index_of_.try_emplace(uri, -1);
  if (!is_new) return entry->second;
  try {
    return entry->second = load(uri, place, true);
  } catch (const UnreadableFile& failure) {
    throw UnreadableFile(fmt::format("texture '{}': {}", shown(uri), failure.what()));
  } catch (const ImportFailure& failure) {
    return fail(uri, failure.what());
  }
}

int SceneImages::add(std::string_view bytes, const std::string& name) {
  try {
    scene_.images.push_back(decode_image(bytes, name, pixels_left_));
    return static_cast<int>(scene_.images.size()) - 1;
  } catch (const ImportFailure& failure) {
    return fail(name, failure.what());
  }
}

int SceneImages::derive(const std::string& name, int width, int height,
                        const std::function<TextureImage()>& make) {
  try {
    charge_pixels(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), pixels_left_);
    scene_.images.push_back(make());
    return static_cast<int>(scene_.images.size()) - 1;
  } catch (const ImportFailure& failure) {
    return fail(name, failure.what());
  }
}

int SceneImages::normals_of_bumps(int bumps, float scale) {
  if (bumps < 0) return -1;
  const auto [entry, is_new] = normals_of_.try_emplace({bumps, scale}, bumps);
  if (!is_new) return entry->second;
  if (!judge_once(scene_, bumps, holds_heights, holds_heights_)) return bumps;
  const TextureImage& image = scene_.images[static_cast<std::size_t>(bumps)];
  const double height = 0.01 * std::max(image.width, image.height) * double{scale};
  return entry->second =
             derive(image.name, image.width, image.height, [&] { return normals_of_heights(image, height); });
}

int SceneImages::join(int a, int b, TextureImage (*join)(const TextureImage&, const TextureImage&),
                      std::map<std::pair<int, int>, int>& known) {
  const auto [entry, is_new] = known.try_emplace({a, b}, -1);
  if (!is_new) return entry->second;
  const TextureImage white{"white", 1, 1, {255, 255, 255, 255}};
  const auto picture = [&](int i) -> const TextureImage& {
    return i < 0 ? white : scene_.images[static_cast<std::size_t>(i)];
  };
  const TextureImage &first = picture(a), &second = picture(b);
  return entry->second = derive(b < 0 ? first.name : second.name, std::max(first.width, second.width),
                                std::max(first.height, second.height), [&] { return join(first, second); });
}

int SceneImages::with_alpha(int colors, int shares) {
  return shares < 0 ? -1 : join(colors, shares, formats::with_alpha, with_alpha_);
}

int SceneImages::metallic_roughness(int roughness, int metallic) {
  if (roughness == metallic) return roughness;
  return join(roughness, metallic, formats::metallic_roughness, metallic_roughness_);
}

bool SceneImages::cuts_out(int image) {
  return judge_once(scene_, image, formats::cuts_out, cuts_out_);
}

}  // namespace tenebra::formats
