// One frame of a scene as all contestants get it: triangles, lights, camera and visible points. No OpenGL:
// Embree finds what each pixel sees.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/scene.h>
#include <tenebra/visible_points.h>

namespace tenebra::bench {

/// A scene whose casters are chosen, with a camera and a light (added where the file has none).
Expected<Scene> load_scene(const std::filesystem::path& file, const std::vector<std::string>& no_cast = {});

/// A moment of a scene's first clip.
struct Instant {
  int clip = -1;  ///< -1: there is none
  double time_s = 0;
};
/// Frame `frame` of the first clip: its own frames where the file states them, else 30 per second.
Instant frame_instant(const Scene& scene, int frame);

/// Without glass: see-through materials become opaque ones, for opponents that have no colours of light.
void make_opaque(Scene& scene);

struct BenchFrame {
  FrameGeometry geometry;
  std::vector<WorldLight> lights;
  ViewRays view;
  VisiblePoints points;
  std::vector<glm::vec3> normals;  ///< shading normals, one per pixel
  glm::vec3 centre{0.0f};          ///< of the box around all triangles
  float diagonal_m = 0;            ///< of that box

  TriangleView triangles() const { return triangle_view(geometry); }
  std::size_t pixel_count() const { return points.triangles.size(); }
};

/// Frame `frame` from the first camera. Buffers of `out` keep their capacity.
void evaluate_bench_frame(const Scene& scene, int frame, int width, int height, BenchFrame& out);

/// Where a scene that does not come with the program lies: `data`, or the folder beside the checkout.
std::filesystem::path bart_folder(const std::filesystem::path& data);

}  // namespace tenebra::bench
