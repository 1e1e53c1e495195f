// A fuzzer's bytes as a file.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace tenebra::fuzz {

/// A file of this process alone, whose content each input replaces; gone when the process ends.
class InputFile {
public:
  explicit InputFile(const std::string& extension)
      : folder_(std::filesystem::temp_directory_path() / ("tenebra-fuzz-" + std::to_string(::getpid()))),
        path_(folder_ / ("input" + extension)) {
    std::filesystem::create_directories(folder_);
  }
  ~InputFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& write(const std::uint8_t* bytes, std::size_t size) const {
    std::FILE* const file = std::fopen(path_.c_str(), "wb");
    if (file == nullptr || std::fwrite(bytes, 1, size, file) != size || std::fclose(file) != 0) std::abort();
    return path_;
  }
  std::filesystem::path beside(const std::string& name) const { return folder_ / name; }

private:
  std::filesystem::path folder_;
  std::filesystem::path path_;
};

}  // namespace tenebra::fuzz
