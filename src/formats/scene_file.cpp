#include "formats/scene_file.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <new>
#include <system_error>

#include "formats/import_failure.h"

namespace tenebra::formats {
namespace fs = std::filesystem;
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::string undo_percent(std::string_view uri, std::string_view place) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      text += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
    if (high < 0 || low < 0) refuse("{}: found '{}', expected two hexadecimal digits after %", place, uri);
    text += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return text;
}

std::uintmax_t scene_file_size(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) refuse("found no such file, expected a readable file");
  if (!fs::is_regular_file(status)) refuse("found something that is not a file, expected a readable file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) refuse("cannot tell its size ({}), expected a readable file", error.message());
  if (size > max_scene_file_bytes) refuse("found {} bytes, expected at most {}", size, max_scene_file_bytes);
  return size;
}

std::string read_scene_file(const fs::path& path, std::vector<fs::path>* files_read) {
  const std::uintmax_t size = scene_file_size(path);
  std::string bytes(size, '\0');
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw UnreadableFile(fmt::format("found an unreadable file ({}), expected {} bytes",
                                     errno != 0 ? std::generic_category().message(errno) : "it ends early",
                                     size));
  if (files_read != nullptr) files_read->push_back(path);
  return bytes;
}

fs::path confine(const fs::path& folder, std::string_view uri, std::string_view place, bool percent_encoded,
                 const fs::path& root) {
  std::string text = percent_encoded ? undo_percent(uri, place) : std::string(uri);
  std::replace(text.begin(), text.end(), '\\', '/');  // written on Windows
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
  const bool odd = text.empty() || std::any_of(text.begin(), text.end(), is_control) ||
                   text.find(':') != std::string::npos;
  const fs::path relative(text);
  const bool climbs = std::find(relative.begin(), relative.end(), "..") != relative.end();
  if (odd || relative.is_absolute() || (climbs && root.empty()))
    refuse("{}: found '{}', expected a relative path inside the scene's folder", place, uri);
  std::error_code error;
  const auto resolve = [&](const fs::path& path) {
    return error ? fs::path() : fs::weakly_canonical(path, error);
  };
  const fs::path here = resolve(folder.empty() ? fs::path(".") : folder),
                 around = root.empty() ? here : resolve(root);
  const fs::path target = resolve(here / relative);
  if (error == std::errc::not_enough_memory) throw std::bad_alloc();
  if (error)
    refuse("{}: cannot resolve '{}' ({}), expected a file in the folder", place, uri, error.message());
  const auto inside = std::mismatch(around.begin(), around.end(), target.begin(), target.end());
  if (inside.first != around.end())
    refuse("{}: found '{}' leading out of {}, expected a file inside it", place, uri,
           root.empty() ? "the scene's folder" : "the folder that holds its files");
  return target;
}

}  // namespace tenebra::formats
