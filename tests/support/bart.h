// Where tests find BART's scenes.
#pragma once

#include <filesystem>

namespace tenebra::testing {

/// What comes with the tests (tests/bart): robots, museum and kitchen, all of the geometry and no textures.
std::filesystem::path bart_part();
/// Folder of the scenes: the variable TENEBRA_BART names it, else it lies beside the checkout, else it is the
/// part.
std::filesystem::path bart_folder();
/// Whether BART's textures are there, for tests of looks.
bool bart_has_textures();

}  // namespace tenebra::testing
