// Displacement fields as Gaitatzes et al. 2010 had them, and what follows for their claims.
#pragma once

#include <string>
#include <vector>

#include "bench/ao/ao_contestants.h"
#include "bench/paper/paper_claims.h"

namespace tenebra::bench {

/// How directions are laid out in a displacement map (Figure 3).
enum class DirectionMap { polar, rejection, concentric };
inline constexpr DirectionMap direction_maps[] = {DirectionMap::polar, DirectionMap::rejection,
                                                  DirectionMap::concentric};
const char* direction_map_name(DirectionMap map);

/// Cell of a direction (unit, z >= 0: inwards) in a map of side x side cells.
int cell_of_direction(DirectionMap map, glm::vec3 direction, int side);
/// Direction of a cell's centre; z < 0: the cell stands for none.
glm::vec3 direction_of_cell(DirectionMap map, int cell, int side);
/// Share of the cells that stand for no direction.
double unused_cells(DirectionMap map, int side);

/// The paper's field with any map of directions: distances in float, positions as Tenebra's fields have them.
class MappedField {
public:
  MappedField(const AoPeer& peer, const Ball& ball, DirectionMap map, int position_side, int direction_side);
  /// Looks rays up that start outside the sphere.
  void nearest(std::span<const trees::RayBatch> rays, float* distances) const;

private:
  Ball ball_;
  DirectionMap map_;
  int position_side_, direction_side_;
  std::vector<float> distances_;  ///< from the entry, metres; infinity: no hit
};

/// Errors outside the sphere, at the points of the corner's walls, in 1/255.
struct MapError {
  DirectionMap map;
  double rms = 0;
};
struct FieldCost {
  std::string name;
  int positions = 0, side = 0, bits = 8;  ///< of directions: side x side
  double bytes = 0, build_ms = 0, lookup_ms = 0;
  double rms = 0;
  double brighter = 0;  ///< mean by which the occlusion found falls short of the truth, 1/255
};
struct GrowthCost {
  double triangles = 0, rays = 0, bytes = 0;
  double build_ms = 0, lookup_ms = 0, ray_ms = 0;
};
/// A row of objects along a floor: 8 bits for those near the eye, 1 bit for the others.
struct MixedBits {
  double all_8 = 0, mixed = 0;       ///< bytes of one table for each way that is used
  double near_rms = 0, far_rms = 0;  ///< at the floor before near and far objects
  double far_rms_8 = 0;              ///< there, were all tables of 8 bits
};

struct AoFindings {
  std::string object;
  std::vector<MapError> maps;      ///< Figure 5
  std::vector<FieldCost> figure6;  ///< 8 bits
  std::vector<FieldCost> bits;     ///< Figures 4 and 7: 32, 8, 1
  std::vector<GrowthCost> growth;  ///< Figure 8
  double unused = 0;               ///< of the rejection map
  MixedBits mixed;
};

std::vector<Claim> ao_claims(const AoFindings& found);

}  // namespace tenebra::bench
