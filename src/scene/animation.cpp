#include <tenebra/animation.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "scene/kochanek_bartels.h"

namespace tenebra {
namespace {

/// Key at or before a time, and the share of the way to the next key; keys ascend in time.
struct Place {
  std::size_t key = 0;
  double u = 0;
  double length_s = 0;  ///< of the segment; 0: held at the key
};

Place find_place(const std::vector<double>& times_s, double time_s) {
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  if (after == times_s.begin()) return {};
  const auto key = static_cast<std::size_t>(after - times_s.begin()) - 1;
  if (after == times_s.end()) return {.key = key};
  const double length = times_s[key + 1] - times_s[key];
  return {.key = key, .u = (time_s - times_s[key]) / length, .length_s = length};
}

glm::dquat quaternion(const double* v) {
  return {v[3], v[0], v[1], v[2]};
}

void store(const glm::dquat& q, std::span<double> out) {
  const double length = glm::length(q);
  const glm::dquat unit = length > 0.0 && std::isfinite(length) ? q / length : glm::dquat(1, 0, 0, 0);
  out[0] = unit.x, out[1] = unit.y, out[2] = unit.z, out[3] = unit.w;
}

void interpolate_linear(const double* p, const double* q, double u, bool rotation, std::span<double> out) {
  if (rotation) return store(glm::slerp(quaternion(p), quaternion(q), u), out);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = p[k] + u * (q[k] - p[k]);
}

/// glTF's Hermite spline; tangents are a second, so the segment's length scales them.
void interpolate_cubic(const double* key, const double* next, const Place& place, std::span<double> out) {
  const std::size_t n = out.size();
  const double u = place.u, u2 = u * u, u3 = u2 * u;
  for (std::size_t k = 0; k < n; ++k) {
    const double leave = place.length_s * key[2 * n + k];
    const double enter = place.length_s * next[k];
    out[k] = (2 * u3 - 3 * u2 + 1) * key[n + k] + (u3 - 2 * u2 + u) * leave +
             (3 * u2 - 2 * u3) * next[n + k] + (u3 - u2) * enter;
  }
}

}  // namespace

void evaluate_track(const Track& track, double time_s, bool rotation, std::span<double> out) {
  if (track.times_s.empty()) {
    std::fill(out.begin(), out.end(), 0.0);
    if (rotation) out[3] = 1.0;
    return;
  }
  if (track.interpolation == Interpolation::kochanek_bartels) {
    if (rotation) return scene::evaluate_kochanek_bartels_rotation(track, time_s, out);
    return scene::evaluate_kochanek_bartels(track, time_s, out);
  }
  const Place place = find_place(track.times_s, time_s);
  const bool cubic = track.interpolation == Interpolation::cubic_spline;
  const std::size_t n = out.size();
  const std::size_t stride = cubic ? 3 * n : n;
  const double* key = &track.values[place.key * stride];
  if (place.length_s == 0.0 || track.interpolation == Interpolation::step) {
    std::copy_n(cubic ? key + n : key, n, out.begin());
  } else if (cubic) {
    interpolate_cubic(key, key + stride, place, out);
  } else {
    return interpolate_linear(key, key + stride, place.u, rotation, out);
  }
  if (rotation) store(quaternion(out.data()), out);
}

double frame_time_s(const Clip& clip, int frame, double fps) {
  if (clip.frame_count > 1) {
    if (frame == clip.frame_count - 1) return clip.end_s;
    return clip.start_s + frame * (clip.end_s - clip.start_s) / (clip.frame_count - 1);
  }
  if (clip.frame_count == 1) return clip.start_s;
  return clip.start_s + frame / fps;
}

int frame_count(const Clip& clip, double fps) {
  constexpr double rounding = 1e-6;  // 0.7 s at 30 frames per second are 21 steps, not 20.999...
  constexpr double most = 1e9;
  if (clip.frame_count > 0) return clip.frame_count;
  const double steps = std::floor((clip.end_s - clip.start_s) * fps + rounding);
  return steps > 0.0 ? static_cast<int>(std::min(steps, most)) + 1 : 1;
}

}  // namespace tenebra
