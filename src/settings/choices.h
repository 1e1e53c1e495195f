// Options whose value is one of a few words: one table per kind serves reading, messages and logs.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "base/fail.h"
#include "render/renderer.h"
#include "settings/text_values.h"
#include "stage/additions.h"

namespace tenebra::settings {

template <class T>
struct Choice {
  std::string_view name;
  T value;
};

inline constexpr std::array shadow_choices{Choice<render::ShadowMode>{"none", render::ShadowMode::none},
                                           Choice<render::ShadowMode>{"hard", render::ShadowMode::hard},
                                           Choice<render::ShadowMode>{"soft", render::ShadowMode::soft}};
inline constexpr std::array see_through_choices{Choice<SeeThrough>{"tint", SeeThrough::tint},
                                                Choice<SeeThrough>{"cast", SeeThrough::cast},
                                                Choice<SeeThrough>{"ignore", SeeThrough::ignore}};
inline constexpr std::array sky_choices{
    Choice<stage::Sky>{"auto", stage::Sky::automatic}, Choice<stage::Sky>{"none", stage::Sky::none},
    Choice<stage::Sky>{"soft", stage::Sky::soft}, Choice<stage::Sky>{"sun", stage::Sky::sun}};
inline constexpr std::array tone_choices{Choice<shade::Tone>{"none", shade::Tone::none},
                                         Choice<shade::Tone>{"neutral", shade::Tone::neutral},
                                         Choice<shade::Tone>{"aces", shade::Tone::aces}};
inline constexpr std::array emission_choices{
    Choice<render::LightEmission>{"lambert", render::LightEmission::lambert},
    Choice<render::LightEmission>{"point", render::LightEmission::point}};
inline constexpr std::array sample_choices{
    Choice<render::SampleSource>{"ids", render::SampleSource::ids},
    Choice<render::SampleSource>{"depth", render::SampleSource::depth}};
inline constexpr std::array terminator_choices{
    Choice<render::Terminator>{"smooth", render::Terminator::smooth},
    Choice<render::Terminator>{"flat", render::Terminator::flat}};
inline constexpr std::array solver_choices{Choice<SoftSolver>{"auto", SoftSolver::automatic},
                                           Choice<SoftSolver>{"bsp", SoftSolver::bsp},
                                           Choice<SoftSolver>{"clip", SoftSolver::clip}};
inline constexpr std::array grouping_choices{
    Choice<SoftGrouping>{"neighbourhood", SoftGrouping::neighbourhood},
    Choice<SoftGrouping>{"triangle", SoftGrouping::triangle}};
inline constexpr std::array occluder_choices{Choice<OccluderChoice>{"largest", OccluderChoice::largest},
                                             Choice<OccluderChoice>{"random", OccluderChoice::random}};
inline constexpr std::array ao_choices{
    Choice<AoMode>{"none", AoMode::none}, Choice<AoMode>{"adaptive", AoMode::adaptive},
    Choice<AoMode>{"field", AoMode::field}, Choice<AoMode>{"rays", AoMode::rays}};
inline constexpr std::array place_choices{Choice<AoPlace>{"pixels", AoPlace::pixels},
                                          Choice<AoPlace>{"vertices", AoPlace::vertices}};
inline constexpr std::array layout_choices{
    Choice<FieldLayout>{"chords", FieldLayout::chords},
    Choice<FieldLayout>{"positions", FieldLayout::positions_directions}};
inline constexpr std::array deforming_choices{Choice<bool>{"rays", true}, Choice<bool>{"none", false}};
inline constexpr std::array cull_choices{Choice<bool>{"none", false}, Choice<bool>{"front", true}};

/// "a, b or c"; `between` "|" for the help: "a|b|c".
template <class T, std::size_t N>
std::string choice_list(const std::array<Choice<T>, N>& choices, std::string_view between = "") {
  std::string text;
  for (std::size_t i = 0; i < N; ++i) {
    const std::string_view separator = !between.empty() ? between : i + 1 == N ? " or " : ", ";
    if (i > 0) text += separator;
    text += choices[i].name;
  }
  return text;
}

template <class T, std::size_t N>
Expected<T> parse_choice(const std::array<Choice<T>, N>& choices, const std::string& text) {
  for (const Choice<T>& choice : choices) {
    if (is_word(text, choice.name)) return choice.value;
  }
  return base::fail("found {}, expected {}", text, choice_list(choices));
}

template <class T, std::size_t N>
std::string choice_name(const std::array<Choice<T>, N>& choices, T value) {
  for (const Choice<T>& choice : choices) {
    if (choice.value == value) return std::string(choice.name);
  }
  return "";
}

}  // namespace tenebra::settings
