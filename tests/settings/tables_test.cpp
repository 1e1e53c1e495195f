// The tables of settings: what every row promises, whoever reads it.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "settings/tables.h"

namespace tenebra::settings {
namespace {

/// A value that is not the default, as text, for settings whose texts no rule makes.
const std::map<std::string_view, std::string> samples{
    {"light", "2"},
    {"exposure", "1.5"},
    {"simd", "scalar"},
    {"light-size", "0.5x0.25"},
    {"light-facing", "1,2.5,-3"},
    {"soft-memory", "300"},
    {"ao-distance", "1.5"},
    {"ao-directions", "64"},
    {"ao-cache", "none"},
    {"camera", "near"},
    {"eye", "1,2,3"},
    {"look-at", "4,5,6"},
    {"up", "0,0,1"},
    {"fov", "50"},
    {"size", "320x240"},
    {"scene", "second"},
    {"offset", "691234,5334567.5,0"},
    {"no-cast", "glass"},
    {"texture-path", "."},
    {"file-root", "."},
    {"environment", "sky.hdr"},
    {"set-light", "0 intensity=2"},
    {"add-light", "point position=0,0,0 intensity=1 color=1,1,1"},
    {"set-material", "0 roughness=0.5"},
    {"set-node", "1 visible=0"},
    {"time", "1.5"},
    {"clip", "walk"}};

/// Some value that is not the default.
template <class Part>
std::string other_value(const Setting<Part>& setting) {
  if (const auto sample = samples.find(setting.name); sample != samples.end()) return sample->second;
  if (setting.is_switch) return "true";
  const auto standard = setting.texts(Part{});
  for (const std::string_view word : setting.words)
    if (standard.empty() || word != standard.front()) return std::string(word);
  return std::to_string(static_cast<int>(setting.range.low) + 2);
}

template <class Part>
void expect_sound(std::span<const Setting<Part>> table, std::set<std::string_view>& names) {
  for (const Setting<Part>& setting : table) {
    EXPECT_TRUE(names.insert(setting.name).second) << setting.name << " stands twice";
    EXPECT_FALSE(setting.help.empty()) << setting.name;
    EXPECT_FALSE(setting.help.ends_with('.')) << setting.name;
    EXPECT_EQ(setting.help.find('\n'), std::string_view::npos) << setting.name;
    EXPECT_EQ(value_name(setting).empty(), setting.is_switch) << setting.name;
    for (const std::string_view other : {setting.needs, setting.excludes})
      EXPECT_TRUE(other.empty() || find_about(other) != nullptr) << setting.name;
    EXPECT_EQ(find_about(underscored(setting.name)), &setting) << "as logs write it";
    if (setting.range.high > 0) {
      EXPECT_LT(setting.range.low, setting.range.high) << setting.name;
    }
  }
}

TEST(SettingTables, DescribeEverySettingOnce) {
  std::set<std::string_view> names;
  expect_sound(scene_table(), names);
  expect_sound(method_table(), names);
  EXPECT_EQ(find_about("no-such-setting"), nullptr);
}

/// Each setting alone: its text gives its value back, another value is another setting, and a default is
/// none.
template <class Part>
void expect_round_trip(std::span<const Setting<Part>> table) {
  EXPECT_EQ(arguments(table, Part{}), "");
  for (const Setting<Part>& setting : table) {
    const std::string value = other_value(setting);
    Part base;
    if (const auto* needed = find(table, setting.needs)) {
      ASSERT_TRUE(needed->read(base, other_value(*needed))) << setting.name;
    }
    Part part = base, again = base;
    const auto read = setting.read(part, value);
    ASSERT_TRUE(read) << setting.name << ": " << read.error().message;
    ASSERT_EQ(setting.texts(part), std::vector<std::string>{value}) << setting.name;
    ASSERT_TRUE(setting.read(again, setting.texts(part).front())) << setting.name;
    EXPECT_FALSE(setting.same(part, base)) << setting.name;
    EXPECT_TRUE(setting.same(part, again)) << setting.name;
    EXPECT_NE(arguments(table, part).find(option_name(setting)), std::string::npos) << arguments(table, part);
    if (const auto standard = setting.texts(base); !standard.empty()) {
      ASSERT_TRUE(setting.read(part, standard.front())) << setting.name;
      EXPECT_TRUE(setting.same(part, base)) << setting.name;
    }
  }
}

TEST(SettingTables, ReadWhatTheyWrite) {
  expect_round_trip(scene_table());
  expect_round_trip(method_table());
}

template <class Part>
void expect_bounds(std::span<const Setting<Part>> table) {
  for (const Setting<Part>& setting : table) {
    EXPECT_EQ(setting.expected.empty(), setting.range.high == 0) << setting.name;
    if (setting.expected.empty()) continue;
    for (const double outside : {std::floor(setting.range.low) - 1, setting.range.high * 2 + 1}) {
      Part part;
      const std::string text = fmt::format("{}", outside);
      const auto read = setting.read(part, text);
      ASSERT_FALSE(read) << setting.name << " " << text;
      EXPECT_EQ(read.error().message, "found " + text + ", expected " + std::string(setting.expected));
    }
  }
}

TEST(SettingTables, RefuseBelowAndAboveEachRange) {
  expect_bounds(scene_table());
  expect_bounds(method_table());
}

TEST(SettingTables, TellMethodsApartByEverySetting) {
  EXPECT_EQ(MethodSettings{}, MethodSettings{});
  for (const auto& setting : method_table()) {
    MethodSettings method;
    ASSERT_TRUE(setting.read(method, other_value(setting)));
    EXPECT_NE(method, MethodSettings{}) << setting.name;
  }
}

TEST(SettingTables, HoldValuesOfEveryQuality) {
  for (const auto& setting : method_table()) {
    for (const std::string_view value : setting.by_quality) {
      MethodSettings method;
      EXPECT_TRUE(value.empty() || setting.read(method, std::string(value))) << setting.name << " " << value;
    }
  }
}

}  // namespace
}  // namespace tenebra::settings
