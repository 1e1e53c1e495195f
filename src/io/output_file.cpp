#include "io/output_file.h"

#include "base/fail.h"
#include "io/output_stream.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <string>
#include <system_error>
#include <utility>

namespace tenebra::io {
namespace {

namespace fs = std::filesystem;

constexpr int no_descriptor = -1;
constexpr int temporary_name_tries = 1000;

std::string reason(int error) {
  return std::generic_category().message(error);
}

constexpr std::string_view temporary_begin = ".tenebra-", temporary_end = ".tmp";
/// How long a file of another machine, which may not see our locks, counts as being written.
constexpr std::chrono::hours strangers_patience{1};

/// What the names of this machine's temporary files begin with.
std::string prefix_of_this_machine() {
  std::array<char, 65> name{};
  ::gethostname(name.data(), name.size() - 1);
  std::string host = name.data();
  std::erase_if(host, [](char c) { return c == '/'; });
  return fmt::format("{}{}-", temporary_begin, host);
}

/// Locks the file at `path`, which ends with the process. False if another process holds it, or if it stands
/// there no more. File systems without locks are trusted.
bool lock_in_place(const Descriptor& file, const fs::path& path) {
  if (::flock(file.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
  struct stat locked {
  }, named{};
  return ::fstat(file.number(), &locked) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         locked.st_ino == named.st_ino && locked.st_dev == named.st_dev;
}

void remove_if_stale(const fs::path& path) {
  std::error_code error;
  const bool ours = path.filename().string().starts_with(prefix_of_this_machine());
  const auto written = fs::last_write_time(path, error);
  if (error || (!ours && fs::file_time_type::clock::now() - written < strangers_patience)) return;
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC));
  if (file && lock_in_place(file, path)) ::unlink(path.c_str());
}

/// Where a link that leads to no file leads: what is written there becomes its file. To rename over the link
/// itself would take it away, which of /dev/stdout, where that is closed, nobody wants.
fs::path end_of_link(fs::path path) {
  constexpr int most_links = 40;  // as the system follows
  std::error_code error;
  for (int i = 0; i < most_links && fs::is_symlink(fs::symlink_status(path, error)); ++i)
    path = path.parent_path() / fs::read_symlink(path, error);  // absolute ones replace all before them
  return path;
}

}  // namespace

void remove_stale_temporaries(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(temporary_begin) && name.ends_with(temporary_end)) remove_if_stale(entry->path());
  }
}

tl::unexpected<Error> OutputFile::system_failure(int error) const {
  return base::fail(ErrorKind::file, "cannot write {}: {}", path_.string(), reason(error));
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
  } else {
    file.target_ = end_of_link(path);
  }
  if (auto opened = file.open_temporary(); !opened) return tl::unexpected(opened.error());
  if (exists)
    ::fchmod(file.descriptor_, found.st_mode & 0777);  // best effort: some file systems have no modes
  return file;
}

Expected<void> OutputFile::open_temporary() {
  // A short name of its own, so that a long `path` stays possible; O_EXCL keeps concurrent writers apart.
  for (int i = 0; i < temporary_name_tries; ++i) {
    temporary_ = target_.parent_path() / (prefix_of_this_machine() + fmt::format("{}-{}.tmp", ::getpid(), i));
    Descriptor opened(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (opened && lock_in_place(opened, temporary_)) {
      descriptor_ = opened.release();
      return {};
    }
    if (opened || errno == EEXIST) continue;
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
  const Descriptor lock(::fcntl(descriptor_, F_DUPFD_CLOEXEC, 0));  // held until the file has its name
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

}  // namespace tenebra::io
