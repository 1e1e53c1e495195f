// A virtual display whose pixels are read while programs draw on it, and whose keys and mouse are operated.
// Reading costs the programs nothing: the display's memory is mapped.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "support/child_process.h"
#include "support/temporary_folder.h"

namespace tenebra::bench {

/// A part of the screen, in pixels from its left and top.
struct ScreenArea {
  int left = 0, top = 0, right = 0, bottom = 0;
};

// Keysyms of X11.
constexpr unsigned long key_right = 0xff53, key_down = 0xff54, key_enter = 0xff0d, key_control = 0xffe3;

/// Xvfb with real key repeat: after 250 ms, 30 times a second.
class WatchedScreen {
public:
  static constexpr int width = 1400, height = 1120;

  /// Fails with what is missing.
  static Expected<std::unique_ptr<WatchedScreen>> start();
  ~WatchedScreen();
  WatchedScreen(const WatchedScreen&) = delete;
  WatchedScreen& operator=(const WatchedScreen&) = delete;

  const std::string& name() const { return name_; }  ///< for DISPLAY

  /// Green values, on a grid of every eighth pixel of the area.
  void sample(ScreenArea area, std::vector<std::uint8_t>& out) const;

  void key(unsigned long symbol, bool down) const;  ///< a keysym of X11
  void button(int number, bool down) const;
  void move_to(int x, int y) const;

private:
  struct Hand;
  WatchedScreen() = default;
  Expected<void> start_server();
  Expected<void> map_pixels();

  testing::TemporaryFolder folder_;
  std::unique_ptr<testing::ChildProgram> server_;
  std::string name_;
  void* mapped_ = nullptr;
  std::size_t mapped_bytes_ = 0;
  const std::uint8_t* pixels_ = nullptr;  // four bytes each
  std::size_t row_bytes_ = 0;
  std::unique_ptr<Hand> hand_;
};

}  // namespace tenebra::bench
