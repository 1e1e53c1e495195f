// What the id of a triangle leads to (src/raster/geometry_buffers.cpp has the same layout). Buffer textures: a
// software rasteriser fetches a whole texel at once where it gathers storage buffers float by float.
const uint no_triangle = 0xffffffffu;
layout(binding = 8) uniform samplerBuffer t_triangles;  // face normal, bits of the material's index
layout(binding = 9) uniform samplerBuffer t_materials;  // base colour, ambient, emissive

vec4 triangle_record(uint id) { return texelFetch(t_triangles, int(id)); }
int material_of(vec4 record) { return 3 * floatBitsToInt(record.w); }
vec3 base_color(int material) { return texelFetch(t_materials, material).rgb; }
vec3 ambient_color(int material) { return texelFetch(t_materials, material + 1).rgb; }
vec3 emissive_color(int material) { return texelFetch(t_materials, material + 2).rgb; }
