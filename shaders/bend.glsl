// Normal maps (src/shade/corner_tangents.h and bend-inl.h are the same on the CPU).
layout(std430, binding = 10) readonly buffer Tangents { vec4 tangents[]; };  // by vertex, if u_has_tangents
layout(location = 23) uniform bool u_has_tangents;

// Where the map's x grows over the triangle, and the sign of its y beside a normal on the side of the edges' cross
// product.
vec4 own_tangent(vec3 e1, vec3 e2, uint plane) {
  vec2 second = vec2(planes[plane + 2], planes[plane + 3]), third = vec2(planes[plane + 4], planes[plane + 5]);
  float area = second.x * third.y - third.x * second.y;
  vec3 along = (area < 0.0 ? -1.0 : 1.0) * (third.y * e1 - second.y * e2);
  float size = length(along);
  return area != 0.0 && size > 0.0 ? vec4(along / size, area < 0.0 ? 1.0 : -1.0) : vec4(0.0);
}

vec4 tangent_at(uint id, Seen seen, int rule) {
  uvec3 t = uvec3(triangles[3 * id], triangles[3 * id + 1], triangles[3 * id + 2]);
  vec3 a = corner(t.x), e1 = corner(t.y) - a, e2 = corner(t.z) - a;
  float scale = 1.0 / max(max(size_of(e1), size_of(e2)), 1e-30);
  vec3 wound = cross(scale * e1, scale * e2), normal = vec3(0.0);
  if (u_has_normals) normal = corner_normal(t.x) + corner_normal(t.y) + corner_normal(t.z);
  bool has_normal = normal != vec3(0.0);
  vec4 own = own_tangent(scale * e1, scale * e2, 6 * (id * u_rules + uint(rule)));
  if (has_normal && dot(normal, wound) < 0.0) own.w = -own.w;
  vec4 corners[3] = vec4[3](own, own, own);
  for (int k = 0; k < 3 && u_has_tangents; ++k)
    if (tangents[t[k]].xyz != vec3(0.0)) corners[k] = tangents[t[k]];
  float behind = dot(has_normal ? normal : wound, seen.face) < 0.0 ? -1.0 : 1.0;
  return behind * (seen.weights.x * corners[0] + seen.weights.y * corners[1] + seen.weights.z * corners[2]);
}

vec3 bent_normal(uint number, uint id, Seen seen) {
  ivec4 maps = materials[number].maps[3];
  if (maps.x < 0 || !has_planes(id)) return seen.normal;
  vec4 along = tangent_at(id, seen, maps.y & 255);
  vec3 across = along.xyz - dot(along.xyz, seen.normal) * seen.normal;
  vec3 map = 2.0 * texture_at(maps.x, maps.y, id, seen.weights, seen.steps).xyz - 1.0;
  map.xy *= materials[number].detail.x;
  vec3 x = across / max(length(across), 1e-6), y = (along.w < 0.0 ? -1.0 : 1.0) * cross(seen.normal, x);
  vec3 bent = map.x * x + map.y * y + map.z * seen.normal;
  bool usable = length(across) > 1e-6 && length(bent) > 1e-6 && dot(seen.normal, seen.normal) > 1e-6;
  return usable ? normalize(bent) : seen.normal;
}
