// The viewer without a display: drawn on an EGL surface, Dear ImGui's io driven by hand.
#include <backends/imgui_impl_opengl3.h>
#include <fmt/core.h>
#include <glad/gl.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <set>
#include <thread>

#include "support/patience.h"
#include "support/seeded_random.h"
#include "viewer_test_scene.h"
#include "window/viewer.h"

namespace tenebra::viewer {
namespace {

using testing::TemporaryFolder;

SceneOptions scene_in(const std::filesystem::path& file) {
  SceneOptions scene;
  scene.file = file.string();
  return scene;
}

/// A picture to draw on and a viewer that draws. Keys are GLFW's codes; a letter's is its capital.
class HeadlessViewer {
public:
  HeadlessViewer(const std::filesystem::path& scene, Size window, float scale = 1,
                 double preview_ms = default_preview_ms)
      : HeadlessViewer(scene_in(scene), window, scale, preview_ms) {}
  HeadlessViewer(const SceneOptions& scene, Size window, float scale = 1,
                 double preview_ms = default_preview_ms)
      : window_(window),
        scale_(scale),
        context_(gl::Context::create(gl::ContextKind::egl, {.debug = true}).value()) {
    make_framebuffer();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    ImGui_ImplOpenGL3_Init("#version 330 core");
    apply_style(scale);
    gl_.emplace(std::move(*WindowGl::load(context_.function_loader(), true)));
    ViewOptions options;
    options.scene = scene;
    options.shots = OutputPattern::parse((folder_ / "shot_%d.png").string()).value();
    options.log = (folder_ / "frames.csv").string();
    options.report = (folder_ / "report.jsonl").string();
    options.gl_debug = true;
    options.preview_ms = preview_ms;
    AoConfig& ao = options.method.render.ao;
    ao.cache.clear();
    ao.positions = 64, ao.directions = 16, ao.rays = 4;  // the panel's time, not theirs
    viewer_.emplace(options, *gl_, std::move(*EventReport::create(options.report)), [] {});
    testing::write_text(folder_ / "viewer.json", R"({"research": true})");
    viewer_->use_settings(SettingsKeeper((folder_ / "viewer.json").string()));
  }
  ~HeadlessViewer() {
    viewer_.reset();
    gl_.reset();
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
  }
  HeadlessViewer(const HeadlessViewer&) = delete;
  HeadlessViewer& operator=(const HeadlessViewer&) = delete;

  Viewer& viewer() { return *viewer_; }
  std::string report() const { return testing::read_text(folder_ / "report.jsonl"); }
  const TemporaryFolder& folder() const { return folder_; }

  void turn() {
    viewer_->update();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(window_.width), static_cast<float>(window_.height)};
    io.DeltaTime = 1.0f / 60;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    viewer_->draw(scale_, 1);
    ImGui::Render();
    gl_->clear(window_.width, window_.height);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    viewer_->after_draw(window_.width, window_.height);
    viewer_->presented();
    gl_->read_window(1, 1);  // waits, as a swap would: frames that pile up would starve the worker's
  }
  template <class Condition>
  bool turn_until(Condition condition, double seconds = 60) {
    const auto end =
        std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds * testing::patience);
    while (!condition() && std::chrono::steady_clock::now() < end) {
      turn();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return condition();
  }
  bool wait_for_first_picture() {
    const auto is_whole = [&] { return viewer_->picture() && viewer_->picture()->preview.empty(); };
    return turn_until([&] { return is_whole() || viewer_->is_over(); }) && is_whole();
  }
  void move_to(ImVec2 at) { ImGui::GetIO().MousePos = at, turn(); }
  void click_at(ImVec2 at) {
    move_to(at);
    ImGui::GetIO().MouseDown[0] = true, turn();
    ImGui::GetIO().MouseDown[0] = false, turn();
  }
  bool click(const std::string& name) {
    const auto found = viewer_->marks().find(name);
    if (found == viewer_->marks().end()) return false;
    const ImVec4 at = found->second;
    click_at({(at.x + at.z) / 2, (at.y + at.w) / 2});
    return true;
  }
  void key(int code) {
    viewer_->press_key({.code = code});
    turn();
  }
  void type(char character) {
    ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(character));
    turn();
  }
  io::Image8 pixels() const { return gl_->read_window(window_.width, window_.height); }
  std::vector<std::string> gl_messages() { return gl_->take_messages(); }

private:
  void make_framebuffer() {
    unsigned texture = 0, framebuffer = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, GL_RGBA8, window_.width, window_.height);
    glCreateFramebuffers(1, &framebuffer);
    glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, texture, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  }

  TemporaryFolder folder_;
  Size window_;
  float scale_;
  gl::Context context_;
  std::optional<WindowGl> gl_;
  std::optional<Viewer> viewer_;
};

int pixels_unlike(const io::Image8& a, const io::Image8& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) count += a.pixels[i] != b.pixels[i] ? 1 : 0;
  return count;
}

TEST(ViewPanel, IsDrawnWithoutADisplay) {
  const TemporaryFolder folder;
  HeadlessViewer headless(testing::write_moving_scene(folder), {1280, 760});
  ASSERT_TRUE(headless.wait_for_first_picture());
  headless.turn();
  const io::Image8 before = headless.pixels();
  for (const char* name :
       {"play", "scrubber", "shadows.soft", "variant", "graph", "overlay.nodes", "section.Lights"}) {
    EXPECT_EQ(headless.viewer().marks().count(name), 1u) << name;
  }
  headless.click("shadows.none");
  EXPECT_EQ(headless.viewer().state().slots[0].render.shadows, render::ShadowMode::none);
  ASSERT_TRUE(headless.turn_until([&] { return headless.viewer().picture()->a.record.stats.rays == 0; }));
  headless.turn();
  EXPECT_GT(pixels_unlike(headless.pixels(), before), 1000) << "the picture lost its shadow, the panel a row";
  EXPECT_TRUE(headless.gl_messages().empty());
}

TEST(ViewPanel, BadFilesShowTheirMessageAndKeepTheScene) {
  const TemporaryFolder folder;
  HeadlessViewer headless(testing::write_moving_scene(folder), {1280, 720});
  ASSERT_TRUE(headless.wait_for_first_picture());
  const auto scene = headless.viewer().state().scene;
  testing::write_text(folder / "broken.glb", "no scene at all");
  for (const std::string& file : {(folder / "broken.glb").string(), (folder / "missing.gltf").string(),
                                  folder.path().string(), std::string("notes.txt")}) {
    const std::string before = headless.viewer().message();
    headless.viewer().drop({file});
    ASSERT_TRUE(headless.turn_until([&] { return headless.viewer().message() != before; })) << file;
    EXPECT_NE(headless.viewer().message().find(std::filesystem::path(file).filename().string()),
              std::string::npos)
        << headless.viewer().message();
    EXPECT_EQ(headless.viewer().state().scene, scene);
    EXPECT_FALSE(headless.viewer().is_over());
  }
  headless.viewer().drop({TENEBRA_SCENES_DIR "/court.glb"});
  ASSERT_TRUE(headless.turn_until([&] { return headless.viewer().state().scene != scene; }));
  const auto number = [&] { return headless.viewer().picture()->scene; };
  EXPECT_TRUE(headless.turn_until([&] { return number() == headless.viewer().state().scene; }))
      << "the good one shows";
}

TEST(ViewPanel, TurnsSunsInTheAxesOfTheFile) {
  const TemporaryFolder folder;
  SceneOptions scene = scene_in(testing::write_moving_scene(folder));
  scene.import.placement.up = UpAxis::z;
  scene.edits.added.push_back({.type = LightType::directional, .direction = glm::vec3(0.48f, 0.64f, -0.6f)});
  HeadlessViewer headless(scene, {1280, 1400});
  ASSERT_TRUE(headless.wait_for_first_picture());
  ASSERT_TRUE(headless.click("section.Lights"));
  headless.turn();
  ASSERT_TRUE(headless.click("light.1.height"));  // in its middle: on the horizon
  const auto direction = [&] {
    return stage::edit_of(headless.viewer().state().edits.lights, 1).direction.value_or(glm::vec3(0.0f));
  };
  EXPECT_LT(glm::distance(direction(), glm::vec3(0.6f, 0.8f, 0)), 0.03f) << "Z is up in the file";
  ASSERT_TRUE(headless.click("light.1.height"));  // now from the edit, and it is there
  EXPECT_LT(glm::distance(direction(), glm::vec3(0.6f, 0.8f, 0)), 0.03f);
}

TEST(ViewPanel, CancelsWhatTakesLong) {
  const TemporaryFolder folder;
  HeadlessViewer headless(TENEBRA_SCENES_DIR "/court.glb", {1280, 720}, 1, 0);  // no previews
  ASSERT_TRUE(headless.wait_for_first_picture());
  const Picture* last = headless.viewer().picture();
  headless.key('3');  // soft shadows of the whole court
  bool offered = headless.turn_until([&] { return headless.viewer().marks().count("cancel") == 1; }, 20);
  if (!offered)
    GTEST_SKIP() << "this machine draws the soft shadows of the court before anyone could cancel them";
  EXPECT_EQ(headless.viewer().picture(), last) << "the last picture stays while the next is computed";
  headless.key(key_code::escape);
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(headless.turn_until([&] { return headless.viewer().message().starts_with("Cancelled"); }));
  ASSERT_TRUE(headless.turn_until([&] { return headless.viewer().marks().count("cancel") == 0; }));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 5.0);
  EXPECT_EQ(headless.viewer().picture(), last);
  headless.key('2');
  EXPECT_TRUE(headless.turn_until([&] { return headless.viewer().picture() != last; })) << "and work goes on";
}

TEST(ViewPanel, CancelsRefining) {
  HeadlessViewer headless(TENEBRA_SCENES_DIR "/court.glb", {1280, 720});
  ASSERT_TRUE(headless.wait_for_first_picture());
  headless.key('3');  // soft shadows of the whole court
  const auto shows_preview = [&] { return !headless.viewer().picture()->preview.empty(); };
  ASSERT_TRUE(headless.turn_until(shows_preview));
  headless.turn();
  EXPECT_EQ(headless.viewer().marks().count("preview"), 1u) << "and says so";
  bool offered = headless.turn_until([&] { return headless.viewer().marks().count("cancel") == 1; }, 20);
  // Previews are offered for slow frames only: a fast enough machine has none to cancel.
  if (!offered) GTEST_SKIP() << "this machine refines the court before anyone could cancel it";
  headless.key(key_code::escape);
  ASSERT_TRUE(headless.turn_until([&] { return headless.viewer().message().starts_with("Cancelled"); }));
  ASSERT_TRUE(headless.turn_until([&] { return headless.viewer().marks().count("cancel") == 0; }));
  EXPECT_TRUE(shows_preview()) << "what is there stays";
  headless.key('2');
  EXPECT_TRUE(headless.wait_for_first_picture()) << "and work goes on";
  headless.turn();
  EXPECT_EQ(headless.viewer().marks().count("preview"), 0u) << "a whole picture has no mark";
}

TEST(ViewPanel, ExplainsThePixelUnderAClickOnAPreview) {
  // Small, as sanitizers draw the whole court, too; and so is the time that makes previews small.
  HeadlessViewer headless(TENEBRA_SCENES_DIR "/court.glb", {760, 420}, 1, 15);
  ASSERT_TRUE(headless.wait_for_first_picture());
  const auto is_small = [&] {
    const Picture& picture = *headless.viewer().picture();
    return picture.a.result.image.width < picture.whole.width;
  };
  headless.key('3');  // soft shadows of the whole court
  if (!headless.turn_until(is_small, 20)) GTEST_SKIP() << "this machine draws no small previews of the court";
  // Odd: of the pixels that a preview draws as one it is not the first.
  const glm::ivec2 clicked{201, 133};
  const ImVec4 place = headless.viewer().marks().at("picture");
  headless.click_at({place.x + static_cast<float>(clicked.x), place.y + static_cast<float>(clicked.y)});
  // Previews are drawn for slow frames only: a fast enough machine has none to click on.
  if (!is_small()) GTEST_SKIP() << "this machine draws the court before anyone could click";
  // Finer pictures come before the click is looked at.
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const auto is_of_the_whole = [&] {
    const PictureAnswer* answer = headless.viewer().answer();
    return answer != nullptr && answer->question.picture->preview.empty();
  };
  ASSERT_TRUE(headless.turn_until(is_of_the_whole, 120));
  EXPECT_EQ(headless.viewer().answer()->question.picture.get(), headless.viewer().picture());
  EXPECT_EQ(headless.viewer().answer()->question.pixel, clicked);
}

TEST(ViewPanel, TriesSettingsAndTakesTheOneThatIsClicked) {
  const TemporaryFolder folder;
  HeadlessViewer headless(testing::write_moving_scene(folder), {900, 700});
  ASSERT_TRUE(headless.wait_for_first_picture());
  Viewer& viewer = headless.viewer();
  ASSERT_TRUE(headless.click("trade.start"));
  ASSERT_TRUE(headless.turn_until([&] { return viewer.trade().found != nullptr; }, 180));
  headless.turn(), headless.turn();
  const TradeResult& result = viewer.trade().found->result;
  EXPECT_EQ(result.frames, std::vector<int>{0}) << "the frame that is shown";
  const auto antialias = [&] { return viewer.state().slots[0].render.antialias; };
  const auto setting = [&](std::size_t i) { return result.measured[i].point.setting; };
  const auto by_error = [](const TradedSetting& a, const TradedSetting& b) {
    return a.point.error < b.point.error;
  };
  const auto& all = result.measured;
  const auto [least, most] = std::minmax_element(all.begin(), all.end(), by_error);
  for (const auto& wanted : {most, least}) {  // the ends of the plot: nothing lies on them
    const auto i = static_cast<std::size_t>(wanted - all.begin());
    ASSERT_TRUE(headless.click(fmt::format("trade.point.{}", i)));
    EXPECT_EQ(antialias(), setting(i).antialias);
  }
  const ImVec4 label = headless.viewer().marks().at("trade.label");
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ImVec4 point = headless.viewer().marks().at(fmt::format("trade.point.{}", i));
    EXPECT_GT(point.y - 9, label.w) << "the circle around a point that is lit stays below the label";
  }
  ASSERT_TRUE(headless.click("trade.row.0"));
  EXPECT_EQ(antialias(), setting(0).antialias);
  EXPECT_TRUE(headless.turn_until([&] {
    return viewer.picture()->preview.empty() && viewer.picture()->evidence.settings.antialias == antialias();
  })) << "drawn with it";
}

TEST(ViewPanel, StopsTryingSettings) {
  HeadlessViewer headless(TENEBRA_SCENES_DIR "/court.glb", {1280, 720});
  ASSERT_TRUE(headless.wait_for_first_picture());
  headless.key('3');
  headless.key('Y');
  const auto running = [&] { return headless.viewer().trade().running; };
  ASSERT_TRUE(headless.turn_until(running));
  headless.key('Y');
  ASSERT_TRUE(headless.turn_until([&] { return !running(); }));
  EXPECT_EQ(headless.viewer().trade().found, nullptr) << "stopped before the end";
  headless.key('Y');
  EXPECT_TRUE(headless.turn_until(running)) << "and it ends with the window";
}

TEST(ViewPanel, SurvivesAnyHand) {
  const TemporaryFolder folder;
  HeadlessViewer headless(testing::write_moving_scene(folder, 2), {900, 960});
  ASSERT_TRUE(headless.wait_for_first_picture());
  testing::Random random(11);
  std::set<std::string> used;
  constexpr char keys[] = " 1234VXBNMCLPRWASDQEFIG[]";
  const auto occlusion = {"ao.field", "ao.rays", "ao rays", "ao positions", "bits.8", "ao distance"};
  const auto all_used = [&] {
    return std::all_of(occlusion.begin(), occlusion.end(),
                       [&](const char* name) { return used.contains(name); });
  };
  // What is there to be used depends on how fast pictures come: on until all was, in ten times as many steps.
  for (int i = 0; (i < 400 || (i < 4000 && !all_used())) && !headless.viewer().is_over(); ++i) {
    const auto& marks = headless.viewer().marks();
    auto mark = marks.begin();
    std::advance(mark, random.index(static_cast<std::uint32_t>(marks.size())));
    if (i % 4 == 3) {  // now and then it goes for what it has not used, and for what leads there
      for (const char* way : {"section.Research", "section.Picture", "ao.field"}) {
        const bool leads = marks.contains(way) && !marks.contains("ao positions");
        if (leads && random.chance(0.4)) mark = marks.find(way);
      }
      for (const char* name : occlusion)
        if (!used.contains(name) && marks.contains(name)) mark = marks.find(name);
    }
    const ImVec4 at = mark->second;
    const ImVec2 point{static_cast<float>(random.in(at.x, at.z)), static_cast<float>(random.in(at.y, at.w))};
    const std::uint32_t what = random.index(6);
    // Files where the test runs, and scenes from there.
    if (mark->first == "log" || mark->first == "record" || mark->first == "trade.start" ||
        mark->first.starts_with("open.row"))
      continue;
    used.insert(mark->first);
    if (what == 0) headless.key(keys[random.index(sizeof(keys) - 1)]);
    if (what == 1) headless.key(random.chance(0.5) ? key_code::tab : key_code::right);
    if (what == 2) ImGui::GetIO().MouseWheel = static_cast<float>(random.in(-2, 2)), headless.move_to(point);
    if (what == 3) {
      ImGui::GetIO().MouseDown[0] = true, headless.move_to(point);
      headless.move_to({static_cast<float>(random.in(0, 900)), static_cast<float>(random.in(0, 960))});
      ImGui::GetIO().MouseDown[0] = false, headless.turn();
    }
    if (what > 3) headless.click_at(point);
  }
  headless.key(key_code::escape);
  headless.turn_until([] { return false; }, 0.5);
  EXPECT_FALSE(headless.viewer().is_over());
  for (const char* name : occlusion) EXPECT_TRUE(used.contains(name)) << name << " was never under the hand";
  EXPECT_EQ(headless.report().find("\"gl\""), std::string::npos) << "no OpenGL error on either context";
  EXPECT_TRUE(headless.gl_messages().empty());
}

TEST(ViewPanel, StaysUsableInSmallWindowsAndOnDenseDisplays) {
  const TemporaryFolder folder;
  const auto scene = testing::write_moving_scene(folder);
  {
    HeadlessViewer small(scene, {300, 200});
    ASSERT_TRUE(small.wait_for_first_picture());
    EXPECT_EQ(small.viewer().marks().count("shadows.hard"), 0u) << "no room for the panel";
    EXPECT_EQ(small.viewer().marks().count("play"), 1u);
    small.click("play");
    EXPECT_TRUE(small.viewer().state().clock.playing());
  }
  {
    HeadlessViewer dense(scene, {2560, 1440}, 2);
    ASSERT_TRUE(dense.wait_for_first_picture());
    const ImVec4 play = dense.viewer().marks().at("play");
    EXPECT_NEAR(play.w - play.y, 46, 4);
  }
}

}  // namespace
}  // namespace tenebra::viewer
