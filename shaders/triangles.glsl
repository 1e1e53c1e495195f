// What the id of a triangle leads to (src/raster/geometry_buffers.cpp has the same layout).
const uint no_triangle = 0xffffffffu;

struct TriangleRecord {
  vec3 face_normal;
  uint material;
};
struct Material {
  vec4 base_color;
  vec4 ambient;
  vec4 emissive;
};
layout(std430, binding = 0) readonly buffer Triangles { TriangleRecord b_triangles[]; };
layout(std430, binding = 1) readonly buffer Materials { Material b_materials[]; };
