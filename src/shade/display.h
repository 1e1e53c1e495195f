// From a sample's linear colour to what a picture shows of it: exposure, tone and clamp, before the transfer
// curve of encoder.h. Pixels with several samples are the mean of what their samples show.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string_view>

#include <tenebra/material.h>

namespace tenebra::shade {

/// How bright colours are fitted into 0..1. All of them are continuous.
enum class Tone {
  none,     ///< they are cut off
  neutral,  ///< Khronos PBR Neutral 1.0: 0.04, a surface's reflection, is taken off; what is then above 0.76
            ///< is compressed
  aces      ///< Hill's fit to ACES 1.0, reference rendering and sRGB output: film-like, darker in the shade
};
inline constexpr std::array tones{Tone::none, Tone::neutral, Tone::aces};
std::string_view tone_name(Tone tone);

/// How a picture shows linear colours: transfer(clamp(tone(exposure * colour))).
struct Display {
  float exposure = 1;
  Tone tone = Tone::none;
  Transfer transfer = Transfer::srgb;
};

/// clamp(tone(exposure * color)): each channel 0..1. Channels below 0 and NaN count as 0, and tones take
/// values beyond 1e15 as 1e15. The kernels' vector form (display-inl.h) gives the same bits.
glm::vec3 shown(const Display& display, const glm::vec3& color);

/// Writes what is shown as three levels.
void encode_shown(const Display& display, const glm::vec3& shown_color, std::uint8_t* rgb);

// Constants of the curves, for both forms.

/// github.com/KhronosGroup/ToneMapping, "Khronos PBR Neutral".
namespace neutral {
inline constexpr float reflection = 0.04f;         ///< of dielectrics at 0 degrees, taken off
inline constexpr float toe_end = 0.08f;            ///< from this least channel on, all of it is taken off
inline constexpr float toe = 6.25f;                ///< below, min - toe * min^2 is taken off
inline constexpr float start = 0.8f - reflection;  ///< of compression
inline constexpr float room = 1 - start;           ///< for all that is brighter
inline constexpr float desaturation = 0.15f;
}  // namespace neutral

namespace aces {
/// Rows: linear sRGB to the rendering primaries (AP1, less saturated by 0.96).
inline constexpr float input[3][3] = {
    {0.59719f, 0.35458f, 0.04823f}, {0.07600f, 0.90834f, 0.01566f}, {0.02840f, 0.13383f, 0.83777f}};
/// Rows: and back, less saturated by 0.93.
inline constexpr float output[3][3] = {
    {1.60475f, -0.53108f, -0.07367f}, {-0.10208f, 1.10813f, -0.00605f}, {-0.00327f, -0.07276f, 1.07602f}};
/// The curve: (x (x + a) - b) / (x (c x + d) + e).
inline constexpr float a = 0.0245786f, b = 0.000090537f, c = 0.983729f, d = 0.4329510f, e = 0.238081f;
}  // namespace aces

inline constexpr float most_toned = 1e15f;  ///< its square is still far from overflow

}  // namespace tenebra::shade
