// Options in combination: every two values of two options at least once, over a scene of each kind. What a
// frame shows must not depend on what else is asked for, nor on the frames before it.
#include <cstdlib>

#include <chrono>
#include <functional>
#include <string>

#include "render/small_scenes.h"
#include "support/all_pairs.h"

namespace tenebra {
namespace {

using render::FrameResult;
using render::RenderSettings;
using testing::Choice;

constexpr int pairs_width = 64, pairs_height = 48;

struct Value {
  const char* name;
  std::function<void(RenderSettings&)> set;
};
struct Option {
  const char* name;
  std::vector<Value> values;
};

template <class T, class U>
Value value(const char* name, T RenderSettings::*member, U to) {
  return {name, [=](RenderSettings& settings) { settings.*member = static_cast<T>(to); }};
}
Value as_it_is(const char* name) {
  return {name, [](RenderSettings&) {}};
}
Value set(const char* name, std::function<void(RenderSettings&)> how) {
  return {name, std::move(how)};
}
Value ao(AoMode mode, const char* name) {
  return set(name, [=](RenderSettings& s) { s.ao.mode = mode; });
}

/// What decides about the picture.
std::vector<Option> picture_options() {
  using S = RenderSettings;
  return {
      {"ao",
       {ao(AoMode::none, "none"), ao(AoMode::adaptive, "adaptive"), ao(AoMode::field, "field"),
        ao(AoMode::rays, "rays"),
        set("field at vertices",
            [](S& s) {
              s.ao.mode = AoMode::field;
              s.ao.place = AoPlace::vertices;
            })}},
      {"shadows",
       {value("none", &S::shadows, render::ShadowMode::none),
        value("hard", &S::shadows, render::ShadowMode::hard),
        value("soft", &S::shadows, render::ShadowMode::soft),
        set("hard from depth",
            [](S& s) {
              s.samples = render::SampleSource::depth;
              s.ao.mode = AoMode::none;  // it needs the exact points
            })}},
      {"antialias",
       {value("1", &S::antialias, 1), value("2", &S::antialias, 2), value("4", &S::antialias, 4),
        value("8", &S::antialias, 8), value("16", &S::antialias, 16),
        set("4 everywhere",
            [](S& s) {
              s.antialias = 4;
              s.antialias_everywhere = true;
            })}},
      {"see-through",
       {value("tint", &S::see_through, SeeThrough::tint), value("cast", &S::see_through, SeeThrough::cast),
        value("ignore", &S::see_through, SeeThrough::ignore)}},
      {"terminator",
       {value("flat", &S::terminator, render::Terminator::flat),
        value("smooth", &S::terminator, render::Terminator::smooth)}},
      {"light size",
       {as_it_is("0"),
        set("5 %",
            [](S& s) {
              s.area_lights.size = {5, 5};
              s.area_lights.percent_of_diagonal = true;
            }),
        set("0.5 m, to all sides",
            [](S& s) {
              s.area_lights.size = {0.5f, 0.5f};
              s.area_lights.emission = render::LightEmission::point;
            })}},
      {"sun size", {as_it_is("0"), set("5 degrees", [](S& s) { s.area_lights.sun_deg = 5.0f; })}},
      {"emissive lights", {as_it_is("no"), set("yes", [](S& s) { s.area_lights.emissive_quads = true; })}},
      {"soft error",
       {as_it_is("0"), set("1", [](S& s) { s.soft.error_255 = 1; }),
        set("8", [](S& s) { s.soft.error_255 = 8; }), value("4 points", &S::soft_points, 4)}},
      {"soft solver",
       {as_it_is("auto"), set("bsp", [](S& s) { s.soft.solver = SoftSolver::bsp; }),
        set("by triangle", [](S& s) { s.soft.grouping = SoftGrouping::triangle; })}},
      {"variant",
       {as_it_is("tiles"), set("PreciseSorted", [](S& s) { s.hard.variant = Variant::precise_sorted; }),
        set("PreciseSEATP", [](S& s) { s.hard.variant = Variant::precise_seatp; })}},
      {"tone", {as_it_is("none"), value("aces", &S::tone, shade::Tone::aces)}},
      {"threads", {value("1", &S::threads, 1), value("all", &S::threads, 0)}},
      // Every sample of an edge is traced then, where else some share what others found.
      {"mask means", {as_it_is("no"), value("yes", &S::mask_means, true)}},
      {"mask samples", {as_it_is("no"), value("yes", &S::sample_masks, true)}},
  };
}

/// What else is filled: the picture is the same.
std::vector<Option> output_options() {
  using S = RenderSettings;
  return {
      {"linear", {as_it_is("no"), value("yes", &S::linear, true)}},
      {"linear mean", {as_it_is("no"), value("yes", &S::linear_mean, true)}},
      {"error maps", {as_it_is("no"), value("yes", &S::error_maps, true)}},
      {"diagnostics", {as_it_is("no"), value("yes", &S::diagnostics, true)}},
      {"AOVs of surfaces",
       {as_it_is("no"),
        set("yes", [](S& s) { s.aovs.depth = s.aovs.ids = s.aovs.normal = s.aovs.albedo = true; })}},
      {"AOVs of light",
       {as_it_is("no"), set("yes",
                            [](S& s) {
                              s.aovs.irradiance = true;
                              s.aovs.visibility = s.shadows != render::ShadowMode::none;
                              s.aovs.openness = s.ao.mode != AoMode::none;
                            })}},
  };
}

struct AllOptions {
  std::vector<Option> picture = picture_options(), output = output_options();

  std::vector<std::size_t> counts() const {
    std::vector<std::size_t> counts;
    for (const auto* options : {&picture, &output})
      for (const Option& option : *options) counts.push_back(option.values.size());
    return counts;
  }
  /// `outputs`: whether those that change no picture are set, too.
  RenderSettings settings(const Choice& choice, bool outputs) const {
    RenderSettings settings;
    settings.width = pairs_width, settings.height = pairs_height;
    settings.ao.rays = 8, settings.ao.positions = 64, settings.ao.directions = 16;
    for (std::size_t i = 0; i < picture.size(); ++i) picture[i].values[choice[i]].set(settings);
    for (std::size_t i = 0; outputs && i < output.size(); ++i)
      output[i].values[choice[picture.size() + i]].set(settings);
    return settings;
  }
  std::string text(const Choice& choice) const {
    std::string text;
    std::size_t i = 0;
    for (const auto* options : {&picture, &output})
      for (const Option& option : *options) {
        if (!text.empty()) text += ", ";
        text += std::string(option.name) + " " + option.values[choice[i++]].name;
      }
    return text;
  }
};

struct Drawn {
  bool done = false;
  std::string refusal;
  FrameResult result;
};

Drawn draw_with(render::Renderer& renderer, const Scene& scene, const RenderSettings& settings) {
  Drawn drawn;
  const auto done =
      renderer.render_frame(frame_of(scene, settings.width, settings.height), settings, drawn.result);
  drawn.done = done.has_value();
  if (!done) drawn.refusal = done.error().message;
  return drawn;
}

render::Renderer renderer_of(const Scene& scene, render::RasterKind kind) {
  auto raster = render::FrameRaster::create({.kind = kind});
  EXPECT_TRUE(raster) << raster.error().message;
  return render::Renderer::create(std::move(*raster), scene);
}

void expect_same_picture(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  int different = 0, largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    different += a[i] != b[i];
    largest = std::max(largest, std::abs(int{a[i]} - int{b[i]}));
  }
  EXPECT_EQ(different, 0) << "values differ, by up to " << largest << " of 255";
}

/// One scene and the renderer that has drawn all its frames so far.
class Tried {
public:
  Tried(const SmallScene& scene, render::RasterKind kind)
      : scene_(scene), kind_(kind), kept_(renderer_of(scene.scene, kind)) {}

  /// A frame with all that is asked for, by the renderer of the frames before; and the picture alone, by one
  /// that has drawn nothing. With OpenGL by the same one: of several contexts only the last can be used.
  void draw(const AllOptions& options, const Choice& choice) {
    SCOPED_TRACE(std::string(scene_.name) + ": " + options.text(choice));
    const Drawn with = draw_with(kept_, scene_.scene, options.settings(choice, true));
    const RenderSettings plain = options.settings(choice, false);
    std::optional<render::Renderer> fresh;
    if (kind_ == render::RasterKind::cpu) fresh = renderer_of(scene_.scene, kind_);
    const Drawn alone = draw_with(fresh ? *fresh : kept_, scene_.scene, plain);
    if (!with.done || !alone.done) {
      refusal_ = (with.done ? alone : with).refusal;
      EXPECT_FALSE(refusal_.empty());
      ++refused_;
      return;
    }
    ++drawn_;
    ASSERT_EQ(with.result.image.pixels.size(), std::size_t{3} * pairs_width * pairs_height);
    expect_same_picture(with.result.image.pixels, alone.result.image.pixels);
    ASSERT_EQ(with.result.masks.size(), alone.result.masks.size());
    for (std::size_t i = 0; i < with.result.masks.size(); ++i)
      EXPECT_EQ(with.result.masks[i].mask.pixels, alone.result.masks[i].mask.pixels) << "light " << i;
  }
  int drawn() const { return drawn_; }
  int refused() const { return refused_; }
  const std::string& refusal() const { return refusal_; }  ///< the last one

private:
  const SmallScene& scene_;
  render::RasterKind kind_;
  render::Renderer kept_;
  int drawn_ = 0, refused_ = 0;
  std::string refusal_;
};

TEST(AllPairs, HoldEveryTwoValuesAtLeastOnce) {
  const std::vector<std::size_t> counts{3, 5, 2, 4, 2};
  const auto choices = testing::all_pairs(counts, testing::Random(7));
  EXPECT_LT(choices.size(), 40u);  // all combinations: 240
  for (std::size_t a = 0; a < counts.size(); ++a)
    for (std::size_t b = a + 1; b < counts.size(); ++b)
      for (std::size_t i = 0; i < counts[a]; ++i)
        for (std::size_t j = 0; j < counts[b]; ++j)
          EXPECT_TRUE(std::any_of(choices.begin(), choices.end(),
                                  [&](const Choice& choice) { return choice[a] == i && choice[b] == j; }))
              << a << "=" << i << " " << b << "=" << j;
}

void draw_all_pairs(const SmallScene& scene, render::RasterKind kind, std::uint64_t seed) {
  const AllOptions options;
  Tried tried(scene, kind);
  for (const Choice& choice : testing::all_pairs(options.counts(), testing::Random(seed)))
    tried.draw(options, choice);
  // Refused are light as points with --soft-error, depth samples with several samples or occlusion, and the
  // like: sentences, not crashes. Most must be drawn.
  EXPECT_GT(tried.drawn(), 2 * tried.refused()) << scene.name << ": " << tried.refusal();
}

TEST(OptionPairs, DrawTheSamePicturesWithAllElseThatIsAskedFor) {
  for (const SmallScene& scene : scenes_of_each_kind()) draw_all_pairs(scene, render::RasterKind::cpu, 1);
}

TEST(OptionPairs, DrawTheSameByOpenGL) {
  const auto scenes = scenes_of_each_kind();
  draw_all_pairs(scenes.front(), render::RasterKind::gl, 2);
}

/// Any combination, for as many seconds as TENEBRA_RANDOM_SECONDS says (tools/nightly.sh pairs), with another
/// seed each time, which a failure names; else a few.
TEST(OptionPairs, DrawTheSameInRandomCombinations) {
  const char* const text = std::getenv("TENEBRA_RANDOM_SECONDS");
  const double seconds = text != nullptr ? std::atof(text) : 0;
  const char* const seed_text = std::getenv("TENEBRA_SEED");
  const std::uint64_t seed = seed_text != nullptr ? std::strtoull(seed_text, nullptr, 10)
                             : seconds > 0        ? static_cast<std::uint64_t>(std::time(nullptr))
                                                  : 3;
  SCOPED_TRACE("TENEBRA_SEED=" + std::to_string(seed));
  testing::Random random(seed);
  const AllOptions options;
  const auto counts = options.counts();
  const auto scenes = scenes_of_each_kind();
  std::vector<Tried> tried;
  for (const SmallScene& scene : scenes) tried.emplace_back(scene, render::RasterKind::cpu);
  const auto begin = std::chrono::steady_clock::now();
  int frames = 0;
  do {
    for (Tried& one : tried) one.draw(options, testing::choose_at_random(counts, random));
    ++frames;
  } while (!HasFailure() &&
           (frames < 3 || std::chrono::steady_clock::now() - begin < std::chrono::duration<double>(seconds)));
}

}  // namespace
}  // namespace tenebra
