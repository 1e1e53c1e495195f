#include "io/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "base/fail.h"
#include "io/input_file.h"
#include "io/output_stream.h"

namespace tenebra::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_bytes = std::size_t{1} << 30;
constexpr int tries = 100;
constexpr unsigned between_tries_us = 20'000;

/// Whether nobody else has a lock against it. File systems without locks are trusted.
bool lock(int descriptor, int kind) {
  return ::flock(descriptor, kind | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

}  // namespace

tl::unexpected<Error> Journal::system_failure(int error) const {
  return base::fail(ErrorKind::file, "cannot write {}: {}", path_.string(),
                    std::generic_category().message(error));
}

Expected<Journal> Journal::open(const fs::path& path, Writers writers) {
  Journal journal;
  journal.path_ = path;
  struct stat found {};
  journal.is_new_ = ::stat(path.c_str(), &found) != 0;
  if (!journal.is_new_) {
    auto stream = open_stream(path, found);
    if (!stream) return tl::unexpected(stream.error());
    journal.file_ = std::move(*stream);
    if (journal.file_) return journal;
  }
  journal.is_file_ = true;
  journal.file_ =
      Descriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_NONBLOCK | O_CLOEXEC, 0666));
  if (!journal.file_) return journal.system_failure(errno);
  if (!journal.take_lock(writers))
    return base::fail(ErrorKind::file, "cannot write {}: another process is writing it", path.string());
  if (::fstat(journal.file_.number(), &found) != 0) return journal.system_failure(errno);
  journal.size_ = static_cast<std::size_t>(found.st_size);
  return journal;
}

bool Journal::take_lock(Writers writers) {
  for (int i = 0; i < tries; ++i) {
    is_alone_ = lock(file_.number(), LOCK_EX);
    if (is_alone_ || (writers == Writers::many && lock(file_.number(), LOCK_SH))) return true;
    if (writers == Writers::one) return false;
    ::usleep(between_tries_us);
  }
  return false;
}

bool Journal::share() {
  is_alone_ = false;
  return !is_file_ || lock(file_.number(), LOCK_SH);
}

Expected<std::string> Journal::read() const {
  return is_file_ ? read_file(path_, most_bytes) : std::string();
}

Expected<void> Journal::begin(std::string_view head) {
  auto begun = keep(0);
  if (begun) begun = append(head);
  if (!begun && is_new_) ::unlink(path_.c_str());
  return begun;
}

Expected<void> Journal::keep(std::size_t bytes) {
  if (!is_file_) return {};
  if (::ftruncate(file_.number(), static_cast<off_t>(bytes)) != 0) return system_failure(errno);
  size_ = bytes;
  return {};
}

Expected<void> Journal::append(std::string_view lines) {
  auto written = write(lines);
  if (!written) {
    // What others have written meanwhile stays; their lines are of one length, and a torn one is no line.
    if (is_file_ && is_alone_) static_cast<void>(::ftruncate(file_.number(), static_cast<off_t>(size_)));
    return written;
  }
  size_ += lines.size();
  return {};
}

Expected<void> Journal::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_.number(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return system_failure(errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Expected<void> Journal::finish() {
  if (is_file_ && ::fsync(file_.number()) != 0) return system_failure(errno);
  if (::close(file_.release()) != 0) return system_failure(errno);
  return {};
}

}  // namespace tenebra::io
