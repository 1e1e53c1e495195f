// The program `tenebra`: picks the command, and turns every failure into one sentence and an exit code.

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "commands/command.h"
#include "options/help_pages.h"
#include "options/options_page.h"
#include "options/setting_options.h"
#include "options/settings_names.h"
#include "shell/console.h"
#include "shell/exit_codes.h"
#include "shell/first_words.h"
#include "shell/last_words.h"

namespace {

using tenebra::viewer::Run;

constexpr int failure = tenebra::viewer::exit_codes::failed;
constexpr int comparison_failure = tenebra::viewer::exit_codes::comparison_failed;

constexpr const char* commands = "view, render, info, convert, bake, sun, compare, log, verify or trade";
constexpr const char* about =
    "tenebra: exact, alias-free shadows for animated scenes on the CPU, with or without OpenGL\n";
constexpr const char* first_steps =
    "First steps:\n"
    "  tenebra view                                      a window on the bundled city\n"
    "  tenebra model.glb                                 a window on a scene of yours\n"
    "  tenebra info scenes/city.glb                      what a scene contains\n"
    "  tenebra render scenes/city.glb                    its first frame, to out/0000.png\n"
    "  tenebra render scenes/city.glb --frames all       the whole animation\n"
    "  tenebra help COMMAND [TOPIC]                      the options of a command, with examples\n"
    "\n"
    "Scenes: glTF 2.0, OBJ, PLY, STL, BART's AFF and more (tenebra info --formats).\n"
    "A failure is one sentence on standard error and exit code 1 (2 from compare, 75 if memory runs out).";

int report(const std::string& sentence, int code) {
  tenebra::viewer::print_failure(sentence);
  return code;
}

/// What a command printed counts only once it is out: a full disk shows here. A reader that has gone, as
/// `head` does, has what it wanted: nothing is said then.
int flush_output(int code, int on_failure = failure) {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (!flushed && errno == EPIPE) return tenebra::viewer::exit_codes::reader_gone;
  if (flushed && std::ferror(stdout) == 0) return code;
  return report("cannot write standard output: no space left, or its reader is gone", on_failure);
}

std::vector<std::string> names_of_commands(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

std::string unknown_command(const CLI::App& program, const std::string& word) {
  const std::string nearest = tenebra::settings::did_you_mean(word, names_of_commands(program));
  if (!nearest.empty()) return fmt::format("unknown command '{}'{}", word, nearest);
  return fmt::format("found no command and no file '{}', expected {}, or a scene", word, commands);
}

/// " (did you mean --size?)" where an option was given that the command does not have.
std::string nearest_option(const CLI::App& program) {
  if (program.get_subcommands().empty()) return "";
  return tenebra::viewer::did_you_mean(*program.get_subcommands().front());
}

/// The sentence of `error`; what was not understood in the order in which it was typed.
std::string refusal(const CLI::App& program, const CLI::ParseError& error) {
  const std::vector<std::string> left = program.remaining(true);
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || left.empty())
    return tenebra::viewer::sentence_of(error);
  return fmt::format(
      "found {}, which {} does not know", fmt::join(left, " "),
      program.get_subcommands().empty() ? "tenebra" : program.get_subcommands().front()->get_name());
}

void warn_of_old_names(const CLI::App& program, const std::vector<std::string>& arguments) {
  for (const CLI::App* command : program.get_subcommands())
    if (!tenebra::viewer::is_quiet(*command))
      tenebra::viewer::print_warnings(tenebra::viewer::outdated_uses(*command, arguments));
}

int parse_and_run(CLI::App& program, Run& run, const std::vector<std::string>& arguments) {
  const auto failure_code = [&] { return program.got_subcommand("compare") ? comparison_failure : failure; };
  try {
    program.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // the last one first
  } catch (const CLI::CallForHelp&) {
    tenebra::viewer::print_out("{}",
                               tenebra::viewer::help_page(program, tenebra::viewer::help_topic(arguments)));
    return flush_output(0);
  } catch (const CLI::CallForVersion& version) {
    tenebra::viewer::print_out("{}\n", version.what());
    return flush_output(0);
  } catch (const CLI::ParseError& error) {
    const bool named = !arguments.empty() && !arguments.front().starts_with('-');
    if (named && program.get_subcommands().empty())
      return report(unknown_command(program, arguments.front()), failure);
    return report(refusal(program, error) + nearest_option(program), failure_code());
  }
  warn_of_old_names(program, arguments);
  if (!run) return report(fmt::format("give a command: {} (see tenebra --help)", commands), failure);
  try {
    const auto code = run();
    return code ? flush_output(*code, failure_code()) : report(code.error().message, failure_code());
  } catch (const std::exception& error) {
    if (tenebra::viewer::is_memory_failure(error)) {
      tenebra::viewer::print_no_memory();
      return program.got_subcommand("compare") ? comparison_failure : tenebra::viewer::no_memory_code();
    }
    return report(fmt::format("stopped by an unexpected failure ({})", error.what()), failure_code());
  }
}

}  // namespace

int main(int argc, char** argv) {
  // Both are reported by the write that fails, in a sentence, instead of ending the program in the middle of
  // a file.
  static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
  static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));
  tenebra::viewer::set_last_words();
  try {
    CLI::App program{about, "tenebra"};
    program.footer(first_steps);
    program.set_version_flag("--version", "tenebra " TENEBRA_VERSION);
    program.formatter(tenebra::viewer::help_format());
    Run run;
    tenebra::viewer::add_view_command(program, run);
    tenebra::viewer::add_render_command(program, run);
    tenebra::viewer::add_info_command(program, run);
    tenebra::viewer::add_convert_command(program, run);
    tenebra::viewer::add_bake_command(program, run);
    tenebra::viewer::add_sun_command(program, run);
    tenebra::viewer::add_compare_command(program, run);
    tenebra::viewer::add_log_command(program, run);
    tenebra::viewer::add_verify_command(program, run);
    tenebra::viewer::add_trade_command(program, run);
    const auto print_page = [&run] {
      run = []() -> tenebra::Expected<int> {
        tenebra::viewer::print_out("{}", tenebra::viewer::options_page());
        return 0;
      };
    };
    program.add_flag_callback("--options-page", print_page)->group("");  // for docs/options.md
    const auto names = names_of_commands(program);
    return parse_and_run(program, run, tenebra::viewer::as_commands({argv + 1, argv + argc}, names));
  } catch (const std::exception& error) {
    if (!tenebra::viewer::is_memory_failure(error))
      return report(fmt::format("cannot start ({})", error.what()), failure);
    tenebra::viewer::print_no_memory();
    return tenebra::viewer::no_memory_code();
  }
}
