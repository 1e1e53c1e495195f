#include "commands/render_identity.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "io/file_hash.h"
#include "settings/tables.h"

namespace tenebra::viewer {
namespace {

/// What a log says beside the settings and leaves every bit of every picture as it is.
constexpr std::array<std::string_view, 9> without_effect{"machine",   "LP_NUM_THREADS",     "scene",
                                                         "triangles", "dropped_non_finite", "frames",
                                                         "warning",   "settings_hash",      "note"};

bool has_effect(const std::string& name) {
  if (std::find(without_effect.begin(), without_effect.end(), name) != without_effect.end()) return false;
  const settings::About* about = settings::find_about(name);
  return about == nullptr || about->affects == settings::Affects::picture;
}

/// Without folders: they may be named in several ways.
std::string outputs_text(const RenderOptions& options) {
  std::string text = pictures_text(options.pictures);
  const auto add = [&](const char* name, const std::vector<OutputPattern>& patterns) {
    for (const OutputPattern& pattern : patterns)
      text += fmt::format(", {} {}", name, std::filesystem::path(pattern.text()).filename().string());
  };
  add("--mask", options.masks);
  add("--mask colour", options.mask_colours);
  add("--mask mean", options.mask_means);
  add("--mask error", options.error_maps);
  add("--mask samples", options.mask_samples);
  return text;
}

/// Values by name; what a log names twice, in its order.
std::map<std::string, std::string> by_name(std::span<const render::LogSetting> settings) {
  std::map<std::string, std::string> values;
  for (const render::LogSetting& setting : settings) {
    std::string& value = values[setting.name];
    value += (value.empty() ? "" : "; ") + setting.value;
  }
  return values;
}

}  // namespace

Expected<std::vector<render::LogSetting>> describe_sources(const RenderPlan& plan,
                                                           const RenderOptions& options) {
  const auto program = io::file_hash("/proc/self/exe");
  if (!program) return tl::unexpected(program.error());
  std::string hashes;
  for (const auto& file : plan.staged->inputs) {
    const auto hash = io::file_hash(file);
    if (!hash) return tl::unexpected(hash.error());
    hashes += *hash;
  }
  std::vector<render::LogSetting> list{
      {"program", fmt::format("tenebra {} {}", TENEBRA_VERSION, *program)},
      {"input_files", fmt::format("{}, {}", plan.staged->inputs.size(), io::text_hash(hashes))},
      {"fps", fmt::format("{}", options.scene.fps)},
      {"outputs", outputs_text(options)}};
  if (options.scene.time_s) list.push_back({"time", fmt::format("{} s", *options.scene.time_s)});
  return list;
}

std::vector<render::LogSetting> identity_of(std::span<const render::LogSetting> all) {
  std::vector<render::LogSetting> identity;
  for (const render::LogSetting& setting : all)
    if (has_effect(setting.name)) identity.push_back(setting);
  return identity;
}

std::optional<std::string> first_difference(std::span<const render::LogSetting> was,
                                            std::span<const render::LogSetting> is) {
  const auto before = by_name(was), now = by_name(is);
  const auto value_in = [](const auto& values, const std::string& name) {
    const auto entry = values.find(name);
    return entry == values.end() ? std::string("none") : entry->second;
  };
  auto names = before;
  names.insert(now.begin(), now.end());
  for (const auto& [name, unused] : names) {
    const std::string old_value = value_in(before, name), value = value_in(now, name);
    if (old_value != value) return fmt::format("{} {}, found {}", name, old_value, value);
  }
  return {};
}

}  // namespace tenebra::viewer
