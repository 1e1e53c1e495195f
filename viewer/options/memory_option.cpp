#include "options/memory_option.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace tenebra::viewer {
namespace {

constexpr int share_of_ao = 4;

}  // namespace

AddedOption add_memory_option(CLI::App& command, std::optional<int>& memory_mb, const char* help) {
  return add_value(command, "--memory", memory_mb, parse_at_least_one, help).type_name("MB");
}

void settle_memory(const CLI::App& command, std::optional<int> memory_mb, MethodOptions& method) {
  const CLI::Option* const ao = command.get_option_no_throw("--ao-memory");  // which bake lacks
  if (!memory_mb || (ao != nullptr && ao->count() > 0)) return;
  int& ao_mb = method.render.ao.memory_mb;
  ao_mb = std::clamp(*memory_mb / share_of_ao, 1, ao_mb);
}

}  // namespace tenebra::viewer
