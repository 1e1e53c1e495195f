// Output is whole or absent, whatever fails (the failures of files and disks; the program's are in
// tests/viewer).
#include "io/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "support/child_process.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

namespace fs = std::filesystem;
using testing::read_text;
using testing::run_in_child;
using testing::TemporaryFolder;
using Names = std::vector<std::string>;

constexpr int skip_code = 77;
constexpr uid_t nobody = 65534;

/// The failure must name the file and the system's reason, in one line.
void expect_failure(const Expected<void>& result, const fs::path& path, const std::string& reason) {
  ASSERT_FALSE(result.has_value()) << path;
  EXPECT_NE(result.error().message.find(path.string()), std::string::npos) << result.error().message;
  EXPECT_NE(result.error().message.find(reason), std::string::npos) << result.error().message;
  EXPECT_EQ(result.error().message.find('\n'), std::string::npos);
}

bool fails_with(const Expected<void>& result, const std::string& reason) {
  return !result && result.error().message.find(reason) != std::string::npos;
}

TEST(OutputFile, WritesWhatItIsGivenAndReplacesAnEarlierFile) {
  const TemporaryFolder folder;
  const std::string bytes("one\0two\n", 8);
  ASSERT_TRUE(io::write_file(folder / "a.txt", "a longer earlier text"));
  ASSERT_TRUE(io::write_file(folder / "a.txt", bytes));
  EXPECT_EQ(read_text(folder / "a.txt"), bytes);
  ASSERT_TRUE(io::write_file(folder / "empty", ""));
  EXPECT_EQ(folder.names(), (Names{"a.txt", "empty"})) << "no temporary file may be left";
}

TEST(OutputFile, IsAbsentUntilCommit) {
  const TemporaryFolder folder;
  {
    auto file = io::OutputFile::create(folder / "log.csv");
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write("row 1\n"));
    EXPECT_FALSE(fs::exists(folder / "log.csv"));
    EXPECT_EQ(folder.names().size(), 1u) << "rows are on disk as they come";
  }
  EXPECT_EQ(folder.names(), Names{}) << "dropped without commit";
}

TEST(OutputFile, ReportsAFullDevice) {
  // Linux has this device, which is always full; other systems, and some containers, do not.
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  expect_failure(io::write_file("/dev/full", "text"), "/dev/full", "No space left on device");
  EXPECT_TRUE(fs::is_character_file("/dev/full")) << "the device must not be replaced";
}

TEST(OutputFile, ReportsAMissingFolder) {
  const TemporaryFolder folder;
  expect_failure(io::write_file(folder / "no/a.txt", "text"), folder / "no/a.txt",
                 "No such file or directory");
  expect_failure(io::write_file("", "text"), "", "No such file or directory");
}

TEST(OutputFile, ReportsAFolderAsTarget) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "here");
  expect_failure(io::write_file(folder / "here", "text"), folder / "here", "Is a directory");
  EXPECT_EQ(folder.names(), Names{"here"});
}

TEST(OutputFile, ReportsAFileUsedAsFolder) {
  const TemporaryFolder folder;
  ASSERT_TRUE(io::write_file(folder / "file", "text"));
  expect_failure(io::write_file(folder / "file/a.txt", "text"), folder / "file/a.txt", "Not a directory");
}

TEST(OutputFile, ReportsANameTooLongAndTakesTheLongestPossible) {
  const TemporaryFolder folder;
  const fs::path too_long = folder / std::string(256, 'n');
  expect_failure(io::write_file(too_long, "text"), too_long, "File name too long");
  EXPECT_TRUE(io::write_file(folder / std::string(255, 'n'), "text"));
  EXPECT_EQ(folder.names(), Names{std::string(255, 'n')});
}

TEST(OutputFile, ReportsAFolderThatIsNotWritable) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "locked");
  fs::permissions(folder.path(), fs::perms(0755));
  fs::permissions(folder / "locked", fs::perms(0555));
  const int code = run_in_child([&] {
    if (::geteuid() == 0 && ::setuid(nobody) != 0) return skip_code;  // root may write anywhere
    return fails_with(io::write_file(folder / "locked/a.txt", "text"), "Permission denied") ? 0 : 1;
  });
  // Permissions do not bind root, and in a user namespace of one user there is no other to become.
  if (code == skip_code) GTEST_SKIP() << "root here cannot become another user";
  EXPECT_EQ(code, 0);
  EXPECT_TRUE(fs::is_empty(folder / "locked"));
}

TEST(OutputFile, KeepsAReadOnlyFile) {
  const TemporaryFolder folder;
  ASSERT_TRUE(io::write_file(folder / "a.txt", "earlier"));
  fs::permissions(folder / "a.txt", fs::perms(0444));
  fs::permissions(folder.path(), fs::perms(0777));
  const int code = run_in_child([&] {
    if (::geteuid() == 0 && ::setuid(nobody) != 0) return skip_code;
    return fails_with(io::write_file(folder / "a.txt", "text"), "Permission denied") ? 0 : 1;
  });
  // Permissions do not bind root, and in a user namespace of one user there is no other to become.
  if (code == skip_code) GTEST_SKIP() << "root here cannot become another user";
  EXPECT_EQ(code, 0);
  EXPECT_EQ(read_text(folder / "a.txt"), "earlier");
  EXPECT_EQ(folder.names(), Names{"a.txt"});
}

TEST(OutputFile, ReportsAFullFileSystem) {
  const TemporaryFolder folder;
  const int code = run_in_child([&] {
    const bool own_mounts = ::unshare(CLONE_NEWNS) == 0 || ::unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0;
    if (!own_mounts || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=64k") != 0) {
      return skip_code;
    }
    if (!io::write_file(folder / "a.txt", "earlier")) return 2;
    if (!fails_with(io::write_file(folder / "a.txt", std::string(1 << 20, 'x')), "No space left on device"))
      return 3;
    if (read_text(folder / "a.txt") != "earlier") return 4;
    return folder.names() == Names{"a.txt"} ? 0 : 5;
  });
  // A disk can only be filled that is small: one is mounted, which needs root and a container that allows it.
  if (code == skip_code) GTEST_SKIP() << "mounting a file system is not allowed here";
  EXPECT_EQ(code, 0);
}

TEST(OutputFile, KeepsTheEarlierFileWhenAnyWriteFails) {
  constexpr int pieces = 20;
  constexpr rlim_t piece_bytes = 100;
  const TemporaryFolder folder;
  const fs::path path = folder / "a.txt";
  for (rlim_t limit = 0; limit <= pieces * piece_bytes; limit += piece_bytes / 2) {
    testing::write_text(path, "earlier");
    const bool fits = limit == pieces * piece_bytes;
    const int code = run_in_child([&] {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit bound{limit, limit};
      if (::setrlimit(RLIMIT_FSIZE, &bound) != 0) return skip_code;
      auto file = io::OutputFile::create(path);
      if (!file) return 2;
      for (int i = 0; i < pieces; ++i) {
        const auto written = file->write(std::string(piece_bytes, 'x'));
        if (!written)
          return fails_with(written, "File too large") && fails_with(written, path.string()) ? 0 : 3;
      }
      return file->commit() && fits ? 0 : 4;
    });
    ASSERT_EQ(code, 0) << limit;
    ASSERT_EQ(read_text(path), fits ? std::string(pieces * piece_bytes, 'x') : "earlier") << limit;
    ASSERT_EQ(folder.names(), Names{"a.txt"}) << limit;
  }
}

TEST(OutputFile, ReportsAFailedRename) {
  const TemporaryFolder folder;
  {
    auto file = io::OutputFile::create(folder / "a.txt");
    ASSERT_TRUE(file && file->write("text"));
    fs::create_directory(folder / "a.txt");  // in the meantime
    expect_failure(file->commit(), folder / "a.txt", "Is a directory");
  }
  EXPECT_EQ(folder.names(), Names{"a.txt"});
}

TEST(OutputFile, ReportsWhatOnlyFlushOrCloseFindsOut) {
  const TemporaryFolder folder;
  for (const fs::path& path : {folder / "a.txt", fs::path("/dev/null")}) {
    const int next = ::dup(STDIN_FILENO);  // the descriptor that the file will get
    ASSERT_GE(next, 0);
    ::close(next);
    auto file = io::OutputFile::create(path);
    ASSERT_TRUE(file && file->write("text"));
    ASSERT_EQ(::close(next), 0);
    expect_failure(file->commit(), path, "Bad file descriptor");
  }
  EXPECT_EQ(folder.names(), Names{});
}

TEST(OutputFile, FollowsLinksAndKeepsTheMode) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "deep");
  ASSERT_TRUE(io::write_file(folder / "deep/real", "earlier"));
  fs::permissions(folder / "deep/real", fs::perms(0640));
  fs::create_symlink("deep/real", folder / "link");
  ASSERT_TRUE(io::write_file(folder / "link", "text"));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_text(folder / "deep/real"), "text");
  EXPECT_EQ(fs::status(folder / "deep/real").permissions(), fs::perms(0640));
}

// To open a pipe for writing waits until somebody reads it: a render into one would hang.
TEST(OutputFile, RefusesPipesAndSocketsAndWaitsForNothing) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  expect_failure(io::write_file(folder / "pipe", "text"), folder / "pipe", "a named pipe");
  fs::create_symlink("pipe", folder / "link");
  expect_failure(io::write_file(folder / "link", "text"), folder / "link", "a named pipe");
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
}

TEST(OutputFile, WritesToStandardOutputWhateverThatIs) {
  const TemporaryFolder folder;
  const auto written_to = [&](int descriptor) {
    return run_in_child([&] {
      if (::dup2(descriptor, STDOUT_FILENO) < 0) return 2;
      return io::write_file("/dev/stdout", "text") ? 0 : 1;
    });
  };
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  EXPECT_EQ(written_to(ends[1]), 0);
  std::string text(4, ' ');
  EXPECT_EQ(::read(ends[0], text.data(), text.size()), 4);
  EXPECT_EQ(text, "text");
  const int file = ::open((folder / "a.txt").c_str(), O_WRONLY | O_CREAT, 0600);
  ASSERT_EQ(::write(file, "earlier ", 8), 8);
  EXPECT_EQ(written_to(file), 0);
  EXPECT_EQ(read_text(folder / "a.txt"), "earlier text");
  for (const int open : {ends[0], ends[1], file}) ::close(open);
  EXPECT_TRUE(io::write_file("/dev/null", "text"));
}

TEST(OutputFile, ALinkThatLeadsNowhereStaysALink) {
  const TemporaryFolder folder;
  fs::create_symlink("there", folder / "link");
  fs::create_symlink(folder / "link", folder / "other");
  EXPECT_TRUE(io::write_file(folder / "other", "text"));
  EXPECT_TRUE(fs::is_symlink(folder / "other") && fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_text(folder / "there"), "text");

  // As /dev/stdout where standard output is closed.
  fs::create_symlink("/proc/self/fd/987", folder / "closed");
  EXPECT_FALSE(io::write_file(folder / "closed", "text"));
  EXPECT_TRUE(fs::is_symlink(folder / "closed"));
  fs::create_symlink("round", folder / "round");
  EXPECT_FALSE(io::write_file(folder / "round", "text"));
}

/// Writes whole files of one letter again and again.
[[noreturn]] void write_for_ever(const fs::path& path, char letter, std::size_t size) {
  for (;;) {
    if (!io::write_file(path, std::string(size, letter))) ::_exit(1);
  }
}

bool is_whole(const std::string& text, std::size_t size) {
  return text.size() == size && text.find_first_not_of(text.front()) == std::string::npos;
}

TEST(OutputFile, OneOfManyWritersWinsWhole) {
  constexpr std::size_t size = 100'000;
  constexpr int rounds = 100;
  const TemporaryFolder folder;
  const fs::path path = folder / "a.txt";
  ASSERT_TRUE(io::write_file(path, std::string(size, '0')));
  std::vector<pid_t> writers;
  for (const char letter : {'a', 'b', 'c', 'd'}) {
    writers.push_back(::fork());
    if (writers.back() != 0) continue;
    for (int i = 0; i < rounds; ++i) {
      if (!io::write_file(path, std::string(size, letter))) ::_exit(1);
    }
    ::_exit(0);
  }
  int reads = 0;
  for (const pid_t writer : writers) {
    int status = 0;
    while (::waitpid(writer, &status, WNOHANG) == 0) {
      ASSERT_TRUE(is_whole(read_text(path), size)) << "after " << reads << " reads";
      ++reads;
    }
    EXPECT_EQ(status, 0);
  }
  EXPECT_TRUE(is_whole(read_text(path), size));
  EXPECT_EQ(folder.names(), Names{"a.txt"});
}

TEST(OutputFile, StaysWholeWhenKilledAtRandomTimes) {
  constexpr std::size_t size = 1 << 20;
  constexpr int kills = 100;
  const TemporaryFolder folder;
  const fs::path path = folder / "a.txt";
  ASSERT_TRUE(io::write_file(path, std::string(size, '0')));
  std::mt19937 random(1);  // the delays, not the moments within a write, are reproducible
  for (int i = 0; i < kills; ++i) {
    const pid_t writer = ::fork();
    if (writer == 0) write_for_ever(path, static_cast<char>('a' + i % 26), size);
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 8000));
    ::kill(writer, SIGKILL);
    int status = 0;
    ::waitpid(writer, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the writer failed by itself";
    ASSERT_TRUE(is_whole(read_text(path), size)) << "kill " << i;
  }
}

}  // namespace
}  // namespace tenebra
