// Animated values: tracks of keys and how they are interpolated.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace tenebra {

/// How values between two keys are found.
enum class Interpolation {
  step,              ///< glTF STEP
  linear,            ///< glTF LINEAR (rotations: spherical, shortest way)
  cubic_spline,      ///< glTF CUBICSPLINE; three values per key: in-tangent, value, out-tangent
  kochanek_bartels,  ///< BART: first and last key only shape tangents; rotations by SQUAD, quaternions as
                     ///< stored
};

/// Keys of one animated quantity. Not sorted: BART needs the file's order (see evaluate_track).
struct Track {
  Interpolation interpolation = Interpolation::linear;  ///< of all its keys
  int components = 0;  ///< numbers per key: 3 translation or scale, 4 rotation (x, y, z, w), 1 visibility, N
                       ///< weights; see ChannelPath
  std::vector<double> times_s;  ///< of the keys, seconds from the clip's zero
  std::vector<double> values;   ///< times_s.size() * components (three times that for cubic_spline)
  std::vector<glm::dvec3> tcb;  ///< tension, continuity, bias of each key; kochanek_bartels only
};

/// Which property a channel drives. Those from light_color on belong to the node's light or camera; their
/// values are in the units of Light and Camera.
enum class ChannelPath {
  translation,
  rotation,
  scale,
  weights,
  visibility,
  light_color,       ///< 3 numbers
  light_intensity,   ///< this and all below: 1 number
  light_range,       ///< metres
  light_inner_cone,  ///< radians
  light_outer_cone,
  light_size,     ///< metres: the height of a rectangle (its aspect ratio stays) or the diameter of a disc
  camera_fov,     ///< radians, bottom to top
  camera_extent,  ///< metres, full height
  camera_near     ///< metres
};

/// Whether `path` drives the node itself (its place, shape or visibility) and not its light or camera.
constexpr bool drives_node(ChannelPath path) {
  return path <= ChannelPath::visibility;
}

/// Ties a track to one property of one node, or of the light or camera there. Several channels may share a
/// track (BART's names are global).
struct Channel {
  int node = -1;                                ///< index into Scene::nodes
  ChannelPath path = ChannelPath::translation;  ///< the property that is driven
  int track = -1;                               ///< index into Clip::tracks
};

/// A named animation (one per glTF animation; BART has one).
struct Clip {
  std::string name;               ///< the file's; may be empty
  std::vector<Track> tracks;      ///< of all channels, in the order of the file
  std::vector<Channel> channels;  ///< the properties that the tracks drive
  double start_s = 0;             ///< the first key, seconds
  double end_s = 0;               ///< the last key, seconds
  int frame_count = 0;  ///< as the file states it (BART); 0: it follows from the user's frames per second
};

/// Writes the value of `track` at `time_s` to `out` (track.components numbers). With `rotation` it is a unit
/// quaternion x, y, z, w. Times outside the keys are clamped. Follows the formats' rules exactly, corner
/// cases included.
void evaluate_track(const Track& track, double time_s, bool rotation, std::span<double> out);

/// Time of frame `frame` (from 0): start + frame * (end - start) / (frame_count - 1) if the clip states its
/// frames, else start + frame / fps.
double frame_time_s(const Clip& clip, int frame, double fps);
/// Number of frames of the clip: its own, else floor((end - start) * fps) + 1; at least 1.
int frame_count(const Clip& clip, double fps);

}  // namespace tenebra
