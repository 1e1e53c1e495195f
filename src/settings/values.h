// Values of settings that text_values.h does not have: sizes of pictures, ranges of frames, and the like.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <tenebra/expected.h>
#include <tenebra/simd_level.h>
#include "settings/text_values.h"

namespace tenebra::settings {

struct Size {
  int width = 0;
  int height = 0;

  bool operator==(const Size&) const = default;
};
inline constexpr int largest_side_px = 16384;

/// Frames first, first + step, ... up to and with `last`; without `last`: to the end of the animation.
struct FrameRange {
  int first = 0;
  std::optional<int> last;
  int step = 1;

  bool operator==(const FrameRange&) const = default;
};

/// Part `index` of `count` parts, from 1.
struct Chunk {
  int index = 1;
  int count = 1;

  bool operator==(const Chunk&) const = default;
};

Expected<Size> parse_size(const std::string& text);               ///< WxH, 1 to largest_side_px each
Expected<FrameRange> parse_frame_range(const std::string& text);  ///< A, A:B, A:, A:B:STEP, A::STEP or all
Expected<Chunk> parse_chunk(const std::string& text);             ///< I/N, 1 <= I <= N
Expected<double> parse_field_of_view(const std::string& text);    ///< degrees in (0, 180)
Expected<int> parse_square_count(const std::string& text);        ///< N or WxH of them, 1 to 1,000,000 in all
Expected<int> parse_light(const std::string& text);               ///< a number from 0, or all: -1
Expected<SimdLevel> parse_simd(const std::string& text);          ///< one that this machine has

/// Folder for files that can be made again, by the XDG rules: $XDG_CACHE_HOME/tenebra, else
/// $HOME/.cache/tenebra; empty where neither is set.
std::filesystem::path default_cache_folder();

}  // namespace tenebra::settings
