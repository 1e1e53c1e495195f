#include "bench/viewer/watched_screen.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "base/fail.h"

namespace tenebra::bench {

/// The XTest extension, found at run time: its headers are needed by nothing else.
struct WatchedScreen::Hand {
  void* x11 = nullptr;
  void* xtst = nullptr;
  void* display = nullptr;
  void* (*open)(const char*) = nullptr;
  int (*close)(void*) = nullptr;
  int (*flush)(void*) = nullptr;
  unsigned char (*keycode)(void*, unsigned long) = nullptr;
  int (*fake_key)(void*, unsigned, int, unsigned long) = nullptr;
  int (*fake_button)(void*, unsigned, int, unsigned long) = nullptr;
  int (*fake_motion)(void*, int, int, int, unsigned long) = nullptr;

  ~Hand() {
    if (display) close(display);
    if (xtst) ::dlclose(xtst);
    if (x11) ::dlclose(x11);
  }

  Expected<void> start(const std::string& name) {
    x11 = ::dlopen("libX11.so.6", RTLD_NOW | RTLD_GLOBAL);
    xtst = ::dlopen("libXtst.so.6", RTLD_NOW);
    if (!x11 || !xtst)
      return base::fail("found no {}, expected it to press keys", x11 ? "libXtst" : "libX11");
    const bool all =
        find(x11, "XOpenDisplay", open) && find(x11, "XCloseDisplay", close) && find(x11, "XFlush", flush) &&
        find(x11, "XKeysymToKeycode", keycode) && find(xtst, "XTestFakeKeyEvent", fake_key) &&
        find(xtst, "XTestFakeButtonEvent", fake_button) && find(xtst, "XTestFakeMotionEvent", fake_motion);
    if (!all) return base::fail("libX11 or libXtst lack functions that press keys");
    display = open(name.c_str());
    return display ? Expected<void>() : Expected<void>(base::fail("display {} lets nobody in", name));
  }

private:
  template <class Function>
  static bool find(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(::dlsym(library, name));
    return function != nullptr;
  }
};

WatchedScreen::~WatchedScreen() {
  hand_.reset();
  if (mapped_) ::munmap(mapped_, mapped_bytes_);
}

Expected<std::unique_ptr<WatchedScreen>> WatchedScreen::start() {
  std::unique_ptr<WatchedScreen> screen(new WatchedScreen);
  if (auto done = screen->start_server(); !done) return tl::unexpected(done.error());
  if (auto done = screen->map_pixels(); !done) return tl::unexpected(done.error());
  screen->hand_ = std::make_unique<Hand>();
  if (auto done = screen->hand_->start(screen->name_); !done) return tl::unexpected(done.error());
  return screen;
}

Expected<void> WatchedScreen::start_server() {
  if (::access("/usr/bin/Xvfb", X_OK) != 0) return base::fail("found no Xvfb, expected one for a display");
  const std::string command = fmt::format(
      "exec /usr/bin/Xvfb -displayfd 3 -screen 0 {}x{}x24 -noreset -nolisten tcp -ardelay 250 "
      "-arinterval 33 -fbdir {} 3>{}",
      width, height, folder_.path().string(), (folder_ / "number").string());
  server_ = std::make_unique<testing::ChildProgram>(std::vector<std::string>{"/bin/bash", "-c", command});
  for (int i = 0; i < 200; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const std::string number = testing::read_text(folder_ / "number");
    if (number.find('\n') == std::string::npos) continue;
    name_ = ":" + number.substr(0, number.find('\n'));
    return {};
  }
  return base::fail("Xvfb has not started in 10 s");
}

/// The file of -fbdir is an X window dump: words of the header, highest byte first, then colours, then
/// pixels.
Expected<void> WatchedScreen::map_pixels() {
  const std::string file = (folder_ / "Xvfb_screen0").string();
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) return base::fail("{}: cannot be read", file);
  mapped_bytes_ = static_cast<std::size_t>(status.st_size);
  void* mapped = ::mmap(nullptr, mapped_bytes_, PROT_READ, MAP_SHARED, descriptor, 0);
  ::close(descriptor);
  if (mapped == MAP_FAILED) return base::fail("{}: cannot be mapped", file);
  mapped_ = mapped;
  const auto* bytes = static_cast<const std::uint8_t*>(mapped_);
  const auto word = [&](std::size_t i) {
    const std::uint8_t* at = bytes + 4 * i;
    return (std::size_t{at[0]} << 24) | (std::size_t{at[1]} << 16) | (std::size_t{at[2]} << 8) | at[3];
  };
  constexpr std::size_t header_size = 0, screen_width = 4, screen_height = 5, pixel_bits = 11, row_size = 12,
                        colours = 19, colour_bytes = 12;
  const std::size_t begin = word(header_size) + word(colours) * colour_bytes;
  row_bytes_ = word(row_size);
  if (word(screen_width) != width || word(screen_height) != height || word(pixel_bits) != 32 ||
      row_bytes_ < 4 * width || begin + row_bytes_ * height > mapped_bytes_)
    return base::fail("{}: found no screen of {}x{} with 32 bits per pixel", file, width, height);
  pixels_ = bytes + begin;
  return {};
}

void WatchedScreen::sample(ScreenArea area, std::vector<std::uint8_t>& out) const {
  constexpr int step = 8;
  out.clear();
  for (int y = area.top; y < area.bottom; y += step) {
    const std::uint8_t* row = pixels_ + static_cast<std::size_t>(y) * row_bytes_;
    for (int x = area.left; x < area.right; x += step) out.push_back(row[4 * x + 1]);
  }
}

void WatchedScreen::key(unsigned long symbol, bool down) const {
  hand_->fake_key(hand_->display, hand_->keycode(hand_->display, symbol), down ? 1 : 0, 0);
  hand_->flush(hand_->display);
}

void WatchedScreen::button(int number, bool down) const {
  hand_->fake_button(hand_->display, static_cast<unsigned>(number), down ? 1 : 0, 0);
  hand_->flush(hand_->display);
}

void WatchedScreen::move_to(int x, int y) const {
  hand_->fake_motion(hand_->display, -1, x, y, 0);
  hand_->flush(hand_->display);
}

}  // namespace tenebra::bench
