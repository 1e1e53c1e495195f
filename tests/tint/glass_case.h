// Scenes of panes for the tests of tint, and the peer: Embree with a filter that multiplies.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <vector>

#include <tenebra/hard_shadows.h>
#include <tenebra/soft_shadows.h>
#include <tenebra/tint.h>
#include "support/samples.h"
#include "support/soup.h"

namespace tenebra::testing {

/// Triangles with materials; the opaque ones first.
struct Glass {
  Soup soup;
  Scene scene;
  std::vector<std::uint8_t> see_through;
  std::vector<std::uint32_t> materials;
  std::vector<glm::vec2> uv;
  std::vector<glm::vec4> colors;

  /// `place`: texture coordinates of a vertex.
  void add(
      const Soup& part, const Material& material,
      const std::function<glm::vec2(glm::vec3)>& place = [](glm::vec3) { return glm::vec2(0); }) {
    scene.materials.push_back(material);
    soup.append(part);
    const bool through = material.see_through();
    for (std::size_t i = 0; i < part.triangles.size(); ++i) {
      see_through.push_back(through);
      soup.casts.push_back(!through);
      materials.push_back(static_cast<std::uint32_t>(scene.materials.size() - 1));
    }
    for (const glm::vec3& p : part.positions) uv.push_back(place(p));
    colors.resize(soup.positions.size(), glm::vec4(1.0f));
  }
  SeeThroughSurfaces surfaces() const { return {&scene, see_through, materials, {uv, {}}, colors}; }
  std::size_t opaque_count() const {
    return static_cast<std::size_t>(std::count(see_through.begin(), see_through.end(), 0));
  }
  /// What a camera sees of the opaque ones.
  VisiblePoints samples(const ViewRays& view, int width, int height) const {
    Soup opaque = soup;
    opaque.triangles.resize(opaque_count());
    VisiblePoints points = view_samples(opaque.view(), view, width, height);
    return points;
  }
};

inline Material pane(glm::vec3 color, float transmission, bool tinted = true) {
  Material m;
  m.base_color = color;
  m.transmission = transmission;
  m.tinted_transmission = tinted;
  return m;
}
inline Material blend(float alpha) {
  Material m;
  m.alpha_mode = AlphaMode::blend;
  m.alpha = alpha;
  return m;
}

/// What a material lets pass, written down a second time: stored texels between the four nearest, repeated.
inline glm::vec3 passes(const Glass& glass, std::uint32_t id, float u, float v) {
  const Material& m = glass.scene.materials[glass.materials[id]];
  const glm::uvec3 t = glass.soup.triangles[id];
  const auto between = [&](const auto& values) {
    return values[t.x] * (1 - u - v) + values[t.y] * u + values[t.z] * v;
  };
  const glm::vec4 vertex = between(glass.colors);
  const auto texel = [&](const TextureMap& map) {
    if (!map) return glm::vec4(1.0f);
    const TextureImage& image = glass.scene.images[static_cast<std::size_t>(map.image)];
    const glm::vec2 at = between(glass.uv);
    const double x = at.x * image.width - 0.5, y = at.y * image.height - 0.5;
    glm::dvec4 sum(0.0);
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx) {
        const auto modulo = [](double i, int n) { return static_cast<int>(i - n * std::floor(i / n)); };
        const int column = modulo(std::floor(x) + dx, image.width);
        const int row = modulo(std::floor(y) + dy, image.height);
        const double fx = x - std::floor(x), fy = y - std::floor(y);
        const std::uint8_t* p = &image.rgba[static_cast<std::size_t>(4 * (row * image.width + column))];
        sum += (dx == 1 ? fx : 1 - fx) * (dy == 1 ? fy : 1 - fy) * glm::dvec4(p[0], p[1], p[2], p[3]) / 255.0;
      }
    return glm::vec4(sum);
  };
  glm::vec4 base = texel(m.base_color_map);
  if (m.base_color_map && glass.scene.transfer == Transfer::srgb)
    for (int c = 0; c < 3; ++c)
      base[c] = base[c] <= 0.04045f ? base[c] / 12.92f : std::pow((base[c] + 0.055f) / 1.055f, 2.4f);
  const float a = m.alpha_mode == AlphaMode::blend ? m.alpha * base.w * vertex.w : 1;
  const float through = m.transmission * texel(m.transmission_map).x;
  const glm::vec3 tint =
      m.tinted_transmission ? m.base_color * glm::vec3(base) * glm::vec3(vertex) : glm::vec3(1.0f);
  return (1 - a) + a * through * tint;
}

/// Embree over glass: along a segment, 0 where an opaque triangle stands, else what all panes let pass.
class GlassPeer {
public:
  explicit GlassPeer(const Glass& glass) : glass_(glass), device_(rtcNewDevice("threads=1")) {
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const Soup& soup = glass.soup;
    RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, soup.positions.size()));
    for (const glm::vec3& p : soup.positions)
      for (int k = 0; k < 3; ++k) *positions++ = p[k];
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, soup.triangles.size()));
    for (const glm::uvec3& t : soup.triangles)
      for (int k = 0; k < 3; ++k) *indices++ = t[k];
    rtcSetGeometryUserData(mesh, this);
    rtcSetGeometryOccludedFilterFunction(mesh, filter);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene_, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(scene_);
  }
  ~GlassPeer() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  GlassPeer(const GlassPeer&) = delete;
  GlassPeer& operator=(const GlassPeer&) = delete;

  /// From `from`, on triangle `own`, along `way`: to its end, or (directional) on and on.
  glm::dvec3 passed(glm::dvec3 from, glm::dvec3 way, std::uint32_t own, bool endless = false) {
    met_.clear();
    factor_ = glm::dvec3(1.0);
    own_ = own;
    RTCRay ray{float(from.x),
               float(from.y),
               float(from.z),
               1e-5f,
               float(way.x),
               float(way.y),
               float(way.z),
               0,
               endless ? HUGE_VALF : 1.0f,
               ~0u,
               0,
               0};
    ao::EmbreeQuery().occluded1(scene_, ray);
    return ray.tfar < 0 ? glm::dvec3(0.0) : factor_;
  }

private:
  static void filter(const RTCFilterFunctionNArguments* args) {
    GlassPeer& peer = *static_cast<GlassPeer*>(args->geometryUserPtr);
    const std::uint32_t id = RTCHitN_primID(args->hit, args->N, 0);
    if (id == peer.own_) {
      args->valid[0] = 0;
    } else if (peer.glass_.see_through[id] != 0) {
      args->valid[0] = 0;
      if (std::find(peer.met_.begin(), peer.met_.end(), id) != peer.met_.end()) return;
      peer.met_.push_back(id);
      peer.factor_ *= glm::dvec3(
          passes(peer.glass_, id, RTCHitN_u(args->hit, args->N, 0), RTCHitN_v(args->hit, args->N, 0)));
    }
  }

  const Glass& glass_;
  RTCDevice device_;
  RTCScene scene_;
  std::uint32_t own_ = no_triangle;
  std::vector<std::uint32_t> met_;
  glm::dvec3 factor_{1.0};
};

/// A factor for each pixel.
inline std::vector<glm::vec3> spread(const TintMask& mask, std::size_t pixels) {
  std::vector<glm::vec3> out(pixels, glm::vec3(1.0f));
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) out[mask.pixels[i]] = mask.factors[i];
  return out;
}

inline TintMask traced(const Glass& glass, const VisiblePoints& points, const ViewRays& view,
                       const ShadowLight& light, ShadowMask* lit = nullptr, TintStats* stats = nullptr) {
  ShadowMask mask;
  ShadowTracer().trace_shadow_mask(seen_from(points, view), glass.soup.view(), light, {}, mask);
  TintMask out;
  TintTracer tracer;
  tracer.trace(seen_from(points, view), glass.soup.view(), glass.surfaces(), light, mask, {}, out);
  if (lit != nullptr) *lit = mask;
  if (stats != nullptr) *stats = tracer.stats();
  return out;
}

/// A picture of smooth waves: no two neighbours far apart, so that a place off by a little changes little.
inline TextureImage waves(int size) {
  TextureImage image{"waves", size, size, {}};
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      for (int c = 0; c < 4; ++c) {
        const double wave =
            std::sin(6.283185307 * (x + c * 3.0) / size) * std::cos(6.283185307 * (y * (c % 2 + 1)) / size);
        image.rgba.push_back(static_cast<std::uint8_t>(std::lround(127.5 + 110 * wave)));
      }
  return image;
}

}  // namespace tenebra::testing
