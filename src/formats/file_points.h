// Positions of a file's vertices on their way into meshes.
#pragma once

#include <span>

#include <tenebra/scene.h>

namespace tenebra::formats {

/// Adds `points`, in the file's coordinates, to the positions of `mesh`; to the unrounded ones too if asked.
void add_positions(std::span<const glm::dvec3> points, const FileFrame& frame, bool keep_unrounded,
                   Mesh& mesh);

/// Adds a warning where some of `points` are not finite, or beyond the range of floats.
void warn_of_odd_positions(std::span<const glm::dvec3> points, Scene& scene);

/// Adds a warning where a scene lies far out, `largest_m` from zero, and its file stores floats: they lie
/// further apart there than 1 mm, or a thousandth of its `side_m`.
void warn_of_floats(double largest_m, double side_m, Scene& scene);
/// The same for `points`, floats in the file's coordinates.
void warn_of_floats(std::span<const glm::dvec3> points, Scene& scene);

/// `n` with length 1; zero where that can't be.
glm::vec3 unit_or_zero(glm::vec3 n);

}  // namespace tenebra::formats
