// Writes the world-space vertices of a scene at some instants, for pose_oracle_test.py to compare.
// usage: tenebra-positions FILE CLIP TIME...     CLIP -1: the rest pose
// For each time: the number of vertices as 64 bits, then x, y, z of each as floats; byte order of the
// machine.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <tenebra/frame_geometry.h>
#include "formats/import_scene.h"

int main(int count, char** arguments) {
  if (count < 4) {
    std::fputs("usage: tenebra-positions FILE CLIP TIME...\n", stderr);
    return 2;
  }
  const auto scene = tenebra::formats::import_scene(arguments[1]);
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().message.c_str());
    return 1;
  }
  tenebra::FrameGeometry frame;
  for (int i = 3; i < count; ++i) {
    tenebra::evaluate_frame(*scene, std::atoi(arguments[2]), std::atof(arguments[i]), frame);
    const std::uint64_t vertices = frame.positions.size();
    std::fwrite(&vertices, sizeof vertices, 1, stdout);
    std::fwrite(frame.positions.data(), sizeof frame.positions[0], vertices, stdout);
  }
  return std::ferror(stdout) != 0;
}
