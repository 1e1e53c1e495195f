// What every panel gets to draw with, and the few widgets that Dear ImGui does not have.
#pragma once

#include <imgui.h>

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "options/settings_names.h"
#include "window/frame_history.h"
#include "window/frames/explainer.h"
#include "window/frames/render_worker.h"
#include "window/frames/sun_counter.h"
#include "window/frames/trade_search.h"
#include "window/key_press.h"
#include "window/view_state.h"

namespace tenebra::viewer {

/// Where named widgets are, in window coordinates, for the event report.
using Marks = std::map<std::string, ImVec4>;  ///< left, top, right, bottom

struct Ui {
  ViewState& state;
  Actions& actions;
  Marks& marks;
  const Picture* picture;  ///< the newest; null before the first
  std::array<FrameHistory, 2>& history;
  std::span<const KeyPress> keys;  ///< pressed since the last frame of the window
  WorkerStatus worker;
  std::string_view log;                   ///< name of the log being written, or ""
  float scale = 1;                        ///< of the display: 1 at 96 dots per inch
  const PictureAnswer* answer = nullptr;  ///< about a pixel; null: none was asked for
  TradeStatus trade{};
  TradeSubject trade_subject{};  ///< of a search that began now
  JobStatus<CountedSun> sun{};
  const CountedSun* hours = nullptr;  ///< of the picture and the day that are shown; null: none

  float px(float length) const { return length * scale; }
  /// The press of this key without Ctrl; null: none. `repeat`: holding it down counts too.
  const KeyPress* pressed(int code, bool repeat = false) const;
  /// Records the last widget under `name`.
  void mark(const std::string& name);
};

/// Colours of the viewer's own drawing.
namespace palette {
inline constexpr ImU32 accent = IM_COL32(94, 156, 255, 255);
inline constexpr ImU32 text = IM_COL32(222, 226, 233, 255);
inline constexpr ImU32 dim = IM_COL32(139, 146, 160, 255);
inline constexpr ImU32 warning = IM_COL32(240, 176, 84, 255);
inline constexpr ImU32 panel = IM_COL32(22, 24, 29, 255);
inline constexpr ImU32 line = IM_COL32(44, 48, 57, 255);
inline constexpr ImU32 shade = IM_COL32(10, 11, 14, 215);
}  // namespace palette

/// Sets fonts and colours for a display of `scale`, once after the context is made.
void apply_style(float scale);

/// A label in the left column; the next widget fills the right one.
void row(const Ui& ui, const char* label, const char* help = nullptr);
void dim_text(const char* text);
/// A heading that folds; true while open.
bool section(Ui& ui, const char* title, bool open);
/// A linear colour, edited as it is seen where pictures are encoded. Values above 1 stay what they are until
/// they are changed.
bool edit_color(Ui& ui, const std::string& mark, glm::vec3& color);
/// X, Y and Z with all their digits.
bool edit_coordinates(const char* name, glm::dvec3& place);
void tooltip(const char* text);  ///< over the last widget

/// A row of buttons of which one is down. True if another was pressed.
bool segments(Ui& ui, const std::string& name, const char* const* labels, int count, int& chosen);

template <class T, std::size_t N>
bool choose(Ui& ui, const std::string& name, const std::array<Choice<T>, N>& choices, T& value) {
  std::array<std::string, N> texts;
  std::array<const char*, N> labels{};
  int chosen = 0;
  for (std::size_t i = 0; i < N; ++i) {
    texts[i] = choices[i].name;
    labels[i] = texts[i].c_str();
    if (choices[i].value == value) chosen = static_cast<int>(i);
  }
  if (!segments(ui, name, labels.data(), static_cast<int>(N), chosen)) return false;
  value = choices[static_cast<std::size_t>(chosen)].value;
  return true;
}

}  // namespace tenebra::viewer
