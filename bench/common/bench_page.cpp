#include "bench/common/bench_page.h"

#include <fstream>
#include <iterator>

namespace tenebra::bench {

std::string read_page(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string section_of(const std::string& page, const std::string& title) {
  const auto first = page.find("## " + title + "\n");
  if (first == std::string::npos) return {};
  const auto next = page.find("\n## ", first);
  return page.substr(first, next == std::string::npos ? next : next + 1 - first);
}

}  // namespace tenebra::bench
