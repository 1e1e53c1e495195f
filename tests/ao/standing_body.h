// A shape made from one mesh that stands, and its tree, for the tests of surface samples.
#pragma once

#include "ao/objects/scene_objects.h"
#include "ao_case.h"

namespace tenebra::testing {

struct StandingBody {
  ao::ObjectShape shape;
  trees::TriangleBvh casters;

  explicit StandingBody(const Mesh& mesh) {
    SceneMaker make;
    make.add(mesh);
    FrameGeometry geometry;
    evaluate_frame(make.scene, -1, 0, geometry);
    shape = ao::find_objects(make.scene, geometry).standing;
    casters = trees::build_triangle_bvh(shape.positions, shape.triangles);
  }
};

}  // namespace tenebra::testing
