// Values from the text that a user types: numbers, vectors and sizes, or a sentence of what was expected.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tenebra/expected.h>
#include "base/lower_case.h"
#include "base/number_in.h"

namespace tenebra::settings {

using base::lower_case;  ///< users may write words in any case
/// Whether `text` is `word` in any case.
bool is_word(std::string_view text, std::string_view word);
/// What stands between the separators; at least one part.
std::vector<std::string_view> split(std::string_view text, char separator);

/// The whole of `text` as a number.
template <class Number>
std::optional<Number> number_from(std::string_view text) {
  return base::number_in<Number>(text);
}
std::optional<double> finite_from(std::string_view text);

inline constexpr int largest_count = 1'000'000;  ///< that users may ask for

/// Width and height, in metres or in percent of the scene's diagonal.
struct LightSize {
  glm::vec2 size{0.0f};
  bool percent = false;

  bool operator==(const LightSize&) const = default;
};

Expected<glm::vec3> parse_vector(const std::string& text);      ///< X,Y,Z, finite
std::string vector_text(const glm::vec3& v);                    ///< as parse_vector takes it
Expected<glm::dvec3> parse_place(const std::string& text);      ///< X,Y,Z, finite, all digits kept
std::string place_text(const glm::dvec3& v);                    ///< as parse_place takes it
Expected<double> parse_positive(const std::string& text);       ///< finite and above 0
Expected<float> parse_factor(const std::string& text);          ///< above 0, at most 1e30
Expected<double> parse_time(const std::string& text);           ///< seconds, finite
Expected<int> parse_count(const std::string& text);             ///< whole, 0 to 1,000,000
Expected<int> parse_at_least_one(const std::string& text);      ///< whole, 1 to 1,000,000
Expected<LightSize> parse_light_size(const std::string& text);  ///< W, WxH, W% or WxH%
Expected<float> parse_sun_size(const std::string& text);        ///< degrees, 0 to 90

}  // namespace tenebra::settings
