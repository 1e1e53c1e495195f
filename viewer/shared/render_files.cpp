#include "shared/render_files.h"

#include <fmt/core.h>

namespace tenebra::viewer {

std::vector<OutputName> files_of_frame(const RenderPlan& plan, const RenderOptions& options, int frame) {
  std::vector<OutputName> files;
  const auto add = [&](const char* option, const std::vector<OutputPattern>& patterns,
                       bool each_sample = false) {
    const int samples = each_sample ? plan.settings.antialias : 1;
    for (const OutputPattern& pattern : patterns)
      for (int light = 0; light < plan.lights; ++light)
        for (int sample = 0; sample < samples; ++sample) {
          std::string suffix = plan.several_lights ? fmt::format("_L{}", light) : "";
          if (each_sample) suffix += fmt::format("_S{}", sample);
          files.push_back({option, pattern.file(frame, suffix)});
        }
  };
  if (options.pictures.files) files.push_back({"-o", options.pictures.files->file(frame)});
  add("--mask", options.masks);
  add("--mask colour", options.mask_colours);
  add("--mask mean", options.mask_means);
  add("--mask error", options.error_maps);
  add("--mask samples", options.mask_samples, true);
  return files;
}

OutputNames files_of_render(const RenderPlan& plan, const RenderOptions& options) {
  return [&](const std::function<Expected<void>(const OutputName&)>& use) -> Expected<void> {
    std::vector<OutputName> files;
    if (!options.log.empty()) files.push_back({"--log", options.log});
    if (!options.trace.empty()) files.push_back({"--log trace", options.trace});
    if (options.pictures.to_pipe) files.push_back({"-o", "/dev/stdout"});
    for (std::size_t i = 0; i <= plan.frames.size(); ++i) {
      for (const OutputName& file : files)
        if (auto used = use(file); !used) return used;
      if (i < plan.frames.size()) files = files_of_frame(plan, options, plan.frames[i].frame);
    }
    return {};
  };
}

}  // namespace tenebra::viewer
