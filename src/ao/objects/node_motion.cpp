#include "ao/objects/node_motion.h"

#include <algorithm>
#include <cmath>

namespace tenebra::ao {
namespace {

/// How far a track's values stray from those of its first key, tangents from zero.
double variation(const Track& track) {
  const auto n = static_cast<std::size_t>(track.components);
  const bool cubic = track.interpolation == Interpolation::cubic_spline;
  const std::size_t stride = cubic ? 3 * n : n, first = cubic ? n : 0;
  double most = 0;
  for (std::size_t i = 0; i < track.values.size(); ++i) {
    const std::size_t place = i % stride;
    const bool tangent = place < first || place >= first + n;
    const double still = tangent ? 0.0 : track.values[place];
    most = std::max(most, std::abs(track.values[i] - still));
  }
  return most;
}

}  // namespace

NodeMotion find_motion(const Scene& scene) {
  std::vector<bool> moves(scene.nodes.size(), false);
  NodeMotion motion;
  motion.resized.assign(scene.nodes.size(), false);
  for (const Clip& clip : scene.clips) {
    for (const Channel& channel : clip.channels) {
      const auto index = static_cast<std::size_t>(channel.node);
      const Track& track = clip.tracks[static_cast<std::size_t>(channel.track)];
      const bool fixed = scene.nodes[index].matrix && channel.path != ChannelPath::visibility;
      if (fixed || !drives_node(channel.path) || channel.path == ChannelPath::weights || track.components < 1)
        continue;
      const double change = variation(track);
      if (change > 0) moves[index] = true;
      if (change > 0 && channel.path == ChannelPath::scale) motion.resized[index] = true;
    }
  }
  motion.mover.assign(scene.nodes.size(), -1);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {  // parents come before their children
    const int parent = scene.nodes[i].parent;
    if (moves[i]) motion.mover[i] = static_cast<int>(i);
    if (!moves[i] && parent >= 0) motion.mover[i] = motion.mover[static_cast<std::size_t>(parent)];
  }
  return motion;
}

}  // namespace tenebra::ao
