// Values of options: from the text a user types to numbers, sizes and ranges, or a sentence of what was
// expected.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include <tenebra/expected.h>
#include <tenebra/simd_level.h>
#include "settings/values.h"

namespace tenebra::viewer {

using settings::largest_side_px;
using settings::Size;

/// Width and height of an area light, in metres or in percent of the scene's diagonal.
struct LightSize {
  glm::vec2 size{0.0f};
  bool percent = false;
};

/// Frames first, first + step, ... up to and with `last`; without `last`: to the end of the animation.
struct FrameRange {
  int first = 0;
  std::optional<int> last;
  int step = 1;
};

/// Part `index` of `count` parts, from 1.
struct Chunk {
  int index = 1;
  int count = 1;
};

Expected<Size> parse_size(const std::string& text);               ///< WxH, 1 to largest_side_px each
Expected<FrameRange> parse_frame_range(const std::string& text);  ///< A, A:B, A:, A:B:STEP, A::STEP or all
Expected<Chunk> parse_chunk(const std::string& text);             ///< I/N, 1 <= I <= N
Expected<glm::vec3> parse_vector(const std::string& text);        ///< X,Y,Z, finite
Expected<double> parse_field_of_view(const std::string& text);    ///< degrees in (0, 180)
Expected<double> parse_positive(const std::string& text);         ///< finite and above 0
Expected<float> parse_factor(const std::string& text);            ///< above 0, at most 1e30
Expected<double> parse_time(const std::string& text);             ///< seconds, finite
Expected<int> parse_count(const std::string& text);               ///< whole, 0 to 1,000,000
Expected<int> parse_at_least_one(const std::string& text);        ///< whole, 1 to 1,000,000
Expected<int> parse_square_count(const std::string& text);        ///< N or WxH of them, 1 to 1,000,000 in all
Expected<LightSize> parse_light_size(const std::string& text);    ///< W, WxH, W% or WxH%
Expected<float> parse_sun_size(const std::string& text);          ///< degrees, 0 to 90
Expected<int> parse_light(const std::string& text);               ///< a number from 0, or all: -1
Expected<int> parse_threads(const std::string& text);             ///< 0 (all cores) to 1024
Expected<SimdLevel> parse_simd(const std::string& text);          ///< one that this machine has
Expected<double> parse_soft_error(const std::string& text);       ///< 0, or 0.1 to 255

/// Folder for files that can be made again, by the XDG rules: $XDG_CACHE_HOME/tenebra, else
/// $HOME/.cache/tenebra; empty where neither is set.
std::filesystem::path default_cache_folder();

}  // namespace tenebra::viewer
