// Casters that a scene is drawn without: those that the user names, and skies that hide its lights.
#pragma once

#include <string>
#include <vector>

#include <tenebra/scene.h>

namespace tenebra::stage {

/// Keeps meshes from casting shadows, by name of mesh, name of material or FILE:LINE (Mesh::source). For each
/// name scene.warnings gets a sentence with the number of triangles, instances counted. Returns false if a
/// name matches nothing; `unmatched` is then the first such name.
bool leave_out_casters(Scene& scene, const std::vector<std::string>& names, std::string& unmatched);

/// Leaves skies out of the casters of the lights that they hide: a sky is a flat or open mesh that has nearly
/// all other casters (99 % of their vertices) in front of it, alone shadows nearly all of these from a light,
/// at the start of the first clip, and looks like one: it is called so, shines or is unlit, or the file is
/// one of AFF. Any other is a ceiling. Adds to Light::left_out_nodes, and a sentence for each to
/// scene.warnings; any other mesh that hides a light from nearly all is named there too.
/// Lights must not be shared by nodes.
void leave_out_covers(Scene& scene);

}  // namespace tenebra::stage
