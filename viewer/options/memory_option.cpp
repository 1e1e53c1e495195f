#include "options/memory_option.h"

#include <algorithm>

namespace tenebra::viewer {
namespace {

constexpr int share_of_ao = 4, share_of_soft = 2;

}  // namespace

AddedOption add_memory_option(CLI::App& command, std::optional<int>& memory_mb, const char* help) {
  const auto read = [&command, &memory_mb](const std::vector<std::string>& texts) -> Expected<void> {
    for (const std::string& text : texts) {
      if (read_key(command, "--memory", text)) continue;
      const auto mb = parse_at_least_one(text);
      if (!mb) return tl::unexpected(mb.error());
      memory_mb = *mb;
    }
    return {};
  };
  return add_texts(command, "--memory", read, wrapped(help)).type_name("MB");
}

void settle_memory(const CLI::App& command, std::optional<int> memory_mb, MethodOptions& method) {
  if (!memory_mb) return;
  const Given given = given_settings(command);
  if (!given.contains("ao-memory")) {
    int& ao_mb = method.render.ao.memory_mb;
    ao_mb = std::clamp(*memory_mb / share_of_ao, 1, ao_mb);
  }
  if (!given.contains("soft-memory")) {
    method.render.soft.memory_bytes = bytes_of_mb(std::max(*memory_mb / share_of_soft, 1));
  }
}

}  // namespace tenebra::viewer
