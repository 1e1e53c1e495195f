#include "shade/display.h"

#include <algorithm>

#include "shade/encoder.h"

namespace tenebra::shade {
namespace {

using glm::vec3;

float clamped(float value, float most) {
  return value > 0 ? std::min(value, most) : 0.0f;  // NaN: 0
}
vec3 clamped(const vec3& color, float most) {
  return {clamped(color.x, most), clamped(color.y, most), clamped(color.z, most)};
}

vec3 neutral_tone(vec3 color) {
  const float least = std::min(std::min(color.x, color.y), color.z);
  const float offset =
      least < neutral::toe_end ? least - neutral::toe * (least * least) : neutral::reflection;
  color -= vec3(offset);
  const float peak = std::max(std::max(color.x, color.y), color.z);
  if (!(neutral::start < peak)) return color;
  const float compressed = 1 - neutral::room * neutral::room / (peak + (neutral::room - neutral::start));
  const float kept = 1 / (neutral::desaturation * (peak - compressed) + 1);
  const float scale = kept * (compressed / peak), white = compressed * (1 - kept);
  return {scale * color.x + white, scale * color.y + white, scale * color.z + white};
}

vec3 times(const float (&rows)[3][3], const vec3& v) {
  vec3 out;
  for (int k = 0; k < 3; ++k) out[k] = rows[k][0] * v.x + rows[k][1] * v.y + rows[k][2] * v.z;
  return out;
}
float aces_curve(float x) {
  return (x * (x + aces::a) - aces::b) / (x * (aces::c * x + aces::d) + aces::e);
}
vec3 aces_tone(const vec3& color) {
  const vec3 film = times(aces::input, color);
  return times(aces::output, {aces_curve(film.x), aces_curve(film.y), aces_curve(film.z)});
}

}  // namespace

std::string_view tone_name(Tone tone) {
  switch (tone) {
    case Tone::none:
      return "none";
    case Tone::neutral:
      return "neutral";
    case Tone::aces:
      return "aces";
  }
  return "";
}

vec3 shown(const Display& display, const vec3& color) {
  const vec3 exposed(display.exposure * color.x, display.exposure * color.y, display.exposure * color.z);
  switch (display.tone) {
    case Tone::none:
      break;
    case Tone::neutral:
      return clamped(neutral_tone(clamped(exposed, most_toned)), 1.0f);
    case Tone::aces:
      return clamped(aces_tone(clamped(exposed, most_toned)), 1.0f);
  }
  return clamped(exposed, 1.0f);
}

void encode_shown(const Display& display, const vec3& shown_color, std::uint8_t* rgb) {
  const LevelTable& table = level_table(display.transfer);
  for (int c = 0; c < 3; ++c) rgb[c] = encode(table, shown_color[c]);
}

}  // namespace tenebra::shade
