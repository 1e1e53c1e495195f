// The mouse between two frames of the window. Dear ImGui looks at it once per frame; here every press and
// release gets a frame of its own, at the place where it happened, however long frames take.
#pragma once

#include <imgui.h>

#include <array>
#include <deque>

namespace tenebra::viewer {

class MouseQueue {
public:
  void move(ImVec2 to) { at_ = to; }
  /// `button`: Dear ImGui's number; others are dropped.
  void button(int button, bool down) {
    if (button >= 0 && button < static_cast<int>(down_.size())) waiting_.push_back({at_, button, down});
  }
  bool waits() const { return !waiting_.empty(); }

  /// Before ImGui::NewFrame, after the window system has filled `io`: gives it the next press or release.
  void feed(ImGuiIO& io) {
#if IMGUI_VERSION_NUM >= 18700  // takes the mouse by events, and keeps the place until it is told another
    if (waits() || elsewhere_) {
      const ImVec2 at = waits() ? waiting_.front().at : at_;
      io.AddMousePosEvent(at.x, at.y);
    }
    elsewhere_ = waits();
    if (!waits()) return;
    const Event event = waiting_.front();
    waiting_.pop_front();
    io.AddMouseButtonEvent(event.button, event.down);
#else
    if (waits()) {
      const Event event = waiting_.front();
      waiting_.pop_front();
      io.MousePos = event.at;
      down_[static_cast<std::size_t>(event.button)] = event.down;
    }
    for (std::size_t i = 0; i < down_.size(); ++i) io.MouseDown[i] = down_[i];
#endif
  }

private:
  struct Event {
    ImVec2 at;
    int button;
    bool down;
  };
  ImVec2 at_{0, 0};
  std::array<bool, 3> down_{};  // as Dear ImGui has been told
#if IMGUI_VERSION_NUM >= 18700
  bool elsewhere_ = false;  // it was told a place where the mouse may be no more
#endif
  std::deque<Event> waiting_;
};

}  // namespace tenebra::viewer
