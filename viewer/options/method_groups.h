// What the files share that add the options of methods: their groups in --help, and how options are added to
// these.
#pragma once

#include <initializer_list>

#include "options/choices.h"
#include "options/method_options.h"

namespace tenebra::viewer {

inline constexpr const char* shadow_group = "Shadows";
inline constexpr const char* hard_group = "Hard shadows";
inline constexpr const char* soft_group = "Soft shadows";
inline constexpr const char* ao_group = "Ambient occlusion";

inline constexpr const char* points_option = "--soft-points";
inline constexpr const char* soft_error_option = "--soft-error";

template <const auto& choices, class Target>
AddedOption add_choice(CLI::App& command, const char* name, Target& target, const char* help) {
  const auto parse = +[](const std::string& text) { return parse_choice(choices, text); };
  return add_value(command, name, target, parse, help).type_name(choice_list(choices, "|"));
}

inline void set_group(std::initializer_list<AddedOption> options, const char* group) {
  for (const AddedOption option : options) option.group(group);
}

/// The options of soft shadows (soft_options.cpp).
void add_soft_options(CLI::App& command, MethodOptions& options);

}  // namespace tenebra::viewer
