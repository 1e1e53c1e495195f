#include "session/aovs.h"

#include <array>
#include <string_view>

#include "base/fail.h"
#include "settings/text_values.h"

namespace tenebra::session {
namespace {

struct AovName {
  std::string_view name;
  bool& (*wanted)(render::AovChoice&);
};
constexpr std::array aov_names{
    AovName{"depth", [](render::AovChoice& o) -> bool& { return o.depth; }},
    AovName{"id", [](render::AovChoice& o) -> bool& { return o.ids; }},
    AovName{"normal", [](render::AovChoice& o) -> bool& { return o.normal; }},
    AovName{"visibility", [](render::AovChoice& o) -> bool& { return o.visibility; }},
    AovName{"irradiance", [](render::AovChoice& o) -> bool& { return o.irradiance; }},
    AovName{"ao", [](render::AovChoice& o) -> bool& { return o.openness; }},
    AovName{"albedo", [](render::AovChoice& o) -> bool& { return o.albedo; }}};

}  // namespace

Expected<render::AovChoice> parse_aovs(const std::string& text) {
  render::AovChoice aovs;
  for (const std::string_view word : settings::split(text, ',')) {
    const AovName* found = nullptr;
    for (const AovName& aov : aov_names)
      if (settings::is_word(word, aov.name)) found = &aov;
    if (found == nullptr)
      return base::fail(
          "found {}, expected some of depth, id, normal, visibility, irradiance, ao and albedo, like "
          "depth,id",
          text);
    found->wanted(aovs) = true;
  }
  return aovs;
}

std::string aov_words(render::AovChoice aovs) {
  std::string words;
  for (const AovName& aov : aov_names)
    if (aov.wanted(aovs)) words += fmt::format("{}{}", words.empty() ? "" : ",", aov.name);
  return words;
}

Expected<void> check_aovs(const render::AovChoice& aovs, const render::RenderSettings& settings) {
  if (aovs.visibility && settings.shadows == render::ShadowMode::none)
    return base::fail("--aov visibility needs shadows, and --shadows none finds none");
  if (aovs.openness && settings.ao.mode == AoMode::none)
    return base::fail("--aov ao needs ambient occlusion; expected --ao adaptive, field or rays with it");
  return {};
}

}  // namespace tenebra::session
