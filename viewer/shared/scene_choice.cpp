#include "shared/scene_choice.h"

#include <charconv>
#include <string_view>
#include "base/fail.h"
#include "shell/console.h"

namespace tenebra::viewer {
namespace {

/// Names win over numbers, so that a clip called "2" can be reached.
template <class Named>
Expected<int> choose(const std::vector<Named>& list, const std::optional<std::string>& wanted,
                     std::string_view kind) {
  if (!wanted) return 0;
  std::string names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].name == *wanted) return static_cast<int>(i);
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", i, list[i].name);
  }
  int index = -1;
  const char* end = wanted->data() + wanted->size();
  const auto [stopped, error] = std::from_chars(wanted->data(), end, index);
  const bool is_index = error == std::errc{} && stopped == end;
  if (is_index && index >= 0 && index < static_cast<int>(list.size())) return index;
  return base::fail("the scene has no {} called or numbered {}, it has {}", kind, *wanted,
                    names.empty() ? "none" : names);
}

}  // namespace

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_error("warning: {}\n", warning);
}

Expected<int> choose_clip(const Scene& scene, const std::optional<std::string>& wanted) {
  if (scene.clips.empty() && !wanted) return -1;
  return choose(scene.clips, wanted, "--clip");
}

Expected<int> choose_camera(const Scene& scene, const std::optional<std::string>& wanted) {
  return choose(scene.cameras, wanted, "--camera");
}

double time_of_frame(const Scene& scene, int clip, int frame, double fps) {
  return clip < 0 ? 0.0 : frame_time_s(scene.clips[static_cast<std::size_t>(clip)], frame, fps);
}

int frames_of_clip(const Scene& scene, int clip, double fps) {
  return clip < 0 ? 1 : frame_count(scene.clips[static_cast<std::size_t>(clip)], fps);
}

}  // namespace tenebra::viewer
