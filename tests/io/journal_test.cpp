// A journal holds whole lines, whatever ends its writer.
#include "io/journal.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <random>

#include "support/child_process.h"
#include "support/killed_writer.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

using io::Journal;
using testing::kill_while_it_writes;
using testing::read_text;
using testing::run_in_child;
using testing::TemporaryFolder;

TEST(Journal, StandsUnderItsNameFromTheFirstLineOn) {
  const TemporaryFolder folder;
  testing::write_text(folder / "a.csv", "an earlier run's\n");
  auto journal = Journal::open(folder / "a.csv");
  ASSERT_TRUE(journal && journal->begin("head\n"));
  EXPECT_EQ(read_text(folder / "a.csv"), "head\n");
  ASSERT_TRUE(journal->append("row\n"));
  EXPECT_EQ(read_text(folder / "a.csv"), "head\nrow\n");
  ASSERT_TRUE(journal->finish());
}

TEST(Journal, IsGoneOnWithWhereItsLastWholeLineEnds) {
  const TemporaryFolder folder;
  testing::write_text(folder / "a.csv", "head\nrow\nto");
  auto journal = Journal::open(folder / "a.csv");
  ASSERT_TRUE(journal);
  EXPECT_EQ(journal->read().value(), "head\nrow\nto");
  ASSERT_TRUE(journal->keep(9) && journal->append("next\n") && journal->finish());
  EXPECT_EQ(read_text(folder / "a.csv"), "head\nrow\nnext\n");
}

TEST(Journal, HasOneWriter) {
  const TemporaryFolder folder;
  const auto second = [&] {
    return run_in_child([&] {
      const auto other = Journal::open(folder / "a.csv");
      if (other) return 0;
      return other.error().message.find("another process") != std::string::npos ? 1 : 2;
    });
  };
  {
    auto journal = Journal::open(folder / "a.csv");
    ASSERT_TRUE(journal && journal->begin("head\n"));
    EXPECT_EQ(second(), 1);
  }
  EXPECT_EQ(second(), 0) << "nobody writes it any more";
  EXPECT_EQ(read_text(folder / "a.csv"), "head\n");
}

TEST(Journal, KeepsWhatIsThereOnAFullDisk) {
  const TemporaryFolder folder;
  const int code = run_in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit bound{100, 100};
    ::setrlimit(RLIMIT_FSIZE, &bound);
    auto journal = Journal::open(folder / "a.csv");
    if (!journal || !journal->begin("head\n")) return 1;
    const std::string row(39, 'r');
    if (!journal->append(row + "\n") || !journal->append(row + "\n")) return 2;
    const auto third = journal->append(row + "\n");
    if (third || third.error().message.find("a.csv: File too large") == std::string::npos) return 3;
    const auto made = Journal::open(folder / "none.csv")->begin(std::string(200, 'h'));
    return made ? 4 : 0;
  });
  EXPECT_EQ(code, 0);
  const std::string row = std::string(39, 'r') + "\n";
  EXPECT_EQ(read_text(folder / "a.csv"), "head\n" + row + row) << "whole rows";
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.csv"});
}

TEST(Journal, RefusesWhatItWouldWaitForAndWritesStreams) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const std::filesystem::path& path : {folder / "pipe", folder.path(), folder / "no/a.csv"}) {
    const auto refused = Journal::open(path);
    ASSERT_FALSE(refused) << path;
    EXPECT_NE(refused.error().message.find(path.string()), std::string::npos) << refused.error().message;
  }
  auto device = Journal::open("/dev/null");
  ASSERT_TRUE(device);
  EXPECT_FALSE(device->is_file());
  EXPECT_EQ(device->read().value(), "");
  EXPECT_TRUE(device->begin("head\n") && device->append("row\n") && device->finish());
  // Linux has this device, which is always full; other systems, and some containers, do not.
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  EXPECT_FALSE(Journal::open("/dev/full")->begin("head\n"));
}

TEST(Journal, IsCutInItsLastLineAloneWhenKilledAtRandomTimes) {
  constexpr int kills = 50;
  const TemporaryFolder folder;
  const std::string row = std::string(700, 'r') + "\n";
  std::mt19937 random(2);
  const auto write = [&] {
    auto journal = Journal::open(folder / "a.csv");
    if (!journal || !journal->begin(row)) return;
    while (journal->append(row)) {
    }
  };
  for (int i = 0; i < kills; ++i) {
    ASSERT_TRUE(kill_while_it_writes(random, write)) << "the writer failed by itself";
    if (std::filesystem::exists(folder / "a.csv")) {
      const std::string text = read_text(folder / "a.csv");
      for (std::size_t at = 0; at < text.size(); at += row.size())
        ASSERT_TRUE(row.starts_with(text.substr(at, row.size()))) << "at kill " << i;
    }
  }
}

}  // namespace
}  // namespace tenebra
