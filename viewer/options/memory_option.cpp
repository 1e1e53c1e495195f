#include "options/memory_option.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace tenebra::viewer {
namespace {

constexpr int share_of_ao = 4, share_of_soft = 2;

bool was_stated(const CLI::App& command, const char* name) {
  const CLI::Option* const option = command.get_option_no_throw(name);  // bake lacks some
  return option != nullptr && option->count() > 0;
}

}  // namespace

AddedOption add_memory_option(CLI::App& command, std::optional<int>& memory_mb, const char* help) {
  return add_value(command, "--memory", memory_mb, parse_at_least_one, help).type_name("MB");
}

void settle_memory(const CLI::App& command, std::optional<int> memory_mb, MethodOptions& method) {
  if (!memory_mb) return;
  if (!was_stated(command, "--ao-memory")) {
    int& ao_mb = method.render.ao.memory_mb;
    ao_mb = std::clamp(*memory_mb / share_of_ao, 1, ao_mb);
  }
  if (!was_stated(command, "--soft-memory")) {
    method.render.soft.memory_bytes = bytes_of_mb(std::max(*memory_mb / share_of_soft, 1));
  }
}

}  // namespace tenebra::viewer
