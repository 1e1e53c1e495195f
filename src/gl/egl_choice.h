// Which of EGL's devices and platforms draws. Internal to gl.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

namespace tenebra::gl {

enum class EglPlatform { device, software_device, surfaceless };
enum class Draws { nothing, by_software, by_hardware };

/// The first device that draws by hardware; else the surfaceless platform, if it draws; else the first device
/// that does. None: nothing draws. `attempt` is asked once at most about each, in that order.
std::optional<std::size_t> choose_platform(std::span<const EglPlatform> platforms,
                                           const std::function<Draws(std::size_t)>& attempt);

}  // namespace tenebra::gl
