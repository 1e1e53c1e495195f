#include "commands/exr_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

namespace tenebra::viewer {
namespace {

/// Channels of one picture.
class Layers {
public:
  explicit Layers(io::exr::Precision precision) : precision_(precision) {}

  /// "N" and "XYZ": N.X, N.Y and N.Z; without a layer the letters alone.
  void add(const std::string& layer, std::string_view letters, const io::ImageF& image) {
    for (std::size_t c = 0; c < letters.size() && !image.pixels.empty(); ++c)
      channels_.push_back(
          {layer.empty() ? std::string(1, letters[c]) : fmt::format("{}.{}", layer, letters[c]),
           io::exr::Floats{std::span(image.pixels).subspan(c), letters.size(), precision_}});
  }
  void add_single(const std::string& name, const std::vector<float>& values, io::exr::Precision precision) {
    if (!values.empty()) channels_.push_back({name, io::exr::Floats{values, 1, precision}});
  }
  void add_ids(const std::string& name, const std::vector<std::uint32_t>& ids) {
    if (!ids.empty()) channels_.push_back({name, io::exr::Numbers(ids)});
  }

  std::vector<io::exr::Channel> take() { return std::move(channels_); }

private:
  io::exr::Precision precision_;
  std::vector<io::exr::Channel> channels_;
};

/// A name as part of a channel's name, in which dots separate layers.
std::string channel_word(std::string name) {
  constexpr std::size_t longest = 100;
  for (char& c : name)
    if (c == '.' || static_cast<unsigned char>(c) < ' ') c = '_';
  return name.substr(0, longest);
}

/// Names of the lights, by their number in the frame; those beyond are emissive meshes.
class LightNames {
public:
  LightNames(const RenderPlan& plan, const RenderOptions& options, double time_s) {
    const session::StagedScene& staged = *plan.staged;
    const std::vector<Light> lights =
        stage::lights_of(staged.scene, options.scene.edits, staged.light_has_units);
    for (const WorldLight& placed :
         stage::placed_lights(staged.scene, options.scene.edits, staged.clip, time_s))
      names_.push_back(channel_word(lights[static_cast<std::size_t>(placed.light)].name));
  }
  /// No two lights have the same.
  std::string take(int light) {
    const auto number = static_cast<std::size_t>(light);
    std::string name =
        number < names_.size() && !names_[number].empty() ? names_[number] : fmt::format("light{}", light);
    while (!taken_.insert(name).second) name += fmt::format("_{}", light);
    return name;
  }

private:
  std::vector<std::string> names_;
  std::set<std::string> taken_;
};

std::vector<io::exr::Text> texts_of(const RenderPlan& plan, std::span<const render::LogSetting> settings,
                                    const PlannedFrame& frame) {
  std::map<std::string, std::string> values{
      {"tenebra/frame", fmt::format("{}", frame.frame)},
      {"tenebra/time", fmt::format("{} s", frame.time_s)},
      {"tenebra/colours", plan.staged->scene.transfer == Transfer::srgb
                              ? "linear, of the primaries of sRGB, before exposure and tone"
                              : "display values, as the scene states them, before exposure and tone"}};
  if (const FileFrame& file = plan.staged->scene.frame; !file.is_identity()) {
    values["tenebra/origin"] = fmt::format("{} {} {}", file.origin.x, file.origin.y, file.origin.z);
    values["tenebra/metres_per_unit"] = fmt::format("{}", file.metres_per_unit);
    values["tenebra/up"] = file.up == UpAxis::z ? "z" : "y";
  }
  for (const render::LogSetting& setting : settings) {
    std::string& value = values[setting.name == "program" ? "software" : "tenebra/" + setting.name];
    value += (value.empty() ? "" : "; ") + setting.value;
  }
  std::vector<io::exr::Text> texts;
  texts.reserve(values.size());
  for (auto& [name, value] : values) texts.push_back({name, value});
  return texts;
}

/// A matrix for row vectors, row by row, from the one for column vectors.
std::array<float, 16> transposed(const glm::dmat4& columns) {
  std::array<float, 16> rows{};
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) rows[static_cast<std::size_t>(4 * r + c)] = static_cast<float>(columns[r][c]);
  return rows;
}

}  // namespace

io::exr::CameraMatrices camera_matrices(const ViewRays& view, Size size) {
  const glm::dvec3 eye(view.eye), d0(view.d0), dx(view.dx), dy(view.dy);
  const glm::dvec3 right = glm::normalize(dx), up = -glm::normalize(dy);
  glm::dvec3 ahead = view.orthographic ? glm::normalize(d0) : glm::normalize(glm::cross(dx, dy));
  if (glm::dot(ahead, d0) < 0) ahead = -ahead;
  const auto from_eye = [&](const glm::dmat3& rows) {  // M (p - eye), rows of M as columns here
    const glm::dmat3 m = glm::transpose(rows);
    glm::dmat4 out(m);
    out[3] = glm::dvec4(-(m * eye), 1.0);
    return out;
  };
  const glm::dmat4 to_camera = from_eye(glm::dmat3(right, up, ahead));
  // p - eye = t d0 + x dx + y dy, with x and y in pixels times t.
  const glm::dmat3 parts = glm::transpose(glm::inverse(glm::dmat3(d0, dx, dy)));
  const double width = size.width, height = size.height;
  glm::dmat4 to_ndc = from_eye(glm::dmat3(parts[1] / width, parts[2] / height, parts[0]));
  if (!view.orthographic) {  // divided by t; what is left of the depth: 0 at the near plane, 1 far away
    const double near = view.near_m / glm::dot(ahead, d0);
    for (int c = 0; c < 4; ++c) {
      to_ndc[c][3] = to_ndc[c][2];
      to_ndc[c][2] -= c == 3 ? near : 0.0;
    }
  }
  return {transposed(to_camera), transposed(to_ndc)};
}

Expected<std::string> exr_of_frame(const RenderPlan& plan, const RenderOptions& options,
                                   std::span<const render::LogSetting> settings, const PlannedFrame& frame,
                                   const render::FrameResult& result) {
  const io::exr::Precision precision = options.pictures.precision.value_or(io::exr::Precision::half);
  const render::Aovs& aovs = result.aovs;
  Layers layers(precision);
  layers.add("", "RGB", result.linear_mean);
  layers.add_single("Z", aovs.depth.pixels, io::exr::Precision::full);
  layers.add_ids("id", aovs.ids);
  layers.add_ids("id.part", aovs.parts);
  layers.add_ids("id.material", aovs.materials);
  layers.add("N", "XYZ", aovs.normal);
  layers.add("irradiance", "RGB", aovs.irradiance);
  layers.add_single("ao", aovs.openness.pixels, precision);
  layers.add("albedo", "RGB", aovs.albedo);
  LightNames names(plan, options, frame.time_s);
  for (const render::LightVisibility& of : aovs.visibility)
    layers.add_single("visibility." + names.take(of.light), of.fraction.pixels, precision);
  return io::exr::encode({.width = plan.settings.width,
                          .height = plan.settings.height,
                          .channels = layers.take(),
                          .camera = camera_matrices(plan.rays(frame.time_s), plan.staged->size),
                          .texts = texts_of(plan, settings, frame),
                          .compression = options.pictures.compression.value_or(io::exr::Compression::zip)});
}

}  // namespace tenebra::viewer
