// Places in sentences: what they say can be given back to an option.
#pragma once

#include <string>

#include <tenebra/scene.h>

namespace tenebra::stage {

/// A coordinate to the millimetre of metres, or to six digits where that is finer; without an exponent from
/// 1e-4 up.
std::string coordinate_text(double value);

/// "X,Y,Z" of a place of the scene in the coordinates of its file, as --eye takes it.
std::string place_text(const FileFrame& frame, const glm::dvec3& place);

}  // namespace tenebra::stage
