#include "bench/hash/hash_lines.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/fail.h"
#include "bench/common/bench_report.h"
#include "bench/hash/scene_hasher.h"

namespace tenebra::bench {
namespace {

using FrameItems = std::vector<HashItem>;  // of one frame at one setting

/// The lines of one frame; `by_setting`: the same items, in the order of `settings`.
void add_lines(const std::string& scene, int frame, const std::vector<HashSetting>& settings,
               const std::vector<const FrameItems*>& by_setting, HashLines& out) {
  const FrameItems& first = *by_setting.front();
  for (std::size_t i = 0; i < first.size(); ++i) {
    const bool same = std::all_of(by_setting.begin(), by_setting.end(),
                                  [&](const FrameItems* items) { return (*items)[i].hash == first[i].hash; });
    if (!same) ++out.differing;
    for (std::size_t k = 0; k < (same ? 1 : settings.size()); ++k) {
      std::string line = hash_line(scene, frame, first[i].what, (*by_setting[k])[i].hash);
      if (!same) line.append(" ").append(setting_name(settings[k]));
      out.lines.push_back(std::move(line));
    }
  }
}

}  // namespace

const std::vector<HashedScene>& hashed_scenes() {
  static const std::vector<HashedScene> scenes{{"city", {0, 50, 150, 280}}, {"gallery", {0, 100, 260}},
                                               {"court", {0, 60, 210}},     {"robots", {100, 160, 400, 640}},
                                               {"museum5", {20, 100, 200}}, {"kitchen", {100, 400, 700}}};
  return scenes;
}

std::vector<HashedScene> quickly_hashed_scenes() {
  std::vector<HashedScene> scenes = hashed_scenes();
  for (HashedScene& scene : scenes) scene.frames = {scene.frames[1]};
  return scenes;
}

std::string hash_line(const std::string& scene, int frame, const std::string& what, std::uint64_t hash) {
  return fmt::format("{} {} {} {:016x}", scene, frame, what, hash);
}

Expected<HashLines> hash_scene(const Scene& scene, const HashedScene& chosen,
                               const std::vector<HashSetting>& settings, int scale) {
  std::vector<HashFrame> frames;
  for (const int number : chosen.frames) frames.push_back(make_hash_frame(scene, number, scale));
  std::vector<std::vector<FrameItems>> items;  // by setting and frame
  for (const HashSetting& setting : settings) {
    progress(fmt::format("{}: {}", chosen.name, setting_name(setting)));
    SceneHasher hasher(scene, setting);
    auto& of_setting = items.emplace_back();
    for (const HashFrame& frame : frames) {
      auto hashed = hasher.hash(frame);
      if (!hashed) return base::fail("{} {}: {}", chosen.name, frame.number, hashed.error().message);
      of_setting.push_back(std::move(*hashed));
    }
  }
  HashLines out;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    std::vector<const FrameItems*> by_setting;
    for (const auto& of_setting : items) by_setting.push_back(&of_setting[f]);
    add_lines(chosen.name, frames[f].number, settings, by_setting, out);
  }
  return out;
}

}  // namespace tenebra::bench
