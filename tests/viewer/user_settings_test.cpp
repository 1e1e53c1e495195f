// The settings that the window keeps from run to run, and the list of its open dialog.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "support/temporary_folder.h"
#include "window/files/folder_list.h"
#include "window/files/user_settings.h"

namespace tenebra::viewer {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;
using testing::write_text;

TEST(UserSettings, AreReadAsTheyWereWritten) {
  const TemporaryFolder folder;
  const fs::path file = folder / "made/on/demand/viewer.json";
  UserSettings settings{.window = {900, 700}, .panel = false, .research = true};
  settings.remember("/a/b \"c\"\n.glb");
  settings.remember("/a/d.gltf");
  ASSERT_TRUE(write_settings(file, settings));
  const auto read = read_settings(file);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->window.width, 900);
  EXPECT_EQ(read->window.height, 700);
  EXPECT_FALSE(read->panel);
  EXPECT_TRUE(read->research);
  EXPECT_EQ(read->recent, settings.recent);
  EXPECT_EQ(read->folder, "/a");
  EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), fs::directory_iterator()), 1)
      << "no scratch";
}

TEST(UserSettings, RememberEachSceneOnceAndNotTooMany) {
  UserSettings settings;
  for (int i = 0; i < 40; ++i) settings.remember("/scenes/" + std::to_string(i % 20) + ".glb");
  EXPECT_EQ(settings.recent.size(), UserSettings::most_recent);
  EXPECT_EQ(settings.recent.front(), "/scenes/19.glb");
  settings.remember("/scenes/../scenes/15.glb");
  EXPECT_EQ(settings.recent.front(), "/scenes/15.glb");
  EXPECT_EQ(std::count(settings.recent.begin(), settings.recent.end(), "/scenes/15.glb"), 1);
}

TEST(UserSettings, OfABrokenFileAreTheDefaultsAndASentence) {
  const TemporaryFolder folder;
  EXPECT_TRUE(read_settings(folder / "absent.json"));
  for (const char* text :
       {"", "{", "[]", "7", R"({"window": 3})", R"({"window": [1, 2]})", R"({"window": [900]})",
        R"({"window": [900, 1e9]})", R"({"panel": "yes"})", R"({"recent": [1]})", "\xff\xfe"}) {
    write_text(folder / "viewer.json", text);
    const auto read = read_settings(folder / "viewer.json");
    ASSERT_FALSE(read) << text;
    EXPECT_TRUE(read.error().message.starts_with("settings " + (folder / "viewer.json").string() + ": found"))
        << read.error().message;
    const SettingsKeeper kept((folder / "viewer.json").string());
    EXPECT_EQ(kept.settings().window.width, UserSettings{}.window.width);
    EXPECT_EQ(kept.problem(), read.error().message);
  }
  EXPECT_FALSE(read_settings(folder.path())) << "a folder";
  ASSERT_EQ(::mkfifo((folder / "fifo").c_str(), 0600), 0);
  EXPECT_FALSE(read_settings(folder / "fifo")) << "and does not wait";
}

TEST(UserSettings, StandWhereXdgHasThem) {
  ::setenv("XDG_CONFIG_HOME", "/somewhere", 1);
  EXPECT_EQ(default_settings_file(), "/somewhere/tenebra/viewer.json");
  ::setenv("XDG_CONFIG_HOME", "relative", 1);
  ::setenv("HOME", "/home/someone", 1);
  EXPECT_EQ(default_settings_file(), "/home/someone/.config/tenebra/viewer.json");
}

TEST(FolderList, HasFoldersFirstAndScenesOnly) {
  const TemporaryFolder folder;
  for (const char* name : {"b.glb", "A.GLTF", "notes.txt", ".hidden.glb", "c.obj", "d.aff", "e.nff"})
    write_text(folder / name, "");
  for (const char* name : {"zoo", "Bar", ".git"}) fs::create_directory(folder / name);
  fs::create_directory(folder / "folder.glb");
  const auto list = list_folder(folder.path() / "zoo/..");
  ASSERT_TRUE(list);
  std::vector<std::string> names;
  for (const FolderEntry& entry : list->entries) names.push_back(entry.name + (entry.folder ? "/" : ""));
  EXPECT_EQ(names, (std::vector<std::string>{"Bar/", "folder.glb/", "zoo/", "A.GLTF", "b.glb", "c.obj",
                                             "d.aff", "e.nff"}));
  EXPECT_EQ(list->folder, folder.path());
  const auto missing = list_folder(folder / "missing");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("missing"), std::string::npos);
  EXPECT_FALSE(list_folder(folder / "b.glb"));
}

TEST(FolderList, FindsWhatIsTyped) {
  ::setenv("HOME", "/home/someone", 1);
  EXPECT_EQ(typed_path("~/x.glb", "/a"), "/home/someone/x.glb");
  EXPECT_EQ(typed_path("/b/x.glb", "/a"), "/b/x.glb");
  EXPECT_EQ(typed_path("../x.glb", "/a/b"), "/a/x.glb");
  EXPECT_TRUE(matches("City.GLB", "ty.g"));
  EXPECT_FALSE(matches("City.GLB", "town"));
  EXPECT_TRUE(matches("anything", ""));
}

}  // namespace
}  // namespace tenebra::viewer
