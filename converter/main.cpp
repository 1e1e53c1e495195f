// tenebra-assimp FILE FOLDER: reads FILE by Assimp and writes it as a binary glTF to standard output. Tenebra
// starts it for formats that it has no reader for, and checks what it gets as it checks any file; what goes
// wrong here goes wrong in a process with limits. Only files in FOLDER are read, and none is written: both
// outputs have to be pipes. Standard error gets one sentence if it fails (exit code 1; 2 if memory ran out),
// else a sentence for each thing that was left out and a line "reads FILE" for each file.
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>

#include "axes.h"
#include "confined_files.h"
#include "gltf_writer.h"
#include "limits.h"

namespace {

using namespace tenebra::converter;

constexpr int failed = 1, out_of_memory = 2;

/// Triangles with shared vertices, in metres where the format has a unit; points and lines are left out.
constexpr unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_JoinIdenticalVertices |
                           aiProcess_LimitBoneWeights | aiProcess_FlipUVs | aiProcess_GlobalScale |
                           aiProcess_TransformUVCoords | aiProcess_ValidateDataStructure;

int convert(const std::filesystem::path& file, const std::filesystem::path& folder) {
  Assimp::Importer importer;
  auto* const files = new ConfinedFiles(folder, file.string());
  importer.SetIOHandler(files);                                         // which deletes it
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);  // bodies that no file states
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* const scene = importer.ReadFile(file.string(), steps);
  if (scene == nullptr) {
    const std::string why = importer.GetErrorString();
    std::fprintf(stderr, "%s\n", why.c_str());
    return why.find("bad_alloc") == std::string::npos ? failed : out_of_memory;
  }
  const bool upright = turn_upright(*scene);
  GltfWriter writer(*scene, file.parent_path());
  writer.write(stdout);
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    std::fprintf(stderr, "cannot write the scene\n");
    return failed;
  }
  if (!upright)
    std::fprintf(
        stderr,
        "The file states left-handed axes, which are not followed: it may be mirrored or lie on its side.\n");
  for (const std::string& sentence : writer.left_out()) std::fprintf(stderr, "%s\n", sentence.c_str());
  for (const std::string& name : files->opened())
    if (name.find('\n') == std::string::npos) std::fprintf(stderr, "reads %s\n", name.c_str());
  return 0;
}

}  // namespace

int main(int count, char** words) {
  if (count != 3) {
    std::fprintf(stderr, "usage: tenebra-assimp FILE FOLDER | cat > OUT.glb\n");
    return failed;
  }
  std::error_code error;
  const auto size = std::filesystem::file_size(words[1], error);
  limit_this_process(error ? 0 : size);
  try {
    const auto file = std::filesystem::absolute(words[1]), folder = std::filesystem::absolute(words[2]);
    std::filesystem::current_path(file.parent_path());  // Assimp takes names in the file as they are
    return convert(file, folder);
  } catch (const std::bad_alloc&) {
    return out_of_memory;
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "%s\n", fault.what());
    return failed;
  }
}
