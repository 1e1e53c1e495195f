#include "formats/aff/keys.h"

#include "base/fail.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace tenebra::formats {
namespace {

constexpr std::size_t least_spline_keys = 4;
constexpr std::size_t least_flags = 1;

/// None: no key drives anything.
std::size_t key_count(AffLexer& in, std::size_t least) {
  const std::size_t count = in.count("the number of keys");
  if (count == 0) in.warn("0", fmt::format("at least {} keys", least), "left out");
  if (count > 0 && count < least) in.fail(fmt::to_string(count), fmt::format("at least {} keys", least));
  return count;
}

Track start_track(int components, std::size_t keys) {
  Track track;
  track.interpolation = Interpolation::kochanek_bartels;
  track.components = components;
  track.times_s.reserve(keys);
  track.tcb.reserve(keys);
  track.values.reserve(keys * static_cast<std::size_t>(components));
  return track;
}

void append_rotation(AffLexer& in, Track& track) {
  const glm::dvec3 axis = in.vector("a coordinate of a rotation's axis");
  const double half_angle = 0.5 * glm::radians(in.number("an angle in degrees"));
  const glm::dvec3 v = std::sin(half_angle) * axis;  // as written: the axis is not normalised
  track.values.insert(track.values.end(), {v.x, v.y, v.z, std::cos(half_angle)});
}

std::optional<Track> read_spline(AffLexer& in, int components) {
  constexpr std::size_t least_numbers_a_key = 7;
  const std::size_t count = key_count(in, least_spline_keys);
  if (count == 0) return std::nullopt;
  Track track = start_track(components, std::min(count, in.most_numbers_left() / least_numbers_a_key));
  for (std::size_t i = 0; i < count; ++i) {
    track.times_s.push_back(in.number("the time of a key"));
    if (components == 4) {
      append_rotation(in, track);
    } else {
      const glm::dvec3 v = in.vector("a value of a key");
      track.values.insert(track.values.end(), {v.x, v.y, v.z});
    }
    track.tcb.push_back(in.vector("tension, continuity or bias of a key"));
  }
  return track;
}

/// Visible before the first key, then each key's flag from its time on.
std::optional<Track> read_visibility(AffLexer& in) {
  const std::size_t count = key_count(in, least_flags);
  if (count == 0) return std::nullopt;
  std::vector<std::pair<double, double>> flags;
  flags.reserve(std::min(count, in.most_numbers_left() / 2));
  for (std::size_t i = 0; i < count; ++i) {
    const double time = in.number("the time of a key");
    const std::int64_t flag = in.integer("0 or 1");
    if (flag != 0 && flag != 1) in.fail(fmt::to_string(flag), "0 or 1");
    flags.emplace_back(time, static_cast<double>(flag));
  }
  std::stable_sort(flags.begin(), flags.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Track track;
  track.interpolation = Interpolation::step;
  track.components = 1;
  track.times_s.push_back(flags.front().first - 1.0);
  track.values.push_back(1.0);
  for (const auto& [time, flag] : flags) {
    track.times_s.push_back(time);
    track.values.push_back(flag);
  }
  return track;
}

bool same(const std::optional<Track>& a, const std::optional<Track>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->times_s == b->times_s && a->values == b->values && a->tcb == b->tcb;
}

std::size_t memory_of(const std::optional<Track>& track) {
  if (!track) return 0;
  return sizeof(double) * (track->times_s.size() + track->values.size()) +
         sizeof(glm::dvec3) * track->tcb.size();
}

}  // namespace

AffKeys read_key_block(AffLexer& in) {
  AffKeys keys;
  in.expect("{");
  while (in.peek() != "}") {
    const std::string_view kind = in.word("transl, rot, scale, visibility or '}'");
    std::optional<Track>* const slot = kind == "transl"       ? &keys.translation
                                       : kind == "rot"        ? &keys.rotation
                                       : kind == "scale"      ? &keys.scale
                                       : kind == "visibility" ? &keys.visibility
                                                              : nullptr;
    if (!slot) in.fail(quote_word(kind), "transl, rot, scale, visibility or '}'");
    if (*slot)
      in.warn(fmt::format("a second {}", kind), "each kind of key once in a block", "the last is used");
    *slot = kind == "visibility" ? read_visibility(in) : read_spline(in, kind == "rot" ? 4 : 3);
  }
  in.expect("}");
  return keys;
}

bool same_keys(const AffKeys& a, const AffKeys& b) {
  return same(a.translation, b.translation) && same(a.rotation, b.rotation) && same(a.scale, b.scale) &&
         same(a.visibility, b.visibility);
}

std::size_t memory_of(const AffKeys& keys) {
  return sizeof(AffKeys) + memory_of(keys.translation) + memory_of(keys.rotation) + memory_of(keys.scale) +
         memory_of(keys.visibility);
}

}  // namespace tenebra::formats
