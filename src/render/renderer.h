// The whole frame: visible triangles and shadow masks, in the order of the 2011 paper's section 3.1.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tenebra/ambient_occlusion.h>
#include <tenebra/expected.h>
#include <tenebra/frame_geometry.h>
#include <tenebra/frame_timings.h>
#include <tenebra/hard_shadows.h>
#include <tenebra/scene.h>
#include <tenebra/soft_shadows.h>
#include <tenebra/stop_flag.h>
#include <tenebra/tint.h>
#include "io/image.h"
#include "render/antialias/antialias_stats.h"
#include "render/aovs.h"
#include "render/frame_raster.h"
#include "shade/display.h"
#include "shade/light_terms.h"

namespace tenebra::render {

enum class ShadowMode { none, hard, soft };

/// Where the shadow rays start: points computed from triangle ids (exact, no bias), or the paper's
/// reconstruction from the depth buffer (for comparison; front-face culling instead of a bias).
enum class SampleSource { ids, depth };

/// Where light that grazes a smooth-shaded surface ends: along its triangles, whose planes the light sinks
/// below one by one, or along the smooth surface that their normals describe. Its points are then lifted to
/// it (lift_visible_points), and the masks are exact for the lifted points.
enum class Terminator { flat, smooth };
/// How the rectangles made from point and spot lights shine.
enum class LightEmission {
  lambert,  ///< to one side, with the light's intensity straight ahead: less by the cosine elsewhere
  point     ///< with the light's intensity in every direction, to both sides: as bright as with hard shadows
};

/// How lights without an area become rectangles in soft mode.
struct AreaLightSettings {
  glm::vec2 size{0.0f};              ///< width and height; 0: point and spot lights keep hard shadows
  bool percent_of_diagonal = false;  ///< unit of `size`: percent of the scene's diagonal instead of metres
  std::optional<glm::vec3> facing;   ///< point that the rectangles face; none: the centre of the scene's box,
                                     ///< and for spot lights where they shine
  LightEmission emission = LightEmission::lambert;
  bool emissive_quads = false;  ///< planar convex meshes of an emissive material shine too
  /// By Scene::lights: width and height in metres of the point and spot lights that have their own, beside
  /// `size`; may be shorter.
  std::vector<std::optional<glm::vec2>> own_size_m;
  std::optional<float> sun_deg;  ///< diameter of directional lights, in place of the scene's
  float unsized_percent = 0;  ///< width and height of point and spot lights without a size: of the diagonal
  float unsized_sun_deg = 0;  ///< diameter of directional lights without one
  std::vector<std::optional<float>> own_sun_deg;  ///< as own_size_m, of directional lights, in place of all
};

struct RenderSettings {
  int width = 800;
  int height = 600;
  ShadowMode shadows = ShadowMode::hard;
  SampleSource samples = SampleSource::ids;
  Terminator terminator = Terminator::flat;  ///< smooth needs SampleSource::ids; else it is flat
  HardShadowConfig hard;
  SoftShadowConfig soft;
  int soft_points = 0;  ///< soft mode: 0: as soft.error_255 says; else area lights are this many points
                        ///< (render/light_points.h)
  AreaLightSettings area_lights;
  SeeThrough see_through =
      SeeThrough::tint;  ///< what see-through surfaces do to light; they are drawn anyway
  AoConfig ao;
  int light = -1;         ///< index into the frame's lights; -1: all
  int threads = 0;        ///< 0: all cores
  float exposure = 1.0f;  ///< factor of linear colour, before the tone
  shade::Tone tone = shade::Tone::none;
  bool diagnostics = false;  ///< fill LightMask::nodes; the picture is the same

  // Anti-aliasing: antialias/pattern.h has the places, antialias/pixel_choice.h which pixels need them.
  int antialias = 1;                  ///< samples of a pixel that needs more than one: 1, 2, 4, 8, 16 or 256
  bool antialias_everywhere = false;  ///< every pixel gets all of them; 256 need it
  bool mask_means = false;    ///< fill LightMask::mean: traces every sample of an edge, where some share else
  bool sample_masks = false;  ///< fill LightMask::samples, likewise
  bool error_maps = false;    ///< fill LightMask::error
  bool linear = false;        ///< fill FrameResult::linear and seen; the picture is the same
  bool linear_mean = false;   ///< fill FrameResult::linear_mean; the picture is the same
  AovChoice aovs;             ///< what of FrameResult::aovs is filled; the picture is the same
};

/// Whether the points that shadows and occlusion start from are lifted.
inline bool lifts_points(const RenderSettings& settings) {
  return settings.terminator == Terminator::smooth && settings.samples == SampleSource::ids;
}

/// What is drawn: one instant of a scene from one camera.
struct FrameInput {
  FrameGeometry geometry;
  std::vector<WorldLight> lights;
  ViewRays view;
  /// What the pixels see, where another renderer has drawn it (tenebra/host_frame.h): width * height
  /// triangles, row 0 at the top; any other number is background. Empty: it is drawn here. Needs one sample
  /// per pixel and SampleSource::ids; nothing see-through is laid over it.
  std::vector<std::uint32_t> ids{};
};

struct LightMask {
  int light = -1;   ///< index into FrameInput::lights; emissive meshes that shine follow them
  io::Image8 mask;  ///< 255 lit, 0 shadowed, facing away, out of reach or background; soft: 255 x fraction
  io::ImageF
      visible_fraction;      ///< soft mode: visible part of the light, 0..1 (0 or 1 of a point); else empty
  std::vector<float> nodes;  ///< hard, with RenderSettings::diagnostics: ShadowTracer::pixel_nodes
  io::ImageF error;  ///< soft, with RenderSettings::error_maps: SoftShadowTracer::errors(), 0 where exact
  std::vector<std::uint8_t> classes;  ///< exact soft shadows: a SoftClass per pixel, to display; else empty
  TintMask tint;  ///< what see-through surfaces leave of the light's colours; the mask is of opaque casters

  // With RenderSettings::antialias above 1. All else here is of the pixels' centres.
  io::ImageF mean;                  ///< with mask_means: visible fraction, 0..1, mean over the samples
  std::vector<io::Image8> samples;  ///< with sample_masks: `mask` of each sample, the centre first if it
                                    ///< counts; a pixel that needs only one has its centre's in all
};

/// What traced a light without an area.
struct LightMethod {
  int light = -1;  ///< as LightMask::light
  Variant ran = Variant::tiles;
};

struct FrameResult {
  io::Image8 image;        ///< RGB, encoded as Scene::transfer says; the mean of what the samples show
  io::ImageF linear;       ///< RenderSettings::linear: RGB of the pixels' centres before exposure and tone
  io::ImageF linear_mean;  ///< RenderSettings::linear_mean: the same, but the mean over a pixel's samples
  Aovs aovs;               ///< RenderSettings::aovs: depth, ids, normals, visibility, irradiance, ...
  std::vector<std::uint8_t> seen;  ///< RenderSettings::linear: 1 where a pixel sees a triangle
  std::vector<LightMask> masks;    ///< one per light drawn, of those with an intensity; empty without shadows
  std::vector<LightMethod> methods;  ///< of the lights that had hard shadows
  FrameTimings timings;
  TraceStats stats;
  SoftStats soft;
  AoStats ao;
  AntialiasStats antialias;
  std::vector<std::string> notes;  ///< sentences a user should see once, new with this frame
};

/// Owns what frames of one scene need. Use it on the thread that created its context, if it has one.
class Renderer {
public:
  /// Keeps what it needs of `scene`.
  static Renderer create(FrameRaster raster, const Scene& scene);
  /// By OpenGL. Fails with a sentence if the context lacks OpenGL 4.5 core or a shader does not build.
  static Expected<Renderer> create(gl::Context context, const Scene& scene);
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// One frame; `result` keeps its capacity. Fails with a sentence on sizes that cannot be drawn, on settings
  /// that exclude each other, and if the context is lost. With `stop` requested from another thread it fails
  /// soon, with "stopped".
  Expected<void> render_frame(const FrameInput& input, const RenderSettings& settings, FrameResult& result,
                              const AoProgress& progress = {}, const StopFlag* stop = nullptr);

  /// Replaces Scene::lights (colour, intensity, size): a viewer's editors. Any number: FrameInput::lights
  /// says where each of them stands.
  void set_lights(std::vector<Light> lights);
  /// Replaces Scene::materials, as many as the scene has: colours and factors. Textures, and whether light
  /// passes through or shadows are cast, stay as they were made.
  void set_materials(const std::vector<Material>& materials);

  /// The surroundings of the scene, in place of its background and ambient light: shade/environment.h.
  void set_environment(const io::ImageF& picture);

  /// What pixel (x, y), row 0 at the top, of the last frame sees, in world space; none: background. `input`:
  /// that frame's.
  std::optional<glm::dvec3> visible_point(const FrameInput& input, int x, int y);

  /// What explain_pixel asks for, of the last frame: the triangle that each pixel sees, row 0 at the top, and
  /// the lights that it drew.
  std::span<const std::uint32_t> triangle_ids() const;
  const std::vector<shade::DrawnLight>& drawn_lights() const;

  /// What the driver complained about since the last call (contexts made with ContextOptions::debug).
  std::vector<std::string> take_debug_messages();

  const FrameRaster& raster() const;  ///< which way, and GL_RENDERER

private:
  struct State;
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tenebra::render
