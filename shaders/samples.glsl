// A sample's triangle and place to the point that is seen (src/shade/triangle_setup.h and kernels.cpp do the same on
// the CPU, in double where this has floats). All points are relative to the eye: floats far from the world's origin
// differ exactly.
layout(std430, binding = 0) readonly buffer Positions { float positions[]; };
layout(std430, binding = 1) readonly buffer Triangles { uint triangles[]; };
layout(std430, binding = 2) readonly buffer Normals { float normals[]; };  // if u_has_normals
layout(std430, binding = 3) readonly buffer MaterialNumbers { uint material_numbers[]; };  // by triangle

layout(location = 0) uniform vec3 u_eye;
layout(location = 1) uniform vec3 u_d0;  // the rays of ViewRays
layout(location = 2) uniform vec3 u_dx;
layout(location = 3) uniform vec3 u_dy;
layout(location = 4) uniform bool u_orthographic;
layout(location = 5) uniform uint u_triangle_count;
layout(location = 6) uniform bool u_has_normals;
layout(location = 7) uniform bool u_smooth_terminator;

struct Seen {
  vec3 point;   // relative to the eye
  vec3 normal;  // unit shading normal, to the eye's side; normal maps bend it
  vec3 unbent;  // the same before
  vec3 face;    // unit normal of the triangle, to the eye's side
  vec3 before;  // light counts where this points to
  vec3 weights;  // of the triangle's vertices
  vec4 steps;    // what those of the second and third change by: a column further, and a row further
};

vec3 corner(uint vertex) { return vec3(positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]) - u_eye; }
vec3 corner_normal(uint vertex) { return vec3(normals[3 * vertex], normals[3 * vertex + 1], normals[3 * vertex + 2]); }
float size_of(vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

// Weights of the second and third vertex where the ray meets the triangle's plane, moved into the triangle. All but
// the place in units of 1 / scale metres.
vec2 weights_at(vec2 place, float scale, vec3 a, vec3 e1, vec3 e2, vec3 n, out vec4 steps) {
  vec3 across = place.x * u_dx + place.y * u_dy;
  vec3 from = u_orthographic ? scale * across : vec3(0.0), ray = u_orthographic ? u_d0 : u_d0 + across;
  float speed = dot(n, ray), area2 = dot(n, n);
  float t = dot(n, a - from) / speed;
  bool in_front = area2 > 0.0 && speed != 0.0 && (u_orthographic || t > 0.0) && abs(t) < 1e30;
  steps = vec4(0.0);
  if (!in_front) return vec2(1.0 / 3.0);
  float unit_size = u_orthographic ? scale : t;
  vec3 column = unit_size * (u_dx - dot(n, u_dx) / speed * ray), row = unit_size * (u_dy - dot(n, u_dy) / speed * ray);
  vec3 by_u = cross(e2, n) / area2, by_v = cross(n, e1) / area2;
  steps = vec4(dot(by_u, column), dot(by_v, column), dot(by_u, row), dot(by_v, row));
  vec3 inside = from + t * ray - a;
  vec2 w = vec2(dot(by_u, inside), dot(by_v, inside));
  float rest = 1.0 - w.x - w.y;
  if (w.x >= 0.0 && w.y >= 0.0 && rest >= 0.0) return w;
  vec2 held = max(w, vec2(0.0));
  float sum = held.x + held.y + max(rest, 0.0);
  return sum > 0.0 && sum < 1e30 ? held / sum : vec2(1.0 / 3.0);
}

Seen seen_at(uint id, vec2 place) {
  uvec3 t = uvec3(triangles[3 * id], triangles[3 * id + 1], triangles[3 * id + 2]);
  vec3 a = corner(t.x), e1 = corner(t.y) - a, e2 = corner(t.z) - a;
  // The longest edge to 1, so that the squares of small triangles do not vanish.
  float scale = 1.0 / max(max(size_of(e1), size_of(e2)), 1e-30);
  vec3 n = cross(scale * e1, scale * e2);
  Seen seen;
  vec2 w = weights_at(place, scale, scale * a, scale * e1, scale * e2, n, seen.steps);
  seen.weights = vec3(1.0 - w.x - w.y, w.x, w.y);
  seen.point = a + w.x * e1 + w.y * e2;
  float area = length(n), away = u_orthographic ? dot(n, u_d0) : dot(n, a);
  vec3 face = area > 0.0 ? n / (away > 0.0 ? -area : area) : vec3(0.0);
  seen.normal = seen.unbent = seen.face = face;
  seen.before = face;
  if (!u_has_normals) return seen;
  vec3 n0 = corner_normal(t.x), n1 = corner_normal(t.y), n2 = corner_normal(t.z);
  bool smooth_shaded = n0 != n1 || n0 != n2;
  vec3 m = smooth_shaded ? n0 + w.x * (n1 - n0) + w.y * (n2 - n0) : n0;
  if (size_of(m) > 1e-6) seen.normal = m / (dot(m, face) < 0.0 ? -length(m) : length(m));
  seen.unbent = seen.normal;
  vec3 along = vec3(dot(n0, face), dot(n1, face), dot(n2, face));
  bvec3 no_normal = bvec3(n0 == vec3(0.0), n1 == vec3(0.0), n2 == vec3(0.0));
  bool one = (along.x > 0.0 || no_normal.x) && (along.y > 0.0 || no_normal.y) && (along.z > 0.0 || no_normal.z);
  bool other = (along.x < 0.0 || no_normal.x) && (along.y < 0.0 || no_normal.y) && (along.z < 0.0 || no_normal.z);
  if (u_smooth_terminator && smooth_shaded && (one || other)) seen.before = seen.normal;
  return seen;
}
