#include "formats/aff/files.h"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "formats/aff/lexer.h"

namespace tenebra::formats {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t largest_file = std::uint64_t{1} << 31;

struct CloseFile {
  void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
};

std::string read_whole(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) throw AffFailure{"something that is no regular file"};
  const std::uint64_t size = fs::file_size(path, error);
  if (error) throw AffFailure{fmt::format("a file that cannot be read ({})", error.message())};
  if (size > largest_file) throw AffFailure{fmt::format("a file of {} bytes, more than 2 GiB", size)};
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) throw AffFailure{fmt::format("a file that cannot be opened ({})", std::strerror(errno))};
  std::string text(size, '\0');
  errno = 0;
  if (std::fread(text.data(), 1, text.size(), file.get()) != text.size()) {
    throw AffFailure{fmt::format("a file that cannot be read to its end ({})",
                                 errno != 0 ? std::strerror(errno) : "it became shorter")};
  }
  return text;
}

bool lies_within(const fs::path& path, const fs::path& root) {
  const auto [end, unused] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  return end == root.end();
}

void check_name(std::string_view name) {
  const fs::path path{std::string(name)};
  const bool climbs = std::find(path.begin(), path.end(), fs::path("..")) != path.end();
  if (path.is_absolute() || climbs || name.find('\0') != std::string_view::npos) {
    throw AffFailure{fmt::format("include of {}, which points out of the scene's folder", quote_word(name))};
  }
}

}  // namespace

AffFile& AffFiles::load(const fs::path& canonical) {
  std::unique_ptr<AffFile>& entry = files_[canonical];
  if (!entry) {
    std::string text = read_whole(canonical);
    bytes_read_ += text.size();
    entry = std::make_unique<AffFile>(
        AffFile{canonical.filename().string(), canonical.parent_path(), std::move(text), false});
  }
  return *entry;
}

void AffFiles::list(std::vector<fs::path>& paths) const {
  for (const auto& entry : files_) paths.push_back(entry.first);
}

AffFile& AffFiles::open_top(const fs::path& path) {
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  root_ = fs::canonical(folder, error);
  const fs::path file = root_ / path.filename();
  if (error || !fs::exists(file, error)) throw AffFailure{"no such file"};
  return load(file);
}

AffFile& AffFiles::open_include(std::string_view name, const AffFile& from) {
  AffFile*& known = resolved_[{&from, std::string(name)}];
  if (known) return *known;
  check_name(name);
  for (const fs::path& folder : {from.folder, root_}) {
    std::error_code error;
    const fs::path found = fs::canonical(folder / fs::path{std::string(name)}, error);
    if (error == std::errc::no_such_file_or_directory) continue;
    if (error) throw AffFailure{fmt::format("include of {} ({})", quote_word(name), error.message())};
    if (!lies_within(found, root_)) {
      throw AffFailure{fmt::format("include of {}, a link out of the scene's folder", quote_word(name))};
    }
    known = &load(found);
    return *known;
  }
  throw AffFailure{fmt::format("include of {}, which is missing from the scene's folder", quote_word(name))};
}

}  // namespace tenebra::formats
