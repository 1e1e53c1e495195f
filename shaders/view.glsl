// The rays of ViewRays and the way back from depth (src/raster/clip_transform.h).
layout(location = 0) uniform vec3 u_d0;
layout(location = 1) uniform vec3 u_dx;
layout(location = 2) uniform vec3 u_dy;
layout(location = 3) uniform vec2 u_near_far;
layout(location = 4) uniform bool u_orthographic;

// Direction of the ray through the pixel's centre.
vec3 ray_direction(vec2 pixel) { return u_orthographic ? u_d0 : u_d0 + pixel.x * u_dx + pixel.y * u_dy; }

// The point seen, relative to the eye.
vec3 offset_from_eye(vec2 pixel, float depth) {
  vec3 across = pixel.x * u_dx + pixel.y * u_dy;
  if (u_orthographic) return across + mix(u_near_far.y, u_near_far.x, depth) * u_d0;
  return u_near_far.x / depth * (u_d0 + across);
}
