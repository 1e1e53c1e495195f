// Drives `tenebra view` as a person would: a virtual display, real key and mouse events, pictures of the
// screen; what the program says of itself comes from its --report.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "viewer_test_scene.h"

namespace tenebra::test {

using Json = nlohmann::json;

inline bool has_program(const char* name) {
  return std::filesystem::exists(std::filesystem::path("/usr/bin") / name);
}

/// Xvfb on a free display number for as long as it lives. Held keys do not repeat: a slow machine holds every
/// key.
class VirtualDisplay {
public:
  explicit VirtualDisplay(const std::string& screen = "1280x800x24", int dots_per_inch = 96) {
    const std::string command = "exec Xvfb -displayfd 3 -screen 0 " + screen +
                                " -noreset -nolisten tcp -r 3>" + (folder_ / "number").string();
    server_ = std::make_unique<ChildProgram>(std::vector<std::string>{"/bin/bash", "-c", command});
    for (int i = 0; i < 400 && read_text(folder_ / "number").find('\n') == std::string::npos; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    std::istringstream(read_text(folder_ / "number")) >> number_;
    if (dots_per_inch != 96) {
      write_text(folder_ / "resources", "Xft.dpi: " + std::to_string(dots_per_inch) + "\n");
      run({"xrdb", "-nocpp", "-load", (folder_ / "resources").string()});
    }
  }

  std::string name() const { return fmt::format(":{}", number_); }
  void enter() const { ::setenv("DISPLAY", name().c_str(), 1); }
  ProgramResult run(std::vector<std::string> arguments) const {
    arguments[0] = "/usr/bin/" + arguments[0];
    return run_program(arguments, [this] { enter(); });
  }

private:
  TemporaryFolder folder_;
  std::unique_ptr<ChildProgram> server_;
  int number_ = -1;
};

/// One session with the window.
class ViewSession {
public:
  ViewSession(const VirtualDisplay& display, const TemporaryFolder& folder,
              std::vector<std::string> arguments)
      : display_(display), report_(folder / "report.jsonl") {
    arguments.insert(arguments.begin(), {TENEBRA_PROGRAM, "view"});
    arguments.insert(arguments.end(), {"--report", report_.string(), "--gl-debug"});
    std::filesystem::remove(report_);  // an earlier session's: its events would be taken for this one's
    display.run({"xdotool", "mousemove", "5", "5"});
    program_ = std::make_unique<ChildProgram>(arguments, [&display] { display.enter(); });
  }

  /// All events so far.
  std::vector<Json> events() const {
    std::vector<Json> events;
    std::istringstream lines(read_text(report_));
    for (std::string line; std::getline(lines, line) && !lines.eof();) events.push_back(Json::parse(line));
    return events;
  }
  std::size_t count() const { return events().size(); }

  /// The first event from number `from` on that `fits`; null after a long wait.
  template <class Fits>
  Json wait_for(std::size_t from, const char* what, Fits fits, double seconds = 60) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    do {
      const auto all = events();
      for (std::size_t i = from; i < all.size(); ++i) {
        if (fits(all[i])) return all[i];
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    } while (std::chrono::steady_clock::now() < end);
    ADD_FAILURE() << "waited in vain for " << what
                  << "; last: " << (count() > 0 ? events().back().dump() : "");
    return nullptr;
  }
  Json wait_for_event(std::size_t from, const std::string& name) const {
    return wait_for(from, name.c_str(), [&](const Json& event) { return event["event"] == name; });
  }
  /// The picture that shows what has been asked for until now; it and its numbers are in the window.
  Json wait_for_picture() const {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const auto newest_request = [&] {
      std::uint64_t newest = 0;
      for (const Json& event : events()) {
        if (event["event"] == "request") newest = event["number"];
      }
      return newest;
    };
    const Json picture = wait_for(0, "the picture of the last request", [&](const Json& event) {
      return event["event"] == "picture" && event["request"] == newest_request();
    });
    if (picture.is_null()) return picture;
    wait_for(0, "its draw", [&](const Json& event) {
      return event["event"] == "shown" && std::stoull(event["text"].get<std::string>()) >= picture["number"];
    });
    return picture;
  }
  Json state() const {
    Json last;
    for (const Json& event : events()) {
      if (event["event"] == "state") last = event;
    }
    return last;
  }
  /// Does something and waits until the state has `value` at `key`.
  template <class Act>
  void expect_state(const char* key, const Json& value, Act act) const {
    const std::size_t from = count();
    act();
    wait_for(from, key, [&](const Json& event) { return event["event"] == "state" && event[key] == value; });
  }

  Json marks() const {
    Json marks;
    for (Json& event : events()) {
      if (event["event"] == "marks") marks = std::move(event);
    }
    return marks;
  }
  void wait_until_gone(const std::string& name) const {
    for (int i = 0; i < 1200 && marks().contains(name); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    EXPECT_FALSE(marks().contains(name)) << name;
  }
  /// Left, top, right, bottom of a widget on the screen; waits until it is there.
  std::array<double, 4> place(const std::string& name) const {
    for (int i = 0; i < 600; ++i) {
      const Json marks = this->marks();
      if (marks.contains(name)) return marks[name].get<std::array<double, 4>>();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ADD_FAILURE() << "no widget " << name << " in " << marks().dump();
    return {};
  }

  void move_to(double x, double y) const {
    const std::array to{static_cast<int>(x), static_cast<int>(y)};
    if (to == pointer_) return;  // nothing would come of it
    act({"mousemove", std::to_string(to[0]), std::to_string(to[1])});
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
  void press(int button = 1) const { act({"mousedown", std::to_string(button)}); }
  void release(int button = 1) const { act({"mouseup", std::to_string(button)}); }
  void key(const std::string& keys) const { act({"key", keys}); }
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
  std::size_t draws() const {
    std::size_t count = 0;
    for (const Json& event : events()) count += event["event"] == "drawn" || event["event"] == "end" ? 1 : 0;
    return count;
  }
  /// An event, and the wait until the window has drawn what came of it.
  void act(const std::vector<std::string>& arguments) const {
    const std::size_t before = draws();
    const auto pointer = pointer_;
    xdotool(arguments);
    pointer_ = pointer;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (draws() == before && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    // A key or button that comes up again is drawn for itself.
    for (std::size_t drawn = before; drawn != draws();) {
      drawn = draws();
      std::this_thread::sleep_for(std::chrono::milliseconds(250));
    }
  }

  const VirtualDisplay& display_;
  std::filesystem::path report_;
  std::unique_ptr<ChildProgram> program_;
  mutable std::array<int, 2> pointer_{-1, -1};  // where it was moved last
};

#define TENEBRA_NEEDS_A_DISPLAY()                                                              \
  for (const char* needed : {"Xvfb", "xdotool", "import", "xrdb"}) {                           \
    if (!has_program(needed)) GTEST_SKIP() << needed << " is missing: tools/setup.sh --tests"; \
  }

}  // namespace tenebra::test
