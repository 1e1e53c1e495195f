// Visible points in groups that share occluders: 8x8-pixel neighbourhoods that lie together in space (Mora et
// al. 2012, section 5.5), or the points of one visible triangle (Algorithm 2); above the groups a tree of
// boxes. Only points that the light can reach are in a group.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include <tenebra/area_light.h>
#include <tenebra/soft_config.h>
#include <tenebra/visible_points.h>
#include "soft/groups/cell.h"
#include "soft/groups/receivers.h"

namespace tenebra::soft {

/// Points of a neighbourhood group, at most.
inline constexpr std::uint32_t largest_neighbourhood = 64;

struct PointGroup {
  std::uint32_t first = 0, count = 0;                    ///< range of PointGroups::pixels
  std::uint32_t first_receiver = 0, receiver_count = 0;  ///< range of PointGroups::receivers
  glm::dvec3 low{0.0}, high{0.0};                        ///< box of the points, world space, exact
  Cell cell;                                             ///< around the points, little larger than needed
};

/// A range of groups with the box of their points. Children follow each other; node 0 holds all groups.
struct GroupNode {
  glm::dvec3 low{0.0}, high{0.0};
  std::uint32_t first = 0, count = 0;  ///< groups
  std::uint32_t points = 0;            ///< in all of them
  std::uint32_t children = 0;          ///< first of two nodes; 0: one group
};

struct PointGroups {
  int width = 0;                   ///< pixels in a row of the picture
  std::vector<GroupNode> nodes;    ///< node 0 is the root; none without groups
  std::vector<PointGroup> groups;  ///< near ones in space near in the list
  std::vector<std::uint32_t>
      pixels;                       ///< in the groups' ranges every active pixel once, between them anything;
                                    ///< in a neighbourhood along a Z curve: any range lies together
  std::vector<Receiver> receivers;  ///< group after group; each triangle once for each group and
                                    ///< side, ascending

  std::span<const std::uint32_t> pixels_of(const PointGroup& group) const {
    return {pixels.data() + group.first, group.count};
  }
  std::span<const Receiver> receivers_of(const PointGroup& group) const {
    return {receivers.data() + group.first_receiver, group.receiver_count};
  }
};

/// Groups the active points: those on one side of their triangle, in front of the light's plane, and with a
/// part of the light on that side of the triangle's plane. Conservative: where double leaves
/// either in doubt, the point is kept. The groups depend neither on threads nor on the instruction set.
/// Buffers are kept from call to call.
class PointGrouper {
public:
  PointGrouper();
  PointGrouper(PointGrouper&&) noexcept;
  PointGrouper& operator=(PointGrouper&&) noexcept;
  ~PointGrouper();

  void group(const VisiblePoints& points, const TriangleView& triangles, const AreaLight& light,
             SoftGrouping grouping, PointGroups& out, SimdLevel simd = SimdLevel::automatic);

private:
  struct State;
  std::unique_ptr<State> state_;
};
/// Groups points once, without keeping anything.
void group_points(const VisiblePoints& points, const TriangleView& triangles, const AreaLight& light,
                  SoftGrouping grouping, PointGroups& out, SimdLevel simd = SimdLevel::automatic);

}  // namespace tenebra::soft
