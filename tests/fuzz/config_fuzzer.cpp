// Files of options from bytes.
#include <CLI/CLI.hpp>

#include "fuzz/input_file.h"
#include "options/config_file.h"
#include "settings/values.h"
#include "shell/command_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace tenebra::viewer;
  using namespace tenebra::settings;
  static const tenebra::fuzz::InputFile input(".cfg");
  CLI::App program;
  bool quiet = false;
  std::vector<std::string> names;
  std::optional<Size> picture;
  std::optional<FrameRange> frames;
  for (const char* name : {"render", "view"}) {
    CLI::App& command = add_command(program, name, "");
    add_flag(command, "--quiet", quiet, "");
    add_texts(command, "--no-cast", names, "");
    add_value(command, "--size", picture, parse_size, "");
    add_value(command, "--frames", frames, parse_frame_range, "");
    add_config_option(command);
  }
  std::string path = input.write(bytes, size).string();
  char program_name[] = "tenebra", command_name[] = "render", option[] = "--config";
  char* arguments[] = {program_name, command_name, option, path.data()};
  try {
    program.parse(4, arguments);
  } catch (const CLI::ParseError& error) {
    (void)sentence_of(error);
  }
  return 0;
}
