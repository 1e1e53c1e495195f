// Looking up displacement fields: rays of the world, sixteen at a time, against one instance of an object.
// Gaitatzes, Chrysanthou and Papaioannou 2010, Algorithm 2.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include <tenebra/simd_level.h>
#include "ao/field/displacement_field.h"
#include "ao/objects/sphere.h"
#include "trees/ray_batch.h"

namespace tenebra::ao {

/// How a ray from inside the sphere is answered.
enum class FieldEnds {
  first,  ///< the paper's: the first hit along the whole chord, nothing if it lies behind the origin
  both,   ///< if it lies behind, the first hit seen from the other end of the chord. Origins are in the open:
          ///< one that seems to lie between the hits, but within half a cell's diagonal of one, is on its
          ///< outer side.
};

/// A field where an object stands. Any invertible affine transform will do, sheared and mirrored ones too:
/// the ray is moved into the object's space, where distances along it stay what they are.
struct FieldInstance {
  const DisplacementField* field = nullptr;
  const trees::TriangleBvh* near =
      nullptr;  ///< if given, casts what the field cannot tell: the first part of rays
                ///< that start next to the object, and rays from deep inside its hull
  FieldEnds ends = FieldEnds::both;
  float unit_from_world[3][4] = {};  ///< rows
  float object_from_world[3][4] = {};
  Sphere world;  ///< holds the object in world space, for culling
};

/// Nothing if the transform has no inverse in float (a flattened object): there is no volume to look into.
std::optional<FieldInstance> place_field(const DisplacementField& field, const trees::TriangleBvh* near,
                                         const glm::dmat4& world_from_object,
                                         FieldEnds ends = FieldEnds::both);

/// Code for one instruction set. Bits do not depend on it.
struct FieldKernels {
  /// distance[i] = t of the first hit of ray i if that is less than distance[i]; else left as it is. Never
  /// NaN, never negative; rays that are not finite or have no direction meet nothing.
  /// From outside the sphere: the sample of the ray's nearest chord. From inside: see FieldEnds. Returns the
  /// number of rays of which a part was cast. Best given all rays of a point in one call: a batch's look-ups
  /// wait for memory while the next ones are worked on.
  int (*nearest_hits)(const FieldInstance& instance, std::span<const trees::RayBatch> rays,
                      float* distances) = nullptr;
};
FieldKernels field_kernels(SimdLevel level);

}  // namespace tenebra::ao
