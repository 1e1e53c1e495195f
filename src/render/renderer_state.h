// What a renderer keeps from frame to frame, and the stages of a frame that work on it. Internal to render.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "render/antialias/edge_samples.h"
#include "render/antialias/mask_means.h"
#include "render/antialias/pixel_choice.h"
#include "render/antialias/sample_picture.h"
#include "render/antialias/shading_list.h"
#include "render/cpu_shading.h"
#include "render/frame_lights.h"
#include "render/frame_raster.h"
#include "render/frame_shading.h"
#include "render/light_points.h"
#include "render/lit_samples.h"
#include "render/renderer.h"
#include "render/see_through_layer.h"
#include "shade/shading.h"

namespace tenebra::render {

/// Points that an area light shines on, and how its shadows are wanted.
struct AreaTask {
  const FrameInput& input;
  const RenderSettings& settings;
  const VisiblePoints& at;
  std::span<const glm::vec3> normals;
  FrameResult* counts = nullptr;  ///< gets times and counts; null: they are dropped
  const StopFlag* stop = nullptr;
};

/// What an area light sends to them, from its front or from both sides.
struct AreaSide {
  SoftMask lit;
  TintMask tint;
  std::vector<std::uint8_t> classes;  ///< a SoftClass each; empty with soft_points
  std::vector<float> errors;          ///< as SoftShadowTracer::errors(); empty: all exact, or not wanted
};

struct Renderer::State {
  FrameRaster raster;
  Scene scene;  // as without_keyed_vertices leaves it
  shade::SurfaceTable surfaces;
  std::optional<shade::Environment> environment{};

  visibility::VisibleIds seen{};
  std::vector<DrawnLight> drawn{};
  VisiblePoints points{};
  std::vector<glm::vec3> normals{};
  ShadowTracer hard{};
  ShadowMask hard_mask{};
  SoftShadowTracer soft{};
  LightPointShadows light_points{};
  AreaSide lit_side{}, behind_light{};
  std::vector<std::uint8_t> casters{};
  std::uint64_t frames_begun = 0;
  AmbientOcclusion ambient{};
  std::vector<float> openness{};
  std::vector<std::vector<float>> irradiance{};  // of the drawn lights; empty without an area
  std::unordered_set<std::string> said{};        // notes of earlier frames
  bool groups_changed = false;                   // of this frame: SoftStats::groups_changed

  SurfaceCoordinates coordinates{};  // of scenes with see-through surfaces
  FrameInput recast{};               // the input as RenderSettings::see_through wants it
  TintTracer tint{};
  bool tint_has_surfaces = false;  // of this frame
  std::vector<LightTint> tints{};  // of the drawn lights
  LitSamples layer{};
  std::vector<std::uint32_t> ids_behind{};  // the opaque samples behind the layer
  VisiblePoints behind{};                   // their points as the eye sees them, where `points` has others
  EyeTint eye_tint{};
  TintMask passes{};

  std::unique_ptr<FrameShading> shading = std::make_unique<CpuShading>();

  // Of anti-aliasing.
  visibility::PlaceIds further{};  // what pixels see at the places of further samples
  SamplePicture samples{};
  LitSamples at_samples{}, layer_at_samples{}, own_soft{}, own_hard{};
  EdgeSamples edges{};
  std::vector<std::uint32_t> own_ids{};  // of edges.own
  std::vector<glm::vec2> own_places{};
  std::vector<std::uint32_t> soft_from{};  // pixel of the frame; or first_own + 1 + index in own_slots
  std::vector<std::uint32_t> own_slots{};
  ShadingList listed{};
  std::vector<shade::ShadedSample> shaded{};

  /// As Renderer::render_frame, with the settings' threads.
  Expected<void> render(const FrameInput& given, const RenderSettings& settings, FrameResult& result,
                        const AoProgress& progress, const StopFlag* stop);
  /// What each pixel sees.
  Expected<void> find_ids(const FrameInput& input, const RenderSettings& settings, FrameTimings& timings);
  /// Visible points and, for lights with an area and occlusion, their normals.
  void find_points(const FrameInput& input, const std::vector<DrawnLight>& lights,
                   const RenderSettings& settings, FrameTimings& timings);
  void points_from_depth(const ViewRays& view);
  /// Visible points lifted to the smooth surfaces, and the normals of the points before.
  void find_lifted_points(const FrameInput& input, PointLayout layout, bool shaded);
  /// Receivers and casters of one light, with normals where points are lifted. Valid until the next call.
  TriangleView traced_triangles(const FrameInput& input, const DrawnLight& light,
                                const RenderSettings& settings);
  Expected<void> occlude_ambient(const FrameInput& input, const RenderSettings& settings, FrameResult& result,
                                 const AoProgress& progress, const StopFlag* stop);
  /// Adds the mask of one light as a point.
  Expected<void> trace_hard(const FrameInput& input, const DrawnLight& light, const RenderSettings& settings,
                            FrameResult& result, const StopFlag* stop);
  /// Adds the mask of one light as a polygon: the visible part from each point, and its irradiance.
  Expected<void> trace_soft(const FrameInput& input, const DrawnLight& light, const RenderSettings& settings,
                            FrameResult& result, std::vector<float>& irradiance_out, const StopFlag* stop);
  /// Adds the masks of all lights, one after the other.
  Expected<void> trace_lights(const FrameInput& input, const std::vector<DrawnLight>& lights,
                              const RenderSettings& settings, FrameResult& result, const StopFlag* stop);
  /// The light's tint at samples: of those that `mask` lights, or for a light with an area `soft_lit`.
  Expected<void> trace_tint(const FrameInput& input, const DrawnLight& light, const RenderSettings& settings,
                            const VisiblePoints& at, std::span<const glm::vec3> shading_normals,
                            const ShadowMask& mask, const SoftMask& soft_lit, TintMask& out,
                            const StopFlag* stop);
  /// Where samples are lit: their points, or these lifted.
  const VisiblePoints& lit_points(const FrameInput& input, const RenderSettings& settings,
                                  LitSamples& samples);
  /// Which lights samples are lit by. `points`: those without an area, and no ambient occlusion; `masks`: the
  /// same without tints; `areas`: those with an area, and ambient occlusion.
  enum class LightKinds { all, points, masks, areas };
  /// How much of each light reaches samples whose points (and, for areas and occlusion, normals) are known.
  Expected<void> light_samples(const FrameInput& input, const std::vector<DrawnLight>& lights,
                               const RenderSettings& settings, LightKinds kinds, LitSamples& at,
                               const StopFlag* stop);
  /// The visible part of an area light at points, as the settings want it.
  Expected<void> trace_visible_part(const AreaTask& task, const DrawnLight& light, SoftMask& out);
  void note_changed_groups(const SoftShadowConfig& config, std::vector<std::string>& notes) const;
  /// The visible part, and its tint.
  Expected<void> trace_side(const AreaTask& task, const DrawnLight& light, AreaSide& out);
  /// The same for both sides of a light that shines alike in every direction (soft/light/even_emission.h).
  Expected<void> trace_area(const AreaTask& task, const DrawnLight& light, AreaSide& out);
  Expected<void> keep_linear(const RenderSettings& settings, FrameResult& result) const;
  /// What settings.aovs asks for (aov_stages.cpp); `factors`: how much of each light reaches the centres.
  void fill_aovs(const FrameInput& input, const std::vector<DrawnLight>& lights,
                 const RenderSettings& settings, std::span<const shade::LightFactors> factors,
                 FrameResult& result);
  void find_surfaces_seen(const FrameInput& input, const AovChoice& wanted, Aovs& out) const;
  io::ImageF irradiance_seen(const shade::Subject& subject, const std::vector<DrawnLight>& lights,
                             const shade::PixelSamples& pixels) const;
  io::ImageF albedo_seen(const FrameInput& input, const shade::PixelSamples& pixels);
  /// Whether further samples, or the caller, need the linear colours of the centres.
  static bool needs_colors(const RenderSettings& settings) {
    return settings.antialias > 1 || settings.linear || settings.linear_mean;
  }
  /// The nearest see-through surfaces, shaded like any, over the picture.
  Expected<void> draw_see_through(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                  const shade::PixelSamples& opaque, const RenderSettings& settings,
                                  FrameResult& result, const StopFlag* stop);
  /// `input`, or a copy whose see-through surfaces cast as the settings say.
  const FrameInput& cast_as(SeeThrough see_through, const FrameInput& input);
  shade::Display display_of(const RenderSettings& settings) const {
    return {settings.exposure, settings.tone, scene.transfer};
  }
  Expected<void> begin_shading(const FrameInput& input, const std::vector<DrawnLight>& lights,
                               const RenderSettings& settings);
  /// The picture, from all of the above.
  Expected<void> shade_pixels(const FrameInput& input, const std::vector<DrawnLight>& lights,
                              const RenderSettings& settings, FrameResult& result, const StopFlag* stop);

  /// What anti-aliasing starts from (antialias_stages.cpp).
  struct SampleFrame {
    const shade::PixelSamples& pixels;
    std::span<const LightMask> masks;  // of each light, if there are shadows
    std::span<const glm::vec2> offsets;
  };
  /// Adds further samples to the picture and to the means of masks.
  Expected<void> antialias(const FrameInput& input, const std::vector<DrawnLight>& lights,
                           const RenderSettings& settings, const SampleFrame& frame, FrameResult& result,
                           const StopFlag* stop);
  Expected<void> find_sample_ids(const FrameInput& input, const RenderSettings& settings,
                                 std::span<const glm::vec2> offsets, const StopFlag* stop);
  ChosenPixels choose(const FrameInput& input, const RenderSettings& settings, const SampleFrame& frame,
                      const FrameResult& result) const;
  /// The samples of chosen pixels at the places `place` ..., which `further` has the ids of; those of the
  /// edges from `shared` on get hard shadows of their own where they have to (antialias_edges.cpp).
  Expected<void> add_samples(const FrameInput& input, const std::vector<DrawnLight>& lights,
                             const RenderSettings& settings, const SampleFrame& frame,
                             const ChosenPixels& chosen, std::size_t shared, std::size_t place,
                             MaskMeans& means, const StopFlag* stop);
  Expected<void> add_contrasts(const RenderSettings& settings, const SampleFrame& frame,
                               std::span<const std::uint32_t> chosen, std::size_t first);
  CentreShadows centre_shadows(const SampleFrame& frame) const;
  static bool shares_masks(const std::vector<DrawnLight>& lights, const RenderSettings& settings);
  std::size_t part_edges(const FrameInput& input, const std::vector<DrawnLight>& lights,
                         const RenderSettings& settings, const SampleFrame& frame,
                         ChosenPixels& chosen) const;
  /// Traces edges.own.
  Expected<void> trace_own(const FrameInput& input, const std::vector<DrawnLight>& lights,
                           const RenderSettings& settings, const StopFlag* stop);
  /// The hard shadows of samples, in `edges`.
  Expected<void> light_edges(const FrameInput& input, const std::vector<DrawnLight>& lights,
                             const RenderSettings& settings, const EdgeTask& task, const StopFlag* stop);
  Expected<void> add_shared(const FrameInput& input, const std::vector<DrawnLight>& lights,
                            const RenderSettings& settings, const SampleFrame& frame,
                            std::span<const std::uint32_t> chosen, std::size_t first, const StopFlag* stop);
  Expected<void> add_edges(const FrameInput& input, const std::vector<DrawnLight>& lights,
                           const RenderSettings& settings, const SampleFrame& frame,
                           std::span<const std::uint32_t> chosen, std::size_t first, std::size_t place,
                           MaskMeans& means, const StopFlag* stop);
  Expected<void> light_packed(const FrameInput& input, const std::vector<DrawnLight>& lights,
                              const RenderSettings& settings, const SampleFrame& frame,
                              std::span<const std::uint32_t> chosen, const StopFlag* stop);
  Expected<void> light_softly(const FrameInput& input, const std::vector<DrawnLight>& lights,
                              const RenderSettings& settings, const SampleFrame& frame, const StopFlag* stop);
  Expected<void> light_sparsely(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                const RenderSettings& settings, const EdgeTask& task, const StopFlag* stop);
  void borrow_soft(const FrameInput& input);
  /// Shades `listed`, whose `from` are places in `lit`, and adds it to chosen pixels from `first` on.
  Expected<void> add_listed(const SampleLights& lit, float texture_px, std::size_t first);
  /// The same behind glass.
  Expected<void> add_behind_glass(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                  const RenderSettings& settings, const SampleLights& lit, std::size_t first,
                                  const StopFlag* stop);
  /// Lays see-through surfaces before packed samples over their colours, `shaded`.
  Expected<void> layer_packed(const FrameInput& input, const std::vector<DrawnLight>& lights,
                              const RenderSettings& settings, const StopFlag* stop);
  SampleShares shares_of_listed(std::size_t first) const {
    return {first, listed.pixels, listed.shares, listed.centres};
  }

  /// Drops the notes that earlier frames gave.
  void keep_new(std::vector<std::string>& notes);
};

}  // namespace tenebra::render
