// The mask behind a cut card against Embree's rays through the whole card, which a filter lets pass where
// the texture's alpha is below the cutoff.
#include <gtest/gtest.h>

#include "ao/reference/embree.h"
#include "shadow/mask_case.h"
#include "stage/cutout/cards.h"
#include "stage/cutout/cutout.h"

namespace tenebra::testing {
namespace {

/// A scene whose one geometry is the whole card. The filter's user pointer is the scene of the card.
class FilteredCard {
public:
  explicit FilteredCard(const Scene& card)
      : card_(card), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    const Mesh& mesh = card.meshes[0];
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()));
    for (std::size_t i = 0; i < 3 * mesh.positions.size(); ++i)
      vertices[i] = mesh.positions[i / 3][static_cast<int>(i % 3)];
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
    for (std::size_t i = 0; i < 3 * mesh.triangles.size(); ++i)
      indices[i] = mesh.triangles[i / 3][static_cast<int>(i % 3)];
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryOccludedFilterFunction(geometry, &filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene_);
  }
  ~FilteredCard() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  FilteredCard(const FilteredCard&) = delete;
  FilteredCard& operator=(const FilteredCard&) = delete;

  bool blocks(glm::vec3 from, glm::vec3 to) {
    RTCRay ray{};
    ray.org_x = from.x, ray.org_y = from.y, ray.org_z = from.z;
    ray.dir_x = to.x - from.x, ray.dir_y = to.y - from.y, ray.dir_z = to.z - from.z;
    ray.tfar = 1, ray.mask = ~0u;
    near_line_ = false;
    ao::EmbreeQuery().occluded1(scene_, ray);
    return ray.tfar < 0;
  }
  bool near_line() const {
    return near_line_;
  }  ///< the last ray met the card within the tolerance of the line

private:
  static void filter(const RTCFilterFunctionNArguments* arguments) {
    auto* self = static_cast<FilteredCard*>(arguments->geometryUserPtr);
    const Mesh& mesh = self->card_.meshes[0];
    const glm::uvec3& t = mesh.triangles[RTCHitN_primID(arguments->hit, arguments->N, 0)];
    const float u = RTCHitN_u(arguments->hit, arguments->N, 0),
                v = RTCHitN_v(arguments->hit, arguments->N, 0);
    const auto& uv = mesh.texture_coordinates[0];
    const glm::vec2 at = uv[t.x] * (1 - u - v) + uv[t.y] * u + uv[t.z] * v;
    self->near_line_ = is_near_line(self->card_, at, 0.13);
    if (alpha_over(self->card_, at) < 0) arguments->valid[0] = 0;
  }

  const Scene& card_;
  RTCDevice device_;
  RTCScene scene_;
  bool near_line_ = false;
};

/// The card stands 0.3 above a floor three times as wide, tilted; the light above it.
void compare(const char* name, Scene card) {
  SCOPED_TRACE(name);
  for (glm::vec3& p : card.meshes[0].positions) p = {p.x, 0.3f + 0.35f * p.y, p.y};
  Scene cut = card;
  stage::cut_out_masks(cut);
  MaskCase c;
  c.soup.positions = cut.meshes[0].positions;
  c.soup.triangles = cut.meshes[0].triangles;
  const auto floor = static_cast<std::uint32_t>(c.soup.triangles.size());
  c.soup.quad({-1, 0, -1}, {0, 0, 3}, {3, 0, 0});
  c.soup.casts.assign(c.soup.triangles.size(), 1);
  c.light = {.position = {0.4f, 2.5f, 0.3f}};
  constexpr int size = 256;
  c.view = pinhole({0.5, 1.7, 3.2}, {0.5, 0, 0.4}, 0.5, size, size);
  c.points = view_samples(c.soup.view(), c.view, size, size);
  const ShadowMask mask = traced(c);
  FilteredCard peer(card);
  int samples = 0, dark = 0, near_line = 0, wrong = 0;
  for (std::size_t i = 0; i < c.points.triangles.size(); ++i) {
    if (c.points.triangles[i] == no_triangle || c.points.triangles[i] < floor) continue;
    const bool blocked = peer.blocks(glm::vec3(c.points.positions[i]), c.light.position);
    ++samples;
    dark += blocked;
    if (blocked == (mask[i] == 0)) continue;
    ++(peer.near_line() ? near_line : wrong);
  }
  printf("%s: %d samples, %d dark, %d differ within the tolerance, %d beyond\n", name, samples, dark,
         near_line, wrong);
  EXPECT_GT(dark, 500);
  EXPECT_LT(dark, samples);
  EXPECT_EQ(wrong, 0);
  EXPECT_LT(near_line, samples / 50);
}

TEST(CutShadow, IsThatOfFilteredRays) {
  compare("checker", card(checker(64, 8)));
  compare("leaf", card(leaf(128)));
  compare("fence", card(fence(64)));
  compare("noise", card(noise(48, 48, 1)));
  compare("leaf, repeated", card(leaf(32), {-1.3f, 0.2f}, {2.1f, 2.9f}));
}

}  // namespace
}  // namespace tenebra::testing
