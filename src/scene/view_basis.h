// Where a viewer's right, up and back point, given the way it looks and roughly which way is up.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace tenebra::scene {

/// Columns right, up, back: orthonormal and right-handed. The lengths of `forward` and `up` do not matter. A
/// `forward` that is zero or not finite becomes -Z; an `up` that is zero, not finite or parallel to it
/// becomes +Y, and -Z where that is parallel too.
glm::dmat3 view_basis(glm::dvec3 forward, glm::dvec3 up);

}  // namespace tenebra::scene
