// What samples see of textures: src/texture/sampler.cpp in GLSL, on the same texels (src/texture/mip_texture.h), so
// that pictures do not depend on a driver's sampler.
layout(std430, binding = 8) readonly buffer Textures { uint texture_words[]; };  // heads, then texels of two words
layout(std430, binding = 9) readonly buffer Planes { float planes[]; };  // of each triangle and rule, six floats
layout(location = 18) uniform uint u_rules;      // of the coordinates of a triangle, at most; 0: no textures
layout(location = 19) uniform float u_width_px;  // textures are smoothed as widely as for pixels of this width

const int head_words = 38;  // width, height, levels, wrap_u, wrap_v, where the texels begin, starts of levels
const uint no_plane = 0x7fc00000u;  // in place of a first number: the triangle has no coordinates and no colours
const float most_taps = 16.0;

bool has_planes(uint id) { return u_rules > 0 && floatBitsToUint(planes[6 * id * u_rules]) != no_plane; }

float folded(float x, int wrap) {
  if (wrap == 1) return clamp(x, 0.0, 1.0);
  if (wrap == 0) return x - floor(x);
  float within = x - 2.0 * floor(0.5 * x);
  return min(within, 2.0 - within);
}

vec4 texel_at(int texels, int i) {
  uint low = texture_words[texels + 2 * i], high = texture_words[texels + 2 * i + 1];
  return vec4(low & 0xffffu, low >> 16, high & 0xffffu, high >> 16);
}

vec4 level_at(int head, int level, vec2 at, float middle) {
  ivec2 size = max(ivec2(texture_words[head], texture_words[head + 1]) >> level, ivec2(1));
  int texels = int(texture_words[head + 5]), stride = size.x + 2;
  vec2 x = at * vec2(size) - middle, cell = min(floor(x), vec2(size - 1));
  vec2 part = middle > 0.0 ? x - cell : vec2(0.0);
  int first = int(texture_words[head + 6 + level]) + int(cell.y) * stride + int(cell.x);
  vec4 left = mix(texel_at(texels, first), texel_at(texels, first + stride), part.y);
  vec4 right = mix(texel_at(texels, first + 1), texel_at(texels, first + stride + 1), part.y);
  return mix(left, right, part.x);
}

// A step in pixels of level 0, at most 1e9; no number counts as 1e9.
vec2 held_step(vec2 step_size) {
  return vec2(abs(step_size.x) <= 1e9 ? step_size.x : (step_size.x < 0.0 ? -1e9 : 1e9),
              abs(step_size.y) <= 1e9 ? step_size.y : (step_size.y < 0.0 ? -1e9 : 1e9));
}

// `use`: the rule of the coordinates; bits 8 magnify and 9 minify: 1 linear; from 10 on: 1 the nearest level, 2 mixed.
vec4 texture_at(int number, int use, uint id, vec3 weights, vec4 steps) {
  if (number < 0) return vec4(1.0);
  uint plane = 6 * (id * u_rules + uint(use & 255));
  vec2 first = vec2(planes[plane], planes[plane + 1]), second = vec2(planes[plane + 2], planes[plane + 3]),
       third = vec2(planes[plane + 4], planes[plane + 5]);
  vec2 at = first + (weights.y * second + weights.z * third);
  int head = head_words * number, levels = int(texture_words[head + 2]), mip = use >> 10;
  vec2 size = vec2(texture_words[head], texture_words[head + 1]);
  vec2 p1 = held_step(u_width_px * (steps.x * second + steps.y * third) * size),
       p2 = held_step(u_width_px * (steps.z * second + steps.w * third) * size);
  // The ellipse that the sample sees of level 0, in its pixels.
  float a = p1.x * p1.x + p2.x * p2.x, b = p1.x * p1.y + p2.x * p2.y, c = p1.y * p1.y + p2.y * p2.y;
  float half_gap = 0.5 * (a - c), root = sqrt(half_gap * half_gap + b * b);
  float major = sqrt(0.5 * (a + c) + root), minor = abs(p1.x * p2.y - p1.y * p2.x) / max(major, 1.0);
  vec2 along = c <= a ? vec2(half_gap + root, b) : vec2(b, root - half_gap);
  float along_length = length(along);
  vec2 axis = along_length > 0.0 ? major / along_length * along / size : vec2(0.0);
  bool usable = abs(at.x) < 1e9 && abs(at.y) < 1e9, smaller = usable && major > 1.0;
  if (!usable) at = 0.5 / size;
  float taps = 1.0, level = 0.0;
  if (smaller && (use >> 9 & 1) != 0 && mip != 0 && levels > 1)
    taps = max(ceil(min(major / max(minor, 1.0) - 1e-3, most_taps)), 1.0);
  if (smaller && mip != 0) level = min(log2(max(major / taps, 1.0)), float(levels - 1));
  if (mip == 1) level = floor(level + 0.5);
  int lower = int(level), upper = min(lower + 1, levels - 1);
  float part = level - float(lower), middle = (smaller ? use >> 9 & 1 : use >> 8 & 1) != 0 ? 0.5 : 0.0;
  vec4 sharp = vec4(0.0), blurred = vec4(0.0);
  for (float tap = 0.0; tap < taps; tap += 1.0) {
    vec2 there = at + (taps > 1.0 ? (tap + 0.5) / taps - 0.5 : 0.0) * axis;
    there = vec2(folded(there.x, int(texture_words[head + 3])), folded(there.y, int(texture_words[head + 4])));
    sharp += level_at(head, lower, there, middle);
    if (part > 0.0) blurred += level_at(head, upper, there, middle);
  }
  return min(mix(sharp, blurred, part) / (65535.0 * taps), vec4(1.0));
}
