// Where packets of points are worth using.
#pragma once

#include <cstddef>

namespace tenebra::soft {

/// Leaves room in packet_vertices for what cuts add.
inline constexpr std::size_t most_packet_light_vertices = 8;
/// With more, in clouds and trees, fragments differ too much from neighbour to neighbour (measured).
inline constexpr std::size_t most_packet_occluders = 384;

}  // namespace tenebra::soft
