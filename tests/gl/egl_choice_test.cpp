// Which device is taken, on machines that are not this one.
#include "gl/egl_choice.h"

#include <gtest/gtest.h>

#include <vector>

namespace tenebra::gl {
namespace {

using enum EglPlatform;
using enum Draws;

struct Machine {
  std::vector<EglPlatform> platforms;
  std::vector<Draws> draws;
};

std::optional<std::size_t> chosen(const Machine& machine) {
  std::vector<int> asked(machine.draws.size());
  return choose_platform(machine.platforms, [&](std::size_t i) {
    EXPECT_EQ(++asked[i], 1) << "a context is made on " << i << " again";
    return machine.draws[i];
  });
}

TEST(EglChoice, TakesAGpuBehindDevicesThatFailOrAreSoftware) {
  EXPECT_EQ(chosen({{device, device, software_device, surfaceless},
                    {by_software, by_hardware, by_software, by_software}}),
            1u);
  EXPECT_EQ(chosen({{software_device, device, device, surfaceless},
                    {by_software, nothing, by_hardware, by_software}}),
            2u);
  EXPECT_EQ(chosen({{device, device, surfaceless}, {by_hardware, by_hardware, nothing}}), 0u);
}

TEST(EglChoice, TakesTheSurfacelessPlatformWithoutAGpu) {
  EXPECT_EQ(chosen({{surfaceless}, {by_software}}), 0u);
  EXPECT_EQ(chosen({{software_device, surfaceless}, {by_software, by_software}}), 1u);
  EXPECT_EQ(chosen({{device, software_device, surfaceless}, {by_software, by_software, by_hardware}}), 2u);
}

TEST(EglChoice, TakesSoftwareOfADeviceWhereNothingElseDraws) {
  EXPECT_EQ(chosen({{software_device, surfaceless}, {by_software, nothing}}), 0u);
  EXPECT_EQ(chosen({{device, device, surfaceless}, {nothing, by_software, nothing}}), 1u);
  EXPECT_EQ(chosen({{device, software_device, surfaceless}, {nothing, by_software, nothing}}), 1u);
}

TEST(EglChoice, FindsNothingWhereNothingDraws) {
  EXPECT_EQ(chosen({{device, software_device, surfaceless}, {nothing, nothing, nothing}}), std::nullopt);
  EXPECT_EQ(chosen({}), std::nullopt);
}

TEST(EglChoice, LeavesSoftwareDevicesAloneWhereAGpuDraws) {
  std::vector<std::size_t> asked;
  const std::vector<EglPlatform> platforms{software_device, device, surfaceless};
  choose_platform(platforms, [&](std::size_t i) {
    asked.push_back(i);
    return by_hardware;
  });
  EXPECT_EQ(asked, std::vector<std::size_t>{1});
}

}  // namespace
}  // namespace tenebra::gl
