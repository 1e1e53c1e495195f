// The files that Assimp may see.
#pragma once

#include <assimp/DefaultIOSystem.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tenebra::converter {

/// Opens one file, which may be a link, and files in one folder for reading, nothing else: other links and
/// `..` that lead out are refused, nothing is written, made or deleted.
class ConfinedFiles : public Assimp::DefaultIOSystem {
public:
  /// `main` is known by its text.
  ConfinedFiles(const std::filesystem::path& root, std::string main)
      : root_(std::filesystem::canonical(root)), main_(std::move(main)) {}

  bool Exists(const char* file) const override;
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  bool CreateDirectory(const std::string&) override { return false; }
  bool ChangeDirectory(const std::string&) override { return false; }
  bool DeleteFile(const std::string&) override { return false; }

  const std::vector<std::string>& opened() const { return opened_; }  ///< each once, in this order

private:
  bool is_inside(const char* file) const;

  std::filesystem::path root_;
  std::string main_;
  std::vector<std::string> opened_;
};

}  // namespace tenebra::converter
