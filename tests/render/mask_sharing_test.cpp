// Which samples take the hard shadows of pixels' centres, and which need their own.
#include "render/antialias/mask_sharing.h"

#include <gtest/gtest.h>

#include "support/hand_made.h"

namespace tenebra {
namespace {

using render::MaskAgreement;
using render::MaskSharing;
using render::SamplePicture;

constexpr int halves_width = 8, halves_height = 4;
const std::vector<glm::vec2> offsets{{0.25f, 0.25f}, {-0.25f, 0.125f}};

/// The left half of a small picture sees a wall, the right half another one far before it.
class Sharing : public ::testing::Test {
protected:
  Sharing() {
    add_triangle(geometry_, {-99, -99, -9}, {99, -99, -9}, {0, 99, -9});
    add_triangle(geometry_, {-99, -99, -1}, {99, -99, -1}, {0, 99, -1});
    for (int i = 0; i < halves_width * halves_height; ++i)
      ids_.push_back(i % halves_width < halves_width / 2 ? 0 : 1);
  }
  static std::size_t pixel(int x, int y) { return static_cast<std::size_t>(y * halves_width + x); }

  /// Of chosen pixels whose first sample sees triangle 0 and whose second sees 1, both for one light.
  void share(const std::vector<std::uint32_t>& chosen, std::uint32_t second = 1) {
    visibility::PlaceIds seen;
    seen.begin(halves_width, halves_height, offsets.size(), false);
    seen.open_all();
    seen.set_place(0, std::vector<std::uint32_t>(ids_.size(), 0), {});
    seen.set_place(1, std::vector<std::uint32_t>(ids_.size(), second), {});
    pack_samples(chosen, halves_width, offsets, seen, ids_, samples_);
    render::CentreMasks centres{halves_width, halves_height, ids_, {}, glass_};
    centres.masks.emplace_back(mask_);
    const ViewRays view = forward_view({0, 0, 0}, 8.0f, halves_width, halves_height);
    share_masks(centres, samples_, render::SurfaceMatch(geometry_, view), shared_);
  }
  std::uint32_t from(std::size_t chosen, std::size_t sample) const {
    return shared_.from[samples_.slots[chosen * offsets.size() + sample]];
  }

  FrameGeometry geometry_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint8_t> mask_ = std::vector<std::uint8_t>(halves_width * halves_height, 255);
  std::vector<std::uint8_t> glass_;
  SamplePicture samples_;
  MaskSharing shared_;
};

TEST_F(Sharing, SamplesTakeMasksOfCentresThatSeeTheirSurface) {
  share({static_cast<std::uint32_t>(pixel(3, 1)), static_cast<std::uint32_t>(pixel(4, 2))});
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_LT(from(i, 0), MaskAgreement::unlit);
    EXPECT_EQ(ids_[from(i, 0)], 0u);
    ASSERT_LT(from(i, 1), MaskAgreement::unlit);
    EXPECT_EQ(ids_[from(i, 1)], 1u);
  }
  EXPECT_TRUE(shared_.own_slots.empty());
}

TEST_F(Sharing, ShadowEdgesNearbyNeedMasksOfTheirOwn) {
  mask_[pixel(2, 0)] = 0;  // on the wall behind
  share({static_cast<std::uint32_t>(pixel(3, 1)), static_cast<std::uint32_t>(pixel(3, 2))});
  EXPECT_EQ(from(0, 0), MaskAgreement::none) << "diagonally next to it";
  EXPECT_LT(from(0, 1), MaskAgreement::unlit) << "the wall in front has no edge";
  EXPECT_LT(from(1, 0), MaskAgreement::unlit) << "two pixels away";
  ASSERT_EQ(shared_.own_slots.size(), 1u);
  EXPECT_EQ(shared_.own_slots[0], samples_.slots[0]);
  EXPECT_EQ(shared_.own_ids[points::SampleGrid(1).pixel(0)], 0u);
  EXPECT_EQ(shared_.own_places[points::SampleGrid(1).pixel(0)], glm::vec2(3.75f, 1.75f));
}

TEST_F(Sharing, SurfacesThatFewCentresSeeNeedTheirOwn) {
  share({static_cast<std::uint32_t>(pixel(1, 1))});
  EXPECT_LT(from(0, 0), MaskAgreement::unlit);
  EXPECT_EQ(from(0, 1), MaskAgreement::none) << "no centre around sees it";
  ids_[pixel(2, 2)] = 1;
  share({static_cast<std::uint32_t>(pixel(1, 1))});
  EXPECT_EQ(from(0, 1), MaskAgreement::none) << "one does";
}

TEST_F(Sharing, GlassNearbyNeedsMasksOfTheirOwn) {
  glass_.assign(ids_.size(), 0);
  glass_[pixel(2, 0)] = 1;  // before the wall behind
  share({static_cast<std::uint32_t>(pixel(3, 1)), static_cast<std::uint32_t>(pixel(3, 2))});
  EXPECT_EQ(from(0, 0), MaskAgreement::none) << "diagonally next to it";
  EXPECT_LT(from(0, 1), MaskAgreement::unlit) << "none is before the wall in front";
  EXPECT_LT(from(1, 0), MaskAgreement::unlit) << "two pixels away";
}

TEST_F(Sharing, BackgroundIsUnlit) {
  share({static_cast<std::uint32_t>(pixel(3, 1))}, no_triangle);
  EXPECT_EQ(from(0, 1), MaskAgreement::unlit);
  EXPECT_TRUE(shared_.own_slots.empty());
}

}  // namespace
}  // namespace tenebra
