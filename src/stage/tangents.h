// What normal maps need and a file lacks: tangents.
#pragma once

#include <tenebra/scene.h>

namespace tenebra::stage {

/// Gives vertices of smooth meshes whose material has a normal map a tangent where they have none, in the way
/// of MikkTSpace: the direction in which the map's first coordinate grows over each triangle, moved into the
/// plane of the vertex normal, means weighted by the angle at the vertex, over all triangles that meet there
/// with the same position, normal and coordinates. Unlike MikkTSpace, coordinates are those after the map's
/// transform, and where mirrored coordinates meet none is given: each triangle then has its own. So have
/// triangles without normals.
void add_tangents(Scene& scene);

}  // namespace tenebra::stage
