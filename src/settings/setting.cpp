#include "settings/setting.h"

#include <fmt/core.h>

#include <algorithm>

namespace tenebra::settings {

std::string_view group_title(Group group) {
  switch (group) {
    case Group::first:
      return "Used most";
    case Group::scene:
      return "Scene and moment";
    case Group::camera:
      return "Camera";
    case Group::picture:
      return "Picture";
    case Group::shadows:
      return "Shadows";
    case Group::ao:
      return "Ambient occlusion";
    case Group::output:
      return "Output";
    case Group::run:
      return "The run";
  }
  return "";
}

std::string value_name(const About& about) {
  if (about.words.empty()) return std::string(about.value);
  std::string names;
  for (const std::string_view word : about.words)
    names += fmt::format("{}{}", names.empty() ? "" : "|", word);
  return names;
}

std::string underscored(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

std::string dashed(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', '-');
  return text;
}

std::string shell_word(const std::string& word) {
  const auto is_plain = [](char c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    return letter || std::string_view("_-+=.,:/%@").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string given_as(const About& about) {
  if (!about.as.empty()) return std::string(about.as);
  if (about.audience == Audience::paper) return fmt::format("--paper {}=", about.name);
  return fmt::format("--{} ", about.name);
}

std::string option_name(const About& about) {
  std::string name = given_as(about);
  name.pop_back();
  return name;
}

std::string argument(const About& about, const std::string& value) {
  return about.is_switch ? option_name(about) : given_as(about) + shell_word(value);
}

}  // namespace tenebra::settings
