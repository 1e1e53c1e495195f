// Animated values: tracks of keys and how they are interpolated.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace tenebra {

enum class Interpolation {
  step,              ///< glTF STEP
  linear,            ///< glTF LINEAR (rotations: spherical, shortest way)
  cubic_spline,      ///< glTF CUBICSPLINE; values hold (in-tangent, value, out-tangent) a key
  kochanek_bartels,  ///< BART: first and last key only shape tangents; rotations by SQUAD on raw quaternions
};

/// Keys of one animated quantity. Not sorted: BART needs the file's order (see evaluate_track).
struct Track {
  Interpolation interpolation = Interpolation::linear;
  int components =
      0;  ///< values a key: 3 translation or scale, 4 rotation (x, y, z, w), 1 visibility, N weights
  std::vector<double> times_s;
  std::vector<double> values;   ///< times_s.size() * components (three times that for cubic_spline)
  std::vector<glm::dvec3> tcb;  ///< tension, continuity, bias a key; kochanek_bartels only
};

enum class ChannelPath { translation, rotation, scale, weights, visibility };

/// One track that drives one property of one node. Several channels may share a track (BART names are
/// global).
struct Channel {
  int node = -1;
  ChannelPath path = ChannelPath::translation;
  int track = -1;  ///< index into Clip::tracks
};

/// A named animation (one per glTF animation; BART has one).
struct Clip {
  std::string name;
  std::vector<Track> tracks;
  std::vector<Channel> channels;
  double start_s = 0;
  double end_s = 0;
  int frame_count = 0;  ///< frames the file itself states (BART); 0: cut at the user's frames per second
};

/// Value of `track` at `time_s` into `out` (track.components values); rotations are the `rotation` flag's
/// unit quaternions x, y, z, w. Times outside the keys clamp. Exactly the rules of the formats, corner cases
/// included.
void evaluate_track(const Track& track, double time_s, bool rotation, std::span<double> out);

/// Time of frame `frame` (from 0): start + frame * (end - start) / (frame_count - 1) if the clip states its
/// frames, else start + frame / fps.
double frame_time_s(const Clip& clip, int frame, double fps);
/// Frames of the clip: its own count, else floor((end - start) * fps) + 1; at least 1.
int frame_count(const Clip& clip, double fps);

}  // namespace tenebra
