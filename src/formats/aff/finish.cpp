// The part of an AFF scene that is known only at its end: which key frames drive what.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "formats/aff/reader.h"

namespace tenebra::formats {
namespace {

/// Widens [start, end] by a track's reachable times: a spline's first and last key only shape tangents.
void widen(const Track& track, double& start_s, double& end_s) {
  const std::size_t skip = track.interpolation == Interpolation::kochanek_bartels ? 1 : 0;
  for (std::size_t i = skip; i + skip < track.times_s.size(); ++i) {
    start_s = std::min(start_s, track.times_s[i]);
    end_s = std::max(end_s, track.times_s[i]);
  }
}

}  // namespace

int AffReader::track_of(const std::string& name, ChannelPath path, const Track& track) {
  const auto next = static_cast<int>(clip_.tracks.size());
  const auto [entry, is_new] = tracks_.try_emplace({name, path}, next);
  if (is_new) clip_.tracks.push_back(track);
  return entry->second;
}

void AffReader::add_channels(int node, const std::string& name, bool translation_only) {
  const auto found = keys_.find(name);
  if (found == keys_.end()) return;
  const auto add = [&](ChannelPath path, const std::optional<Track>& track) {
    if (track) clip_.channels.push_back({node, path, track_of(name, path, *track)});
  };
  add(ChannelPath::translation, found->second.translation);
  if (translation_only) return;
  add(ChannelPath::rotation, found->second.rotation);
  add(ChannelPath::scale, found->second.scale);
  add(ChannelPath::visibility, found->second.visibility);
}

/// The camera stands in no block. Keys named "camera" replace what `v` says, part by part.
void AffReader::add_camera() {
  const auto keys = keys_.find("camera");
  if (!view_ && keys == keys_.end()) return;
  View view = view_.value_or(View{});
  view.camera.name = "camera";
  view.node.name = "camera";
  view.node.camera = static_cast<int>(scene_.cameras.size());
  const auto node = static_cast<int>(scene_.nodes.size());
  scene_.cameras.push_back(std::move(view.camera));
  scene_.nodes.push_back(std::move(view.node));
  if (keys == keys_.end()) return;
  keys->second.scale.reset();
  keys->second.visibility.reset();
  add_channels(node, "camera", false);
}

void AffReader::bound_interval() {
  clip_.start_s = std::numeric_limits<double>::infinity();
  clip_.end_s = -clip_.start_s;
  for (const Track& track : clip_.tracks) widen(track, clip_.start_s, clip_.end_s);
  for (const Mesh& mesh : scene_.meshes) {
    if (mesh.shapes.empty()) continue;
    clip_.start_s = std::min(clip_.start_s, mesh.shapes.front().time_s);
    clip_.end_s = std::max(clip_.end_s, mesh.shapes.back().time_s);
  }
}

void AffReader::name_missing_keys() {
  constexpr std::size_t most_named = 8;
  std::vector<std::string> names;
  for (const Animated& animated : animated_) {
    if (!keys_.contains(animated.name)) names.push_back(quote_word(animated.name));
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  if (names.empty()) return;
  const bool all = names.size() <= most_named;
  const auto last = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), most_named));
  scene_.warnings.push_back(fmt::format("{}: {} names have no key frames and stand still: {}{}.", scene_.name,
                                        names.size(), fmt::join(names.begin(), last, ", "),
                                        all ? "" : ", ..."));
}

void AffReader::name_faults() {
  const std::size_t more = faults_.count - faults_.first.size();
  scene_.warnings.insert(scene_.warnings.end(), faults_.first.begin(), faults_.first.end());
  if (more > 0)
    scene_.warnings.push_back(
        fmt::format("{}: {} more faults that leave the geometry certain.", scene_.name, more));
}

void AffReader::finish() {
  for (const Animated& a : animated_) add_channels(a.node, a.name, a.translation_only);
  add_camera();
  name_missing_keys();
  name_faults();
  const bool moves =
      !clip_.channels.empty() || std::any_of(scene_.meshes.begin(), scene_.meshes.end(),
                                             [](const Mesh& mesh) { return !mesh.shapes.empty(); });
  if (!moves && !interval_stated_) return;
  if (!interval_stated_) bound_interval();
  clip_.name = "animation";
  scene_.clips.push_back(std::move(clip_));
}

}  // namespace tenebra::formats
