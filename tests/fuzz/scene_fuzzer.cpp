// Scenes from bytes: what can be read is evaluated, written as GLB and read again. TENEBRA_FUZZ_EXTENSION
// names the format.
#include <tenebra/frame_geometry.h>
#include "formats/import_scene.h"
#include "fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace tenebra;
  static const fuzz::InputFile input(TENEBRA_FUZZ_EXTENSION);
  const auto scene = formats::import_scene(input.write(bytes, size), {.cone_sides = 8});
  if (!scene) return 0;
  FrameGeometry geometry;
  for (int clip = -1; clip < static_cast<int>(scene->clips.size()); ++clip)
    evaluate_frame(*scene, clip, clip < 0 ? 0.0 : scene->clips[static_cast<std::size_t>(clip)].end_s,
                   geometry);
  const std::filesystem::path written = input.beside("written.glb");
  if (!formats::export_glb(*scene, written, 3.0)) return 0;
  if (const auto again = formats::import_scene(written); !again) {
    std::fprintf(stderr, "written, but not read: %s\n", again.error().message.c_str());
    std::abort();
  }
  return 0;
}
