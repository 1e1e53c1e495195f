// Linear colours to what a picture shows, and on to its levels (src/shade/display.h and encoder.h on the CPU).
layout(location = 40) uniform float u_exposure;
layout(location = 41) uniform int u_tone;  // 0 none, 1 neutral, 2 aces
layout(location = 42) uniform bool u_srgb;
layout(location = 43) uniform float u_thresholds[256];  // the least value of each level

// NaN: 0.
float zero_to(float most, float v) { return v > 0.0 ? min(v, most) : 0.0; }
vec3 zero_to(float most, vec3 v) { return vec3(zero_to(most, v.x), zero_to(most, v.y), zero_to(most, v.z)); }

vec3 neutral_tone(vec3 color) {
  const float start = 0.8 - 0.04, room = 1.0 - start;
  float least = min(min(color.x, color.y), color.z);
  color -= least < 0.08 ? least - 6.25 * (least * least) : 0.04;
  float peak = max(max(color.x, color.y), color.z);
  if (!(start < peak)) return color;
  float compressed = 1.0 - room * room / (peak + (room - start));
  float kept = 1.0 / (0.15 * (peak - compressed) + 1.0);
  return kept * (compressed / peak) * color + compressed * (1.0 - kept);
}

vec3 aces_tone(vec3 color) {
  const mat3 to_film = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
  const mat3 from_film = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
  vec3 x = to_film * color;
  return from_film * ((x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081));
}

vec3 shown(vec3 color) {
  vec3 exposed = u_exposure * color;
  if (u_tone == 1) return zero_to(1.0, neutral_tone(zero_to(1e15, exposed)));
  if (u_tone == 2) return zero_to(1.0, aces_tone(zero_to(1e15, exposed)));
  return zero_to(1.0, exposed);
}

// The nearest level by the thresholds: the curve is a guess at it.
uint level_of(float v) {
  float guess = !u_srgb ? v : v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
  int level = int(clamp(255.0 * guess + 0.5, 0.0, 255.0));
  if (level < 255 && v >= u_thresholds[level + 1]) ++level;
  if (level > 0 && v < u_thresholds[level]) --level;
  return uint(level);
}
uint levels_of(vec3 v) { return level_of(v.x) | level_of(v.y) << 8 | level_of(v.z) << 16; }
