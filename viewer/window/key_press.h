// Keys as the window reports them: presses are queued, so that none is lost however long a frame takes.
#pragma once

namespace tenebra::viewer {

/// Codes are those of GLFW: a letter is its capital as the keyboard's layout names it.
struct KeyPress {
  int code = 0;
  bool shift = false;
  bool ctrl = false;
  bool repeat = false;  ///< the key was held down
};

namespace key_code {
inline constexpr int space = 32, escape = 256, tab = 258, backspace = 259, right = 262, left = 263,
                     down = 264, up = 265, home = 268, end = 269, enter = 257, keypad_enter = 335, f6 = 295;
}

}  // namespace tenebra::viewer
