#include "options/method_options.h"

namespace tenebra::viewer {

void add_method_options(CLI::App& command, MethodOptions& options) {
  add_settings(command, settings::method_table(), options);
}

void add_tracer_options(CLI::App& command, MethodOptions& options) {
  add_settings(command, settings::method_table(), options,
               {"light", "variant", "cull", "threads", "simd", "shadows", "light-size", "sun-size",
                "light-facing", "light-emission", "emissive-lights", "soft-solver", "soft-memory"});
}

void settle_quality(const CLI::App& command, MethodOptions& options) {
  settings::settle_quality(given_settings(command), options);
}

std::vector<std::string> idle_method_options(const CLI::App& command, const MethodOptions& options) {
  return settings::idle_sentences(given_settings(command), options);
}

}  // namespace tenebra::viewer
