// Displacement fields as the measurements hold them: built, placed at rest and ready for rays.
#pragma once

#include <memory>

#include "ao/field/displacement_field.h"
#include "ao/field/field_lookup.h"
#include "bench/ao/ao_objects.h"
#include "bench/ao/ao_receivers.h"

namespace tenebra::bench {

/// The tree that fields of one object are made with.
struct ObjectTree {
  explicit ObjectTree(const Object& object);
  trees::TriangleBvh bvh;
  Ball ball;  ///< the bounding sphere of the paper's fields
  double build_ms = 0;
};

/// How rays from inside the sphere are answered.
enum class Inside {
  first_hit,  ///< the paper's
  both_ends,  ///< the table alone
  near_rays,  ///< the default: rays that start close to the object are cast first
};

struct BuiltField {
  ao::DisplacementField field;
  ao::FieldInstance placed;  ///< refers to `field`
  double build_ms = 0;       ///< without the tree
};
/// Refers to `tree`. The address stays: tracers refer to it.
Expected<std::unique_ptr<BuiltField>> build_field(const Object& object, const ObjectTree& tree,
                                                  const ao::FieldSettings& settings,
                                                  Inside inside = Inside::near_rays);

/// Looks `built` up, which has to outlive it.
Tracer field_tracer(const BuiltField& built);

/// "chords 46^2 x 46^2", "paper 65^2 x 32^2".
std::string shape_name(const ao::DisplacementField& field);

}  // namespace tenebra::bench
