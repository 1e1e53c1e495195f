// Which devices and platforms there are, and which is taken.
#include "gl/survey.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gl/context.h"
#include "gl/renderer_name.h"

namespace tenebra::gl {
namespace {

const Offer* taken(const std::vector<Offer>& offers) {
  const auto found =
      std::find_if(offers.begin(), offers.end(), [](const Offer& offer) { return offer.taken; });
  return found != offers.end() ? &*found : nullptr;
}

TEST(Survey, TellsOfEachEitherWhatItIsOrWhatItLacks) {
  const std::vector<Offer> offers = survey();
  ASSERT_FALSE(offers.empty());
  for (const Offer& offer : offers) {
    EXPECT_FALSE(offer.name.empty());
    EXPECT_NE(offer.lacks.empty(), offer.renderer.empty()) << offer.name;
    EXPECT_EQ(offer.limits.empty(), !offer.lacks.empty()) << offer.name;
    for (const auto& [name, value] : offer.limits) EXPECT_GT(value, 0) << offer.name << " " << name;
  }
}

TEST(Survey, MarksTheOneThatAutomaticTakes) {
  const std::vector<Offer> offers = survey();
  const Offer* const one = taken(offers);
  ASSERT_NE(one, nullptr);
  EXPECT_EQ(std::count_if(offers.begin(), offers.end(), [](const Offer& offer) { return offer.taken; }), 1);
  const auto context = Context::create(ContextKind::automatic);
  ASSERT_TRUE(context) << context.error().message;
  EXPECT_NE(context->description().find(one->renderer), std::string::npos)
      << context->description() << " and " << one->renderer;
}

TEST(Survey, TakesNoSoftwareWhereAnEglDeviceIsHardware) {
  const std::vector<Offer> offers = survey();
  const bool any_hardware = std::any_of(offers.begin(), offers.end(), [](const Offer& offer) {
    return offer.lacks.empty() && !offer.software && offer.name != "OSMesa";
  });
  ASSERT_NE(taken(offers), nullptr);
  EXPECT_EQ(taken(offers)->software, !any_hardware);
}

TEST(Survey, EachDeviceCanBeAskedForByItsWord) {
  for (const Offer& offer : survey()) {
    if (offer.context.empty()) continue;
    const auto choice = context_choice_from_name(offer.context);
    ASSERT_TRUE(choice) << offer.context;
    const auto context = Context::create(*choice);
    ASSERT_EQ(context.has_value(), offer.lacks.empty()) << offer.context;
    if (!context) continue;
    EXPECT_NE(context->description().find(offer.renderer), std::string::npos) << context->description();
  }
}

TEST(Survey, ADeviceThatIsNotThereIsRefusedWithASentence) {
  const auto context = Context::create({ContextKind::egl, 31});
  ASSERT_FALSE(context);
  EXPECT_NE(context.error().message.find("device 31"), std::string::npos) << context.error().message;
}

TEST(RendererName, SaysWhichRenderersRunOnTheCpu) {
  for (const char* software : {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "Software Rasterizer",
                               "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (LLVM 10.0.0)))"})
    EXPECT_TRUE(is_software_renderer(software)) << software;
  for (const char* hardware : {"NVIDIA H100 80GB HBM3/PCIe/SSE2", "AMD Radeon RX 6600 (radeonsi, navi23)",
                               "Mesa Intel(R) UHD Graphics 620 (KBL GT2)", ""})
    EXPECT_FALSE(is_software_renderer(hardware)) << hardware;
}

}  // namespace
}  // namespace tenebra::gl
