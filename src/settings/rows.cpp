#include "settings/rows.h"

#include "settings/text_values.h"

namespace tenebra::settings {
namespace {

bool is_within(const Range& range, double value) {
  return (value >= range.low && value <= range.high) || (range.or_zero && value == 0);
}

tl::unexpected<Error> refuse(const About& about, const std::string& text) {
  return base::fail("found {}, expected {}", text, about.expected);
}

}  // namespace

Expected<double> parse_in_range(const About& about, const std::string& text) {
  const auto value = finite_from(text);
  if (!value || !is_within(about.range, *value)) return refuse(about, text);
  return *value;
}

Expected<int> parse_whole_in_range(const About& about, const std::string& text) {
  const auto value = number_from<int>(text);
  if (!value || !is_within(about.range, *value)) return refuse(about, text);
  return *value;
}

Expected<bool> parse_switch(const std::string& text) {
  for (const char* word : {"true", "yes", "on", "1"})
    if (is_word(text, word)) return true;
  for (const char* word : {"false", "no", "off", "0"})
    if (is_word(text, word)) return false;
  return base::fail("found {}, expected yes or no", text);
}

}  // namespace tenebra::settings
