#include "base/output_file.h"

#include "base/fail.h"
#include "base/output_stream.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace tenebra::base {
namespace {

namespace fs = std::filesystem;

constexpr int no_descriptor = -1;
constexpr int temporary_name_tries = 1000;

std::string reason(int error) {
  return std::generic_category().message(error);
}

}  // namespace

tl::unexpected<Error> OutputFile::system_failure(int error) const {
  return fail("cannot write {}: {}", path_.string(), reason(error));
}

Expected<OutputFile> OutputFile::create(const fs::path& path) {
  OutputFile file;
  file.path_ = path;
  file.target_ = path;
  struct stat found {};
  const bool exists = ::stat(path.c_str(), &found) == 0;
  if (!exists && errno != ENOENT)
    return file.system_failure(errno);  // name too long, a file as a folder, ...
  if (exists) {
    auto stream = open_stream(path, found);
    if (!stream) return tl::unexpected(stream.error());
    file.descriptor_ = stream->release();
    if (file.descriptor_ != no_descriptor) return file;
  }
  if (exists) {
    // Renaming would replace a file that its owner made read-only; no one expects that.
    if (::access(path.c_str(), W_OK) != 0) return file.system_failure(errno);
    std::error_code error;
    file.target_ = fs::canonical(path, error);
    if (error) return file.system_failure(error.value());
  }
  if (auto opened = file.open_temporary(); !opened) return tl::unexpected(opened.error());
  if (exists)
    ::fchmod(file.descriptor_, found.st_mode & 0777);  // best effort: some file systems have no modes
  return file;
}

Expected<void> OutputFile::open_temporary() {
  // A short name of its own, so that a long `path` stays possible; O_EXCL keeps concurrent writers apart.
  for (int i = 0; i < temporary_name_tries; ++i) {
    temporary_ = target_.parent_path() / fmt::format(".tenebra-{}-{}.tmp", ::getpid(), i);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ != no_descriptor) return {};
    if (errno == EEXIST) continue;
    const int error = errno;
    temporary_.clear();
    return system_failure(error);
  }
  temporary_.clear();
  return system_failure(EEXIST);
}

OutputFile::OutputFile(OutputFile&& other) noexcept {
  *this = std::move(other);
}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  path_.swap(other.path_);
  target_.swap(other.target_);
  temporary_.swap(other.temporary_);
  return *this;
}

OutputFile::~OutputFile() {
  if (descriptor_ != no_descriptor) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Expected<void> OutputFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return system_failure(errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Expected<void> OutputFile::commit() {
  if (!temporary_.empty() && ::fsync(descriptor_) != 0) return system_failure(errno);
  if (::close(std::exchange(descriptor_, no_descriptor)) != 0) return system_failure(errno);
  if (temporary_.empty()) return {};
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) return system_failure(errno);
  temporary_.clear();
  return {};
}

Expected<void> write_file(const fs::path& path, std::string_view bytes) {
  auto file = OutputFile::create(path);
  if (!file) return tl::unexpected(file.error());
  if (auto written = file->write(bytes); !written) return written;
  return file->commit();
}

}  // namespace tenebra::base
