// One setting as all who offer it need it: its name, its values, what it says, and where its value is kept.
// The tables of settings/tables.h list them; command line, files of options, window, log and documentation
// read these.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tenebra/expected.h>

namespace tenebra::settings {

/// Whom a setting is for. `paper`: the methods of the papers and experiments on them, out of the way of
/// others.
enum class Audience { user, paper };
/// What a setting changes: what pictures show, how long they take, or which files there are and where.
enum class Affects { picture, speed, files };
/// What a setting belongs to, in the order of the help.
enum class Group { first, scene, camera, picture, shadows, ao, output, run };
/// Under which other settings a setting of the method does something.
enum class Used {
  always,
  with_accuracy,
  with_shadows,
  with_soft,
  with_soft_exact,
  with_ao,
  with_adaptive,
  with_other_ao,
  with_fields
};

/// Numbers from `low` to `high`, and 0 too if `or_zero`.
struct Range {
  double low = 0, high = 0;
  bool or_zero = false;
};

/// What is said of a setting, wherever its value is kept.
struct About {
  std::string_view name;        ///< "soft-error": --soft-error, soft_error in logs and Python
  std::string_view value{};     ///< what stands for its value in texts: "E"; words: empty; a switch: empty
  std::string_view help;        ///< sentences without the default
  std::string_view standard{};  ///< what not giving it stands for, where that is no value: "the camera's"
  Group group = Group::first;
  Affects affects = Affects::picture;
  Audience audience = Audience::user;
  Used used = Used::always;
  Range range{};                ///< of numbers
  std::string_view expected{};  ///< how a refusal describes the range: "1 to 1024, or 0 for all cores"
  std::string_view needs{}, excludes{};  ///< the name of a setting to be given with it, or not
  std::array<std::string_view, 3>
      by_quality{};  ///< values at --quality fast, balanced and exact; empty: none
  /// How it is given, where that is not --name VALUE: "--memory soft:". The option of its own name is then
  /// an old one, which works for one version; in Python that name is the keyword. Settings for papers:
  /// "--paper name=".
  std::string_view as{};
  std::string_view letter{};              ///< of -o
  bool is_switch = false;                 ///< true where it is given without a value
  bool several = false;                   ///< may be given several times
  bool has_keys = false;                  ///< other settings are given by keys of it: their `as` names it
  std::vector<std::string_view> words{};  ///< if its value is one of them
};

/// A setting whose value is kept in a `Part`.
template <class Part>
struct Setting : About {
  /// Sets it from one text; of settings that may be given several times, adds one value.
  std::function<Expected<void>(Part&, const std::string&)> read;
  /// Its values as `read` takes them; none where nothing is set.
  std::function<std::vector<std::string>(const Part&)> texts;
  /// Whether both have the same value.
  std::function<bool(const Part&, const Part&)> same;

  /// Its value, else what stands for it: as logs have it.
  std::string text(const Part& part) const {
    const auto values = texts(part);
    return values.empty() ? std::string(standard) : values.front();
  }
};

/// The setting of that name; null: there is none.
template <class Part>
const Setting<Part>* find(std::span<const Setting<Part>> table, std::string_view name) {
  for (const Setting<Part>& setting : table)
    if (setting.name == name) return &setting;
  return nullptr;
}

/// The heading of the help that settings of this group stand under.
std::string_view group_title(Group group);

/// What stands for the value in texts: "E", "none|hard|soft".
std::string value_name(const About& about);
/// The default in words, or as the value in `part`, where nothing was read yet; empty: there is none.
template <class Part>
std::string standard_text(const Setting<Part>& setting, const Part& part = {}) {
  if (setting.is_switch) return "";
  return setting.standard.empty() ? setting.text(part) : std::string(setting.standard);
}
/// How it is given, up to its value: "--soft-error ", "--paper soft-solver=", "--memory soft:".
std::string given_as(const About& about);
/// What users call it: "--soft-error", "--paper soft-solver", "--memory soft".
std::string option_name(const About& about);
/// The name in logs and in Python: "soft_error".
std::string underscored(std::string_view name);
/// The same name as tables and options have it: "soft-error".
std::string dashed(std::string_view name);

/// `word` as a POSIX shell takes it for one word: quoted where it must be.
std::string shell_word(const std::string& word);
/// One setting of these: "--name value", "--paper name=value".
std::string argument(const About& about, const std::string& value);

/// "--shadows soft --paper soft-solver=bsp ...": every setting whose value is not the default, in the table's
/// order; of `names` alone, where these are given. Read again it gives the same settings.
template <class Part>
std::string arguments(std::span<const Setting<Part>> table, const Part& part,
                      std::initializer_list<std::string_view> names = {}) {
  const Part standard;
  std::string text;
  for (const Setting<Part>& setting : table) {
    const bool wanted =
        names.size() == 0 || std::find(names.begin(), names.end(), setting.name) != names.end();
    if (!wanted || setting.same(part, standard)) continue;
    for (const std::string& value : setting.texts(part))
      text += (text.empty() ? "" : " ") + argument(setting, value);
  }
  return text;
}

}  // namespace tenebra::settings
