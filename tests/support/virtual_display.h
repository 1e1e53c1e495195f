// A screen without a monitor, for programs that open windows.
#pragma once

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "support/child_process.h"
#include "support/temporary_folder.h"

namespace tenebra::testing {

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

  std::string name() const { return ":" + std::to_string(number_); }
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

}  // namespace tenebra::testing
