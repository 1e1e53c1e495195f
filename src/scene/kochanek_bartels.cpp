#include "scene/kochanek_bartels.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace tenebra::scene {
namespace {

constexpr double small_sine = 1e-3;  // below it the authors' quaternion functions take their short cuts

/// Where a time falls: at key `key` itself (u = 0, held) or between it and the next.
struct Place {
  std::size_t key = 0;
  bool between = false;
  double u = 0;
};

/// The first segment in the file's order that ends after `time_s`. Keys are not sorted: BART's times repeat,
/// and once run backwards. The first and the last key only shape tangents and are never reached.
Place find_place(const std::vector<double>& times_s, double time_s) {
  if (times_s.size() < 4) return {.key = std::min<std::size_t>(1, times_s.size() - 1)};
  const std::size_t first = 1;
  const std::size_t last = times_s.size() - 2;
  if (time_s <= times_s[first]) return {.key = first};
  if (time_s >= times_s[last]) return {.key = last};
  for (std::size_t i = first; i < last; ++i) {
    if (!(times_s[i + 1] > time_s)) continue;
    return {.key = i, .between = true, .u = (time_s - times_s[i]) / (times_s[i + 1] - times_s[i])};
  }
  return {.key = last};
}

/// Tangents of the segment (P1, P2) between P0 and P3: out of P1 = leave * (P2 - P1) + leave_before * (P1 -
/// P0), into P2 = enter_after * (P3 - P2) + enter * (P2 - P1).
struct TangentFactors {
  double leave = 0, leave_before = 0, enter_after = 0, enter = 0;
};

double share(double part, double whole) {
  return whole == 0.0 ? 0.0 : part / whole;
}

TangentFactors tangent_factors(const Track& track, std::size_t i) {
  const double* s = &track.times_s[i - 1];
  const double half_adjust1 = share(s[2] - s[1], s[2] - s[0]);
  const double half_adjust2 = share(s[2] - s[1], s[3] - s[1]);
  const glm::dvec3 k1 = track.tcb.empty() ? glm::dvec3(0.0) : track.tcb[i];
  const glm::dvec3 k2 = track.tcb.empty() ? glm::dvec3(0.0) : track.tcb[i + 1];
  return {.leave = half_adjust1 * (1 - k1[0]) * (1 - k1[1]) * (1 - k1[2]),
          .leave_before = half_adjust1 * (1 - k1[0]) * (1 + k1[1]) * (1 + k1[2]),
          .enter_after = half_adjust2 * (1 - k2[0]) * (1 + k2[1]) * (1 - k2[2]),
          .enter = half_adjust2 * (1 - k2[0]) * (1 - k2[1]) * (1 + k2[2])};
}

glm::dquat key_quaternion(const Track& track, std::size_t key) {
  const double* v = &track.values[4 * key];
  return {v[3], v[0], v[1], v[2]};
}

/// Sign of key `key` after the walk that flips each key from the second on towards its predecessor, in order.
double aligned_sign(const Track& track, std::size_t key) {
  double sign = 1.0;
  for (std::size_t j = 1; j < key; ++j) {
    sign = sign * glm::dot(key_quaternion(track, j), key_quaternion(track, j + 1)) < 0.0 ? -1.0 : 1.0;
  }
  return sign;
}

double clamped_acos(double x) {
  return std::acos(std::clamp(x, -1.0, 1.0));
}

glm::dquat log_of(const glm::dquat& q) {
  const glm::dquat vector(0.0, q.x, q.y, q.z);
  if (!(std::abs(q.w) < 1.0)) return vector;
  const double angle = std::acos(q.w);
  const double sine = std::sin(angle);
  return std::abs(sine) < small_sine ? vector : vector * (angle / sine);
}

glm::dquat exp_of(const glm::dquat& v) {
  const double angle = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  const double sine = std::sin(angle);
  const double factor = std::abs(sine) < small_sine ? 1.0 : sine / angle;
  return {std::cos(angle), v.x * factor, v.y * factor, v.z * factor};
}

glm::dquat slerp(double u, const glm::dquat& p, const glm::dquat& q) {
  const double angle = clamped_acos(glm::dot(p, q));
  const double sine = std::sin(angle);
  if (sine < small_sine) return p;
  return p * (std::sin((1 - u) * angle) / sine) + q * (std::sin(u * angle) / sine);
}

glm::dquat squad(const Track& track, const Place& place) {
  const std::size_t i = place.key;
  const double sign1 = aligned_sign(track, i);
  const glm::dquat q0 = key_quaternion(track, i - 1) * aligned_sign(track, i - 1);
  const glm::dquat q1 = key_quaternion(track, i) * sign1;
  const glm::dquat next = key_quaternion(track, i + 1);
  const glm::dquat q2 = glm::dot(q1, next) < 0.0 ? -next : next;
  const glm::dquat q3 = key_quaternion(track, i + 2);  // not aligned yet when this segment is made

  const TangentFactors f = tangent_factors(track, i);
  const glm::dquat along = log_of(glm::conjugate(q1) * q2);
  const glm::dquat before = log_of(glm::conjugate(q0) * q1);
  const glm::dquat after = log_of(glm::conjugate(q2) * q3);
  const glm::dquat leave = along * f.leave + before * f.leave_before;
  const glm::dquat enter = along * f.enter + after * f.enter_after;
  const glm::dquat a = q1 * exp_of((leave - along) * 0.5);
  const glm::dquat b = q2 * exp_of((along - enter) * 0.5);
  const double u = place.u;
  return slerp(2 * u * (1 - u), slerp(u, q1, q2), slerp(u, a, b));
}

/// By angle and axis, as the authors do, so that a quaternion that is not unit keeps the angle of its w.
glm::dquat unit_rotation(const glm::dquat& q) {
  const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
  if (length == 0.0) return {1.0, 0.0, 0.0, 0.0};
  const double half_angle = clamped_acos(q.w);
  const double factor = std::sin(half_angle) / length;
  return {std::cos(half_angle), q.x * factor, q.y * factor, q.z * factor};
}

}  // namespace

void evaluate_kochanek_bartels(const Track& track, double time_s, std::span<double> out) {
  const Place place = find_place(track.times_s, time_s);
  const std::size_t n = out.size();
  const double* p1 = &track.values[place.key * n];
  if (!place.between) {
    std::copy_n(p1, n, out.begin());
    return;
  }
  const TangentFactors f = tangent_factors(track, place.key);
  const double* p0 = p1 - n;
  const double* p2 = p1 + n;
  const double* p3 = p2 + n;
  const double u = place.u;
  for (std::size_t k = 0; k < n; ++k) {
    const double d = p2[k] - p1[k];
    const double leave = f.leave * d + f.leave_before * (p1[k] - p0[k]);
    const double enter = f.enter_after * (p3[k] - p2[k]) + f.enter * d;
    out[k] = p1[k] + u * leave + u * u * (3 * d - 2 * leave - enter) + u * u * u * (-2 * d + leave + enter);
  }
}

void evaluate_kochanek_bartels_rotation(const Track& track, double time_s, std::span<double> out) {
  const Place place = find_place(track.times_s, time_s);
  const glm::dquat q = unit_rotation(place.between ? squad(track, place) : key_quaternion(track, place.key));
  out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w;
}

}  // namespace tenebra::scene
