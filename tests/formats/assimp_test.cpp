// Formats that are converted: every way in which the converter can fail, and what the real one gives.
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <iterator>

#include <tenebra/frame_geometry.h>
#include "formats/converted.h"
#include "formats/format_list.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

namespace fs = std::filesystem;
using formats::Converter;
using testing::write_text;

constexpr const char* off_triangle = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n";

class Converted : public ::testing::Test {
protected:
  Converted() { write_text(folder_ / "a.fbx", "; FBX"); }

  /// A converter that is a script of the shell.
  Converter script(const std::string& text) const {
    write_text(folder_ / "fake", "#!/bin/sh\n" + text + "\n");
    fs::permissions(folder_ / "fake", fs::perms::owner_all);
    return {folder_ / "fake"};
  }
  std::string fault(const Converter& converter) const {
    const auto scene = formats::import_converted(folder_ / "a.fbx", {}, converter);
    return scene ? "none" : scene.error().message;
  }
  /// One sentence with the file, `part` and the next step.
  void refuses(const Converter& converter, const std::string& part) const {
    const std::string message = fault(converter);
    EXPECT_TRUE(message.starts_with((folder_ / "a.fbx").string() + ": ")) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_TRUE(message.ends_with("File > Export > glTF 2.0).")) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Converted, WithoutAConverterTheSentenceNamesThePackage) {
  refuses({}, "install libassimp-dev");
}

TEST_F(Converted, AProgramThatCannotStart) {
  const std::string message = fault({folder_ / "nowhere"});
  EXPECT_NE(message.find("cannot start"), std::string::npos) << message;
}

TEST_F(Converted, Crash) {
  refuses(script("kill -SEGV $$"), "crashed (signal 11)");
}

TEST_F(Converted, Limits) {
  refuses(script("kill -KILL $$"), "stopped for its time or memory");
  refuses(script("exit 2"), "ran out of the memory");
  Converter much = script("exec yes");
  much.least_output = 100'000;
  refuses(much, "wrote more than");
}

TEST_F(Converted, Time) {
  for (const char* const text : {"exec sleep 60", "exec sleep 60 >&- 2>&-"}) {  // with open pipes and without
    Converter slow = script(text);
    slow.least_time = std::chrono::milliseconds(200);
    const auto start = std::chrono::steady_clock::now();
    refuses(slow, "took more than");
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  }
}

TEST_F(Converted, Nonsense) {
  refuses(script("echo hello"), "something else than glTF");
  refuses(script("exit 0"), "something else than glTF");
  refuses(script("printf 'glTF\\002\\000\\000\\000'"), "GLB header: found 8 bytes");
}

TEST_F(Converted, ItsSentenceIsQuotedOnOneLine) {
  refuses(script("printf 'odd\\ttoken.\\nmore' >&2; exit 1"), "Assimp found a fault (odd token)");
  refuses(script("yes | head -c 200000 >&2; exit 1"), "Assimp found a fault (y)");  // more than is kept
}

TEST_F(Converted, ANoteThatIsCutOffIsPassedOver) {
  std::vector<fs::path> files;
  formats::ImportOptions options;
  options.files_read = &files;
  const Converter converter = script(
      R"(printf 'glTF\002\000\000\000\060\000\000\000\034\000\000\000JSON{"asset":{"version":"2.0"}} ')"
      "\nprintf 'Odd.\\nreads /cut' >&2");
  const auto scene = formats::import_converted(folder_ / "a.fbx", options, converter);
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_FALSE(scene->warnings.empty());
  EXPECT_EQ(scene->warnings.back(), "Odd.");
  EXPECT_EQ(files, std::vector<fs::path>{folder_ / "a.fbx"});
}

TEST_F(Converted, NoDescriptorAndNoProcessIsLeft) {
  const auto descriptors = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  const auto before = descriptors();
  refuses(script("exit 1"), "Assimp found a fault");
  Converter slow = script("exec sleep 60");
  slow.least_time = std::chrono::milliseconds(50);
  refuses(slow, "took more than");
  fault({folder_ / "nowhere"});
  EXPECT_EQ(descriptors(), before);
  const pid_t left = waitpid(-1, nullptr, WNOHANG);
  const int why = errno;
  EXPECT_EQ(left, -1);
  EXPECT_EQ(why, ECHILD);
}

TEST_F(Converted, MissingFile) {
  const auto scene = formats::import_converted(folder_ / "none.fbx", {}, script("exit 0"));
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message.find("no such file"), std::string::npos) << scene.error().message;
}

/// The real converter; skipped where Assimp is not installed.
class ByAssimp : public Converted {
protected:
  void SetUp() override {
    if (formats::find_converter().program.empty())
      GTEST_SKIP() << "built without Assimp (package libassimp-dev)";
  }
  Scene read(const std::string& name, const std::string& text,
             const formats::ImportOptions& options = {}) const {
    write_text(folder_ / name, text);
    auto scene = formats::import_scene(folder_ / name, options);
    EXPECT_TRUE(scene.has_value()) << scene.error().message;
    return scene ? std::move(*scene) : Scene{};
  }
  static std::size_t triangles(const Scene& scene) {
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) count += mesh.triangles.size();
    return count;
  }
  /// High minus low corner of the placed vertices, in metres.
  static glm::vec3 extent(const Scene& scene) {
    FrameGeometry frame;
    evaluate_frame(scene, -1, 0, frame);
    glm::vec3 low(1e9f), high(-1e9f);
    for (const glm::vec3& position : frame.positions) {
      low = glm::min(low, position);
      high = glm::max(high, position);
    }
    return high - low;
  }
};

TEST_F(ByAssimp, ReadsTrianglesAndNamesItsFiles) {
  std::vector<fs::path> files;
  formats::ImportOptions options;
  options.files_read = &files;
  const Scene scene = read("a.off", off_triangle, options);
  ASSERT_EQ(triangles(scene), 1u);
  EXPECT_EQ(extent(scene), glm::vec3(1, 2, 0));
  EXPECT_EQ(files, std::vector<fs::path>{folder_ / "a.off"});
}

TEST_F(ByAssimp, ColladaInCentimetresWithZUp) {
  const Scene scene = read("a.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="cm" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 100 0 0 0 0 300</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y"
type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
  EXPECT_EQ(extent(scene), glm::vec3(1, 3, 0));
}

TEST_F(ByAssimp, FbxFollowsItsAxesAndUnit) {
  const auto fbx = [&](int up, int front, int front_sign, double centimetres) {
    std::string text =
        "; FBX 7.3.0 project file\nFBXHeaderExtension: {\n FBXVersion: 7300\n}\nGlobalSettings: {\n"
        " Version: 1000\n Properties70: {\n";
    for (const auto& [name, value] : {std::pair{"UpAxis", up},
                                      {"UpAxisSign", 1},
                                      {"FrontAxis", front},
                                      {"FrontAxisSign", front_sign},
                                      {"CoordAxis", 0},
                                      {"CoordAxisSign", 1}})
      text += fmt::format("  P: \"{}\", \"int\", \"Integer\", \"\",{}\n", name, value);
    text += fmt::format("  P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",{}\n }}\n}}\n", centimetres);
    return extent(read("b.fbx", text + R"(Objects: {
 Geometry: 1, "Geometry::g", "Mesh" {
  Vertices: *9 {
   a: 0,0,0,1,0,0,0,0,3
  }
  PolygonVertexIndex: *3 {
   a: 0,1,-3
  }
  GeometryVersion: 124
 }
 Model: 2, "Model::m", "Mesh" {
  Version: 232
 }
}
Connections: {
 C: "OO",2,0
 C: "OO",1,2
}
)"));
  };
  EXPECT_EQ(fbx(1, 2, 1, 100), glm::vec3(1, 0, 3));   // Y up, metres
  EXPECT_EQ(fbx(2, 1, -1, 100), glm::vec3(1, 3, 0));  // Z up
  const glm::vec3 inches = fbx(2, 1, -1, 2.54);
  EXPECT_NEAR(inches.y, 0.0762, 1e-7);
}

TEST_F(ByAssimp, BrokenFilesAreRefused) {
  for (const char* const name :
       {"a.fbx", "a.dae", "a.3ds", "a.lwo", "a.x", "a.dxf", "a.ac", "a.md3", "a.3mf"}) {
    write_text(folder_ / name, "; nothing of the kind");
    const auto scene = formats::import_scene(folder_ / name);
    ASSERT_FALSE(scene) << name;
    EXPECT_TRUE(scene.error().message.ends_with("File > Export > glTF 2.0).")) << scene.error().message;
  }
}

TEST_F(ByAssimp, FilesOutsideTheFolderAreNotRead) {
  fs::create_directories(folder_ / "in");
  write_text(folder_ / "out.off", off_triangle);
  write_text(folder_ / "in/in.off", off_triangle);
  fs::create_symlink(folder_ / "out.off", folder_ / "in/link.off");
  const auto naming = [](const std::string& name) { return "LWSC\n3\n\nLoadObjectLayer 1 " + name + "\n"; };
  EXPECT_EQ(triangles(read("in/a.lws", naming("in.off"))), 1u);
  for (const std::string& name :
       {std::string("../out.off"), (folder_ / "out.off").string(), std::string("link.off")})
    EXPECT_EQ(triangles(read("in/a.lws", naming(name))), 0u) << name;
  formats::ImportOptions options;
  options.root = folder_.path();
  EXPECT_EQ(triangles(read("in/a.lws", naming("../out.off"), options)), 1u);
}

TEST_F(ByAssimp, TheSceneItselfMayBeALink) {
  fs::create_directories(folder_ / "in");
  write_text(folder_ / "stored", "LWSC\n3\n\nLoadObjectLayer 1 in.off\n");
  write_text(folder_ / "in/in.off", off_triangle);
  fs::create_symlink(folder_ / "stored", folder_ / "in/a.lws");
  std::vector<fs::path> files;
  formats::ImportOptions options;
  options.files_read = &files;
  const auto scene = formats::import_scene(folder_ / "in/a.lws", options);
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(triangles(*scene), 1u);
  EXPECT_EQ(files, (std::vector<fs::path>{folder_ / "in/a.lws", folder_ / "in/in.off"}));
}

TEST(FormatList, EveryExtensionIsListedOnceInLowerCase) {
  std::string seen = " ";
  for (const formats::FileFormat& format : formats::file_formats()) {
    EXPECT_TRUE(format.reader == "own" || format.reader == "Assimp") << format.reader;
    std::string_view rest = format.extensions;
    while (!rest.empty()) {
      const std::string one(rest.substr(0, rest.find(' ')));
      rest.remove_prefix(std::min(rest.size(), one.size() + 1));
      EXPECT_TRUE(one.starts_with('.'));
      EXPECT_EQ(seen.find(" " + one + " "), std::string::npos) << one;
      EXPECT_EQ(formats::format_of("a" + one), &format) << one;
      seen += one + " ";
    }
  }
}

TEST(FormatList, ACompressedBlendFileIsNoArchive) {
  const testing::TemporaryFolder folder;
  write_text(folder / "a.BLEND", "\x1F\x8B");
  const auto scene = formats::import_scene(folder / "a.BLEND");
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message.find("open it in Blender"), std::string::npos) << scene.error().message;
}

TEST(FormatList, OtherProgramsFilesHaveAWay) {
  for (const auto& [file, way] : {std::pair{"a.blend", "Blender"},
                                  {"a.STEP", "FreeCAD"},
                                  {"a.iges", "FreeCAD"},
                                  {"a.ifc", "Bonsai"},
                                  {"a.skp", "SketchUp"},
                                  {"a.dwg", "FBX"},
                                  {"a.zzz", "glTF"}})
    EXPECT_NE(formats::way_to_gltf(file).find(way), std::string_view::npos) << file;
}

}  // namespace
}  // namespace tenebra
