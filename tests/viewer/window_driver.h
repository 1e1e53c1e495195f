// Drives `tenebra view` as a person would: a virtual display, real key and mouse events, pictures of the
// screen; what the program says of itself comes from its --report.
#pragma once

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <thread>

#include "support/patience.h"
#include "support/virtual_display.h"
#include "viewer_test_scene.h"

namespace tenebra::testing {

using Json = nlohmann::json;

/// One session with the window.
class ViewSession {
public:
  ViewSession(const VirtualDisplay& display, const TemporaryFolder& folder,
              std::vector<std::string> arguments)
      : display_(display), report_(folder / "report.jsonl") {
    arguments.insert(arguments.begin(), {TENEBRA_PROGRAM, "view"});
    if (std::find(arguments.begin(), arguments.end(), "--settings") == arguments.end())
      arguments.insert(arguments.end(), {"--settings", "none"});
    arguments.insert(arguments.end(), {"--report", report_.string(), "--gl-debug"});
    std::filesystem::remove(report_);  // an earlier session's: its events would be taken for this one's
    display.run({"xdotool", "mousemove", "5", "5"});
    program_ = std::make_unique<ChildProgram>(arguments, [&display, where = folder.path().string()] {
      display.enter();
      if (::chdir(where.c_str()) != 0) ::_exit(125);  // what it names by itself belongs to the test
    });
  }

  /// All events so far.
  const std::vector<Json>& events() const {
    std::ifstream file(report_, std::ios::binary);
    file.seekg(read_);
    for (std::string line; std::getline(file, line) && !file.eof();
         read_ += std::streamoff(line.size() + 1)) {
      events_.push_back(Json::parse(line));
    }
    return events_;
  }
  std::size_t count() const { return events().size(); }

  /// Waits until `done`, which is asked whenever there may be new events; false after a long wait.
  template <class Done>
  bool wait_until(const char* what, Done done) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s_);
    while (!done()) {
      if (std::chrono::steady_clock::now() > end) {
        patience_s_ = 1;  // what follows will hardly come
        ADD_FAILURE() << "waited in vain for " << what
                      << "; last: " << (count() > 0 ? events().back().dump() : "");
        return false;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  /// The first event from number `from` on that `fits`; null after a long wait.
  template <class Fits>
  Json wait_for(std::size_t from, const char* what, Fits fits) const {
    Json found;
    wait_until(what, [&] {
      const auto& all = events();
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(std::min(from, all.size()));
      const auto it = std::find_if(first, all.end(), fits);
      if (it != all.end()) found = *it;
      return it != all.end();
    });
    return found;
  }
  Json wait_for_event(std::size_t from, const std::string& name) const {
    return wait_for(from, name.c_str(), [&](const Json& event) { return event["event"] == name; });
  }
  /// The whole picture that shows what has been asked for until now; it and its numbers are in the window.
  Json wait_for_picture() const {
    Json picture;
    wait_until("the picture of the last request, and its draw", [&] {
      const auto& all = events();
      const auto is = [](const char* name) {
        return [name](const Json& event) { return event["event"] == name; };
      };
      const auto request = std::find_if(all.rbegin(), all.rend(), is("request"));
      const auto shown = std::find_if(all.rbegin(), all.rend(), is("shown"));
      const auto last = std::find_if(all.rbegin(), all.rend(), is("picture"));
      if (request == all.rend() || shown == all.rend() || last == all.rend()) return false;
      picture = *last;
      return picture["request"] == (*request)["number"] && picture["preview"] == "" &&
             std::stoull((*shown)["text"].get<std::string>()) >= picture["number"];
    });
    return picture;
  }
  Json state() const { return last("state"); }
  /// Does something and waits until the state has `value` at `key`.
  template <class Act>
  void expect_state(const char* key, const Json& value, Act act) const {
    const std::size_t from = count();
    act();
    wait_for(from, key, [&](const Json& event) { return event["event"] == "state" && event[key] == value; });
  }

  Json marks() const { return last("marks"); }
  void wait_until_gone(const std::string& name) const {
    wait_until(("no " + name).c_str(), [&] { return !marks().contains(name); });
  }
  /// Left, top, right, bottom of a widget on the screen; waits until it is there.
  std::array<double, 4> place(const std::string& name) const {
    if (!wait_until(("a widget " + name).c_str(), [&] { return marks().contains(name); })) return {};
    return marks()[name].get<std::array<double, 4>>();
  }

  void move_to(double x, double y) const {
    const std::array to{static_cast<int>(x), static_cast<int>(y)};
    if (to == pointer_) return;  // nothing would come of it
    act({"mousemove", std::to_string(to[0]), std::to_string(to[1])}, "move");
    pointer_ = to;
  }
  /// At a part of a widget's width; its middle.
  void move_to(const std::string& name, double part = 0.5) const {
    const auto [left, top, right, bottom] = place(name);
    move_to(left + part * (right - left), (top + bottom) / 2);
  }
  void click(const std::string& name) const {
    move_to(name);
    press();
    release();
  }
  void press(int button = 1) const { act({"mousedown", std::to_string(button)}, "press"); }
  void release(int button = 1) const { act({"mouseup", std::to_string(button)}, "release"); }
  /// A drag by `right`, `down` from there.
  void drag(double x, double y, double right, double down) const {
    move_to(x, y);
    press();
    move_to(x + right, y + down);
    release();
  }
  /// The same from the middle of a widget.
  void drag(const std::string& name, double right, double down) const {
    const auto [left, top, rim, bottom] = place(name);
    drag((left + rim) / 2, (top + bottom) / 2, right, down);
  }
  /// "ctrl+q": each of them goes down and comes up again.
  void key(const std::string& keys) const {
    const auto held = std::count(keys.begin(), keys.end(), '+');
    act({"key", keys}, "key up", static_cast<std::size_t>(held) + 1);
  }
  void xdotool(std::vector<std::string> arguments) const {
    pointer_ = {-1, -1};
    arguments.insert(arguments.begin(), "xdotool");
    const auto result = display_.run(arguments);
    EXPECT_EQ(result.exit_code, 0) << arguments[1] << ": " << result.errors;
  }
  /// What is on the screen, as PNG, to be looked at: $TENEBRA_SHOTS/NAME.png, if that is set.
  void photograph(const std::string& name) const {
    const char* folder = std::getenv("TENEBRA_SHOTS");
    if (folder == nullptr) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    display_.run({"import", "-window", "root", std::string(folder) + "/" + name + ".png"});
  }
  ProgramResult wait(double timeout_s = 120) const { return program_->wait(timeout_s); }
  void expect_no_gl_errors() const {
    for (const Json& event : events()) EXPECT_NE(event["event"], "gl") << event.dump();
  }

private:
  Json last(const char* name) const {
    const auto& all = events();
    const auto it =
        std::find_if(all.rbegin(), all.rend(), [&](const Json& event) { return event["event"] == name; });
    return it == all.rend() ? Json() : *it;
  }
  /// Events, and the wait until the window has drawn what came of them: `count` inputs of the name that the
  /// report gives the last of them, then a draw. Or the end.
  void act(const std::vector<std::string>& arguments, const char* input, std::size_t count = 1) const {
    const std::size_t from = this->count();
    const auto pointer = pointer_;
    xdotool(arguments);
    pointer_ = pointer;
    wait_until(input, [&] {
      const auto& all = events();
      std::size_t seen = 0;
      for (std::size_t i = from; i < all.size(); ++i) {
        if (all[i]["event"] == "input" && all[i]["text"] == input) ++seen;
        if (all[i]["event"] == "end" || (seen >= count && all[i]["event"] == "drawn")) return true;
      }
      return false;
    });
  }

  const VirtualDisplay& display_;
  std::filesystem::path report_;
  std::unique_ptr<ChildProgram> program_;
  mutable double patience_s_ = 60 * patience;
  mutable std::vector<Json> events_;
  mutable std::streamoff read_ = 0;             // of the report
  mutable std::array<int, 2> pointer_{-1, -1};  // where it was moved last
};

/// A test with a folder and a virtual display of its own; skipped where there can be no display.
class WindowTest : public ::testing::Test {
protected:
  void SetUp() override {
    // A window needs a display, and the hands that work it a program each; setup installs them.
    for (const char* needed : {"Xvfb", "xdotool", "import", "xrdb"})
      if (!has_program(needed)) GTEST_SKIP() << needed << " is missing: tools/setup.sh --tests";
  }
  const VirtualDisplay& display() {
    if (!display_) display_.emplace();
    return *display_;
  }

  const TemporaryFolder folder_;

private:
  std::optional<VirtualDisplay> display_;
};

}  // namespace tenebra::testing
