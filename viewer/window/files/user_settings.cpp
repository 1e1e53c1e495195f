#include "window/files/user_settings.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/fail.h"
#include "io/output_file.h"

namespace tenebra::viewer {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uintmax_t most_bytes = 1 << 20;
constexpr int least_side_px = 100;

/// Fails with a phrase.
Expected<UserSettings> settings_of(const Json& json) {
  UserSettings settings;
  const auto read = [&](const char* name, auto& value) {
    if (json.contains(name)) json.at(name).get_to(value);
  };
  try {
    if (!json.is_object()) return base::fail("found no JSON object");
    std::vector<int> window{settings.window.width, settings.window.height};
    read("window", window);
    const auto is_side = [](int side) { return side >= least_side_px && side <= largest_side_px; };
    if (window.size() != 2 || !std::all_of(window.begin(), window.end(), is_side))
      return base::fail("found a window of no size");
    settings.window = {window[0], window[1]};
    read("panel", settings.panel);
    read("research", settings.research);
    read("recent", settings.recent);
    read("folder", settings.folder);
  } catch (const Json::exception& error) {
    return base::fail("found something else ({})", error.what());
  }
  if (settings.recent.size() > UserSettings::most_recent) settings.recent.resize(UserSettings::most_recent);
  return settings;
}

}  // namespace

void UserSettings::remember(const std::string& file) {
  std::error_code none;
  const fs::path whole = fs::absolute(file, none).lexically_normal();
  std::erase(recent, whole.string());
  recent.insert(recent.begin(), whole.string());
  if (recent.size() > most_recent) recent.resize(most_recent);
  folder = whole.parent_path().string();
}

fs::path default_settings_file() {
  const auto absolute = [](const char* variable) {
    const char* value = std::getenv(variable);
    const fs::path path = value == nullptr ? "" : value;
    return path.is_absolute() ? path : fs::path();
  };
  if (const auto config = absolute("XDG_CONFIG_HOME"); !config.empty()) return config / "tenebra/viewer.json";
  const auto home = absolute("HOME");
  return home.empty() ? home : home / ".config/tenebra/viewer.json";
}

Expected<UserSettings> read_settings(const fs::path& file) {
  std::error_code none;
  if (file.empty() || !fs::exists(file, none)) return UserSettings{};
  const auto refuse = [&](const std::string& what) {
    return base::fail("settings {}: {}, expected a file that the window wrote; the defaults are used",
                      file.string(), what);
  };
  if (!fs::is_regular_file(file, none)) return refuse("found no file");
  if (fs::file_size(file, none) > most_bytes) return refuse("found more than 1 MiB");
  std::ifstream stream(file, std::ios::binary);
  const Json json = Json::parse(stream, nullptr, false);
  if (!stream.good() && !stream.eof()) return refuse("found nothing that can be read");
  if (json.is_discarded()) return refuse("found no JSON");
  auto settings = settings_of(json);
  if (!settings) return refuse(settings.error().message);
  return settings;
}

Expected<void> write_settings(const fs::path& file, const UserSettings& settings) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) return base::fail("settings {}: {}", file.string(), error.message());
  const Json json{{"window", {settings.window.width, settings.window.height}},
                  {"panel", settings.panel},
                  {"research", settings.research},
                  {"recent", settings.recent},
                  {"folder", settings.folder}};
  return io::write_file(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

SettingsKeeper::SettingsKeeper(const std::string& file) {
  if (file != "none") file_ = file.empty() ? default_settings_file() : fs::path(file);
  auto settings = read_settings(file_);
  if (settings) {
    settings_ = std::move(*settings);
  } else {
    problem_ = settings.error().message;
  }
}

Expected<void> SettingsKeeper::keep(const UserSettings& settings) const {
  return file_.empty() ? Expected<void>() : write_settings(file_, settings);
}

}  // namespace tenebra::viewer
