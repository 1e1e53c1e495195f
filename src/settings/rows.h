// How the rows of the tables are made: from what is said of a setting and a function that finds its value.
#pragma once

#include <fmt/core.h>

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/fail.h"
#include "settings/choices.h"
#include "settings/setting.h"

namespace tenebra::settings {

template <class T>
struct Bare {
  using Type = T;
};
template <class T>
struct Bare<std::optional<T>> {
  using Type = T;
};

/// None if an optional value is not there.
template <class T>
const T* value_in(const T& value) {
  return &value;
}
template <class T>
const T* value_in(const std::optional<T>& value) {
  return value ? &*value : nullptr;
}

/// "found x, expected `about.expected`" on what is no number or out of range.
Expected<double> parse_in_range(const About& about, const std::string& text);
Expected<int> parse_whole_in_range(const About& about, const std::string& text);
/// true, yes, on and 1; false, no, off and 0; in any case.
Expected<bool> parse_switch(const std::string& text);

/// Makes rows of a table of settings that are kept in a Part. `get` returns a reference to the member, which
/// may be optional.
template <class Part>
struct Rows {
  template <class Get>
  using Member = std::remove_cvref_t<decltype(std::declval<Get>()(std::declval<Part&>()))>;
  template <class Get>
  using Value = typename Bare<Member<Get>>::Type;

  /// A value that `parse` reads and `print` writes.
  template <class Get, class Parse, class Print>
  static Setting<Part> value(About about, Get get, Parse parse, Print print) {
    Setting<Part> row = of(std::move(about), get);
    row.read = [get, parse](Part& part, const std::string& text) -> Expected<void> {
      auto value = parse(text);
      if (!value) return tl::unexpected(std::move(value.error()));
      get(part) = std::move(*value);
      return {};
    };
    row.texts = [get, print](const Part& part) {
      const auto* value = value_in(get(part));
      return value == nullptr ? std::vector<std::string>() : std::vector<std::string>{print(*value)};
    };
    return row;
  }

  /// A number within the range of `about`, a whole one where the member is.
  template <class Get>
  static Setting<Part> number(About about, Get get) {
    const auto print = [](const auto& value) { return fmt::format("{}", value); };
    const auto parse = [about](const std::string& text) {
      if constexpr (std::is_integral_v<Value<Get>>) {
        return parse_whole_in_range(about, text);
      } else {
        return parse_in_range(about, text).map([](double value) { return static_cast<Value<Get>>(value); });
      }
    };
    return value(about, get, parse, print);
  }

  /// One of the words of `choices`.
  template <class Get, class T, std::size_t N>
  static Setting<Part> words(About about, Get get, const std::array<Choice<T>, N>& choices) {
    for (const Choice<T>& choice : choices) about.words.push_back(choice.name);
    const auto parse = [choices](const std::string& text) { return parse_choice(choices, text); };
    return value(std::move(about), get, parse,
                 [choices](const T& value) { return choice_name(choices, value); });
  }

  /// A text as it stands; an empty one stands for none.
  template <class Get>
  static Setting<Part> text(About about, Get get) {
    Setting<Part> row = of(std::move(about), get);
    row.read = [get](Part& part, const std::string& text) -> Expected<void> {
      get(part) = text;
      return {};
    };
    row.texts = [get](const Part& part) {
      const std::string* value = value_in(get(part));
      const bool none = value == nullptr || (!is_optional<Get> && value->empty());
      return none ? std::vector<std::string>() : std::vector<std::string>{*value};
    };
    return row;
  }

  /// True where it is given.
  template <class Get>
  static Setting<Part> flag(About about, Get get) {
    about.is_switch = true;
    Setting<Part> row = of(std::move(about), get);
    row.read = [get](Part& part, const std::string& text) -> Expected<void> {
      const auto value = parse_switch(text);
      if (!value) return tl::unexpected(value.error());
      get(part) = *value;
      return {};
    };
    row.texts = [get](const Part& part) {
      return get(part) ? std::vector<std::string>{"true"} : std::vector<std::string>();
    };
    return row;
  }

  /// One that reads and writes itself.
  template <class Read, class Texts>
  static Setting<Part> own(About about, Read read, Texts texts) {
    const auto same = [texts](const Part& a, const Part& b) { return texts(a) == texts(b); };
    return {std::move(about), std::move(read), texts, same};
  }

private:
  template <class Get>
  static Setting<Part> of(About about, Get get) {
    return {std::move(about), {}, {}, [get](const Part& a, const Part& b) { return get(a) == get(b); }};
  }
  template <class Get>
  static constexpr bool is_optional = !std::is_same_v<Member<Get>, Value<Get>>;
};

}  // namespace tenebra::settings
