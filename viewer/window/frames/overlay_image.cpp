#include "window/frames/overlay_image.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace tenebra::viewer {
namespace {

constexpr double bright_share =
    0.99;  // pixels below the brightest colour: a few hot ones do not darken the rest

/// Even steps in brightness, readable without colour.
constexpr std::array<glm::u8vec3, 7> heat_stops{
    glm::u8vec3{10, 8, 30},    glm::u8vec3{66, 16, 104},  glm::u8vec3{135, 33, 107}, glm::u8vec3{197, 56, 76},
    glm::u8vec3{240, 104, 38}, glm::u8vec3{252, 172, 44}, glm::u8vec3{252, 246, 176}};

struct ClassLook {
  const char* name;
  glm::u8vec3 color;
};
/// In the order of SoftClass.
constexpr std::array<ClassLook, 8> class_looks{{{"background", {18, 18, 22}},
                                                {"below the horizon", {58, 62, 74}},
                                                {"fully lit", {236, 214, 130}},
                                                {"fully dark", {44, 72, 130}},
                                                {"penumbra by BSP", {214, 84, 60}},
                                                {"penumbra by clipping", {86, 170, 110}},
                                                {"penumbra by silhouettes", {164, 108, 190}},
                                                {"by places on the light", {214, 158, 88}}}};

void put(io::Image8& image, std::size_t pixel, glm::u8vec3 color) {
  for (int c = 0; c < 3; ++c) image.pixels[pixel * 3 + static_cast<std::size_t>(c)] = color[c];
}

io::Image8 empty_like(const io::Image8& picture) {
  const auto pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  return {picture.width, picture.height, 3, std::vector<std::uint8_t>(pixels * 3)};
}

/// Node tests of each pixel, all lights; empty if no light has any.
std::vector<float> nodes_of(const render::FrameResult& result) {
  std::vector<float> sum;
  for (const render::LightMask& mask : result.masks) {
    sum.resize(std::max(sum.size(), mask.nodes.size()));
    for (std::size_t i = 0; i < mask.nodes.size(); ++i) sum[i] += mask.nodes[i];
  }
  return sum;
}

/// The highest SoftClass of each pixel, all lights: what cost most. Empty if no light has any.
std::vector<std::uint8_t> classes_of(const render::FrameResult& result) {
  std::vector<std::uint8_t> highest;
  for (const render::LightMask& mask : result.masks) {
    highest.resize(std::max(highest.size(), mask.classes.size()));
    for (std::size_t i = 0; i < mask.classes.size(); ++i) highest[i] = std::max(highest[i], mask.classes[i]);
  }
  return highest;
}

OverlayImage heat_map(const render::FrameResult& result, std::span<const float> pixel_nodes) {
  OverlayImage overlay{.kind = Overlay::nodes, .image = empty_like(result.image)};
  std::vector<float> visited;
  for (const float nodes : pixel_nodes) {
    if (nodes > 0) visited.push_back(nodes);
  }
  if (!visited.empty()) {
    for (const float nodes : visited) overlay.mean += nodes;
    overlay.mean /= static_cast<double>(visited.size());
    overlay.peak = *std::max_element(visited.begin(), visited.end());
    const auto place = static_cast<std::size_t>(bright_share * static_cast<double>(visited.size() - 1));
    std::nth_element(visited.begin(), visited.begin() + static_cast<std::ptrdiff_t>(place), visited.end());
    overlay.highest = visited[place];
  }
  const double unit = overlay.highest > 0 ? 1.0 / overlay.highest : 0.0;
  for (std::size_t i = 0; i < pixel_nodes.size(); ++i) {
    put(overlay.image, i, heat_color(pixel_nodes[i] * unit));
  }
  return overlay;
}

OverlayImage class_map(const render::FrameResult& result, std::span<const std::uint8_t> classes) {
  OverlayImage overlay{.kind = Overlay::classes, .image = empty_like(result.image)};
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const auto index = std::min<std::size_t>(classes[i], class_looks.size() - 1);
    ++overlay.class_sizes[index];
    put(overlay.image, i, class_looks[index].color);
  }
  return overlay;
}

}  // namespace

glm::u8vec3 heat_color(double part) {
  const double at = std::clamp(part, 0.0, 1.0) * (heat_stops.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), heat_stops.size() - 2);
  const glm::dvec3 mixed =
      glm::mix(glm::dvec3(heat_stops[low]), glm::dvec3(heat_stops[low + 1]), at - static_cast<double>(low));
  return glm::u8vec3(glm::round(mixed));
}

glm::u8vec3 class_color(SoftClass soft_class) {
  return class_looks[static_cast<std::size_t>(soft_class)].color;
}

const char* class_name(SoftClass soft_class) {
  return class_looks[static_cast<std::size_t>(soft_class)].name;
}

OverlayImage make_overlay(Overlay kind, const render::FrameResult& result) {
  if (kind == Overlay::nodes) {
    const auto nodes = nodes_of(result);
    return nodes.empty() ? OverlayImage{} : heat_map(result, nodes);
  }
  if (kind == Overlay::classes) {
    const auto classes = classes_of(result);
    return classes.empty() ? OverlayImage{} : class_map(result, classes);
  }
  return {};
}

}  // namespace tenebra::viewer
