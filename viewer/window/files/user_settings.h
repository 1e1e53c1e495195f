// What the window remembers from run to run: its size, its panel, the scenes opened last. Not the methods:
// what is drawn is what the command line says.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "options/settings_names.h"

namespace tenebra::viewer {

struct UserSettings {
  static constexpr std::size_t most_recent = 12;

  Size window{1280, 720};
  bool panel = true;
  bool research = false;            ///< the panel's second level is open
  std::vector<std::string> recent;  ///< absolute names of scene files, the last one first
  std::string folder;               ///< where the last scene was chosen; empty: nowhere yet

  /// Puts `file` first.
  void remember(const std::string& file);
};

/// $XDG_CONFIG_HOME/tenebra/viewer.json, else $HOME/.config/tenebra/viewer.json; empty where neither is set.
std::filesystem::path default_settings_file();

/// No file: the defaults. Fails with a sentence on a file that cannot be read or holds anything else than
/// write_settings writes.
Expected<UserSettings> read_settings(const std::filesystem::path& file);
/// Makes the folder; the file is whole or as it was.
Expected<void> write_settings(const std::filesystem::path& file, const UserSettings& settings);

/// The settings of one session: read at its start, written at its end.
class SettingsKeeper {
public:
  explicit SettingsKeeper(const std::string& file);  ///< as --settings has it

  const UserSettings& settings() const { return settings_; }
  const std::string& problem() const { return problem_; }  ///< a sentence about a broken file; else empty
  Expected<void> keep(const UserSettings& settings) const;

private:
  std::filesystem::path file_;  // empty: nothing is kept
  UserSettings settings_;
  std::string problem_;
};

}  // namespace tenebra::viewer
