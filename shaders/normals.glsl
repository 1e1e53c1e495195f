// Normals in 32 bits: the sphere folded to an octahedron, the octahedron to a square of 2 x 16 bits (error below
// 1e-4 rad). No direction gives the code for "no normal": packing never yields -32768.
const uint no_normal = 0x80008000u;

vec2 fold(vec2 v) { return (1.0 - abs(v.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(v, vec2(0.0))); }

uint pack_normal(vec3 n) {
  float size = abs(n.x) + abs(n.y) + abs(n.z);
  if (!(size > 1e-6)) return no_normal;
  vec2 v = n.xy / size;
  return packSnorm2x16(n.z < 0.0 ? fold(v) : v);
}

vec3 unpack_normal(uint code) {
  vec2 v = unpackSnorm2x16(code);
  float z = 1.0 - abs(v.x) - abs(v.y);
  return normalize(vec3(z < 0.0 ? fold(v) : v, z));
}
