// What can hide ambient light in a frame beyond the receiver's own body: rigid objects by their fields, what
// stands and what deforms by rays. Made when first needed, kept while the objects stay what they are.
//
// What stands over what moves (floors under feet): sixteen rays at once through its tree, no farther than the
// reach. It is exact, and the few nodes within the reach cost less than planes chosen by hand would save.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "ao/displacement_field.h"
#include "ao/field_lookup.h"
#include "ao/objects.h"
#include "ao/receivers.h"
#include "ao/self_occlusion.h"
#include "base/expected.h"

namespace tenebra {

/// What is kept of one shape.
struct ShapeData {
  std::optional<TriangleBvh> casters;           ///< a tree over its casting triangles
  std::optional<DisplacementField> field;
  bool fieldless = false;                       ///< few triangles, or no memory left: rays meet it
  std::vector<std::unique_ptr<SelfOcclusion>> selves;  ///< one a reach
};

class Occluders {
public:
  /// Objects found anew: all that was kept of the old ones goes, but fields of equal shapes stay.
  void reset(const SceneObjects& objects);
  /// Called every frame.
  void begin_frame(const SceneObjects& objects, const FrameGeometry& geometry, const AoConfig& config,
                   double reach);

  /// Indices of visible objects whose sphere, grown by the reach, meets the box; ascending.
  void near(const glm::dvec3& low, const glm::dvec3& high, std::vector<int>& out) const;
  bool deforming_near(const glm::dvec3& low, const glm::dvec3& high) const;

private:
};

}  // namespace tenebra
