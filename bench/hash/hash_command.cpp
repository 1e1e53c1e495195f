// tenebra-bench hash: whether a change left every value as it was. Prints hashes of what is computed for
// some frames, for `diff` to compare with those of another build.
#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "base/fail.h"
#include "bench/common/bench_command.h"
#include "bench/common/bench_frame.h"
#include "bench/common/bench_report.h"
#include "bench/common/bench_scenes.h"
#include "bench/hash/hash_frame.h"
#include "bench/hash/picture_hashes.h"
#include "io/output_file.h"

namespace tenebra::bench {
namespace {

constexpr const char* value_head =
    "# What Tenebra computes for frames of its scenes, as hashes (XXH3, 64 bits): SCENE FRAME WHAT HASH.\n"
    "# Those of the bundled scenes are kept in tests/reference/hashes.txt; a test compares one frame of "
    "each.\n"
    "# To compare all of them:\n"
    "#   tenebra-bench hash --bundled | diff -I '^#' tests/reference/hashes.txt -\n"
    "# To make the file anew, only with a change that means to change the bits and says which and why:\n"
    "#   tenebra-bench hash --bundled -o tests/reference/hashes.txt\n";
constexpr const char* picture_head =
    "# What the whole renderer draws, as hashes (XXH3, 64 bits): SCENE FRAME WHAT HASH. Triangle ids, and\n"
    "# pictures and masks with them, depend on the OpenGL driver: no test compares them.\n";

struct HashArguments {
  std::filesystem::path data, out;
  std::string only;
  bool bundled = false, pictures = false, quick = false;
  int scale = 1;
};

std::vector<HashedScene> scenes_of(const HashArguments& arguments) {
  return arguments.quick ? quickly_hashed_scenes() : hashed_scenes();
}
std::vector<HashSetting> settings_of(const HashArguments& arguments) {
  return arguments.quick ? few_hash_settings() : hash_settings();
}

/// What has been found so far.
struct HashOutput {
  std::string text;
  std::size_t values = 0;
  int differing = 0;

  void add(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) {
      text.append(line).append("\n");
      if (!line.starts_with("#")) ++values;
    }
  }
};

Expected<void> check(const HashArguments& arguments) {
  std::error_code ignored;
  if (!arguments.data.empty() && !std::filesystem::is_directory(arguments.data, ignored))
    return base::fail("--data: {} is not a folder, expected the folder of robots, museum and kitchen",
                      arguments.data.string());
  if (arguments.scale < 1 || arguments.scale > 16)
    return base::fail("--scale: found {}, expected 1 to 16", arguments.scale);
  std::vector<std::string> names;
  for (const HashedScene& scene : hashed_scenes()) {
    if (arguments.only.empty() || arguments.only == scene.name) return {};
    names.push_back(scene.name);
  }
  return base::fail("--only: found {}, expected {}", arguments.only, fmt::join(names, ", "));
}

/// In every kind of context that there is.
Expected<void> add_pictures(const Scene& scene, const HashedScene& chosen, int scale, HashOutput& out) {
  for (const gl::ContextKind kind : {gl::ContextKind::egl, gl::ContextKind::osmesa}) {
    auto context = gl::Context::create(kind);
    if (!context) {
      out.text += fmt::format("# Left out: {}\n", context.error().message);
      continue;
    }
    const auto lines = hash_pictures(scene, chosen, std::move(*context), scale);
    if (!lines) return tl::unexpected(lines.error());
    out.add(*lines);
  }
  return {};
}

Expected<void> add_values(const Scene& scene, const HashedScene& chosen, const HashArguments& arguments,
                          HashOutput& out) {
  const auto hashed = hash_scene(scene, chosen, settings_of(arguments), arguments.scale);
  if (!hashed) return tl::unexpected(hashed.error());
  out.add(hashed->lines);
  out.differing += hashed->differing;
  return {};
}

Expected<void> add_scene(const HashedScene& chosen, const HashArguments& arguments, HashOutput& out) {
  const BenchScene& known = bench_scene(chosen.name);
  if (!arguments.only.empty() && arguments.only != chosen.name) return {};
  if (arguments.bundled && !known.bundled) return {};
  std::unique_ptr<testing::TemporaryFolder> made;
  const auto data = bart_folder(arguments.data);
  const auto file = find_scene(known, data, made);
  if (file.empty()) {
    out.text += fmt::format("# {} is left out: {} is not there.\n", chosen.name, known.file);
    return {};
  }
  const auto scene = load_scene(file, known.no_cast);
  if (!scene) return tl::unexpected(scene.error());
  return arguments.pictures ? add_pictures(*scene, chosen, arguments.scale, out)
                            : add_values(*scene, chosen, arguments, out);
}

Expected<void> write(const HashArguments& arguments, const std::string& text) {
  if (!arguments.out.empty()) return io::write_file(arguments.out, text);
  std::fputs(text.c_str(), stdout);
  return {};
}

void add_settings(const HashArguments& arguments, HashOutput& out) {
  std::vector<std::string> names;
  for (const HashSetting& setting : settings_of(arguments)) names.push_back(setting_name(setting));
  out.text += fmt::format("# Each value was the same at {}.\n", fmt::join(names, "; "));
}

Expected<void> run_hash(const HashArguments& arguments) {
  if (auto fine = check(arguments); !fine) return fine;
  HashOutput out{.text = arguments.pictures ? picture_head : value_head};
  if (arguments.scale != 1)
    out.text += fmt::format("# Pictures are {} times as wide and high as usual.\n", arguments.scale);
  for (const HashedScene& scene : scenes_of(arguments)) {
    if (auto done = add_scene(scene, arguments, out); !done) return done;
  }
  out.text += fmt::format("# {} lines.\n", out.values);
  if (!arguments.pictures && out.differing == 0) add_settings(arguments, out);
  if (auto written = write(arguments, out.text); !written) return written;
  if (out.differing == 0) return {};
  return base::fail(
      "{} values depend on the vector level or the number of threads; each setting has its line",
      out.differing);
}

}  // namespace

void add_hash_command(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand(
      "hash", "Hashes of everything that is computed, to see whether a change left it alone");
  const auto arguments = std::make_shared<HashArguments>();
  command->add_option("--data", arguments->data, "Folder of the scenes that do not come with the program")
      ->type_name("FOLDER");
  command->add_option("-o", arguments->out, "File instead of standard output")->type_name("FILE");
  command->add_option("--only", arguments->only, "One scene [all]")->type_name("SCENE");
  command->add_flag("--bundled", arguments->bundled, "Only scenes that come with the program");
  command->add_flag("--quick", arguments->quick,
                    "One frame per scene, each vector level on one thread or two, as the tests do");
  command->add_flag("--pictures", arguments->pictures,
                    "Instead, what the whole renderer draws: depends on the graphics driver");
  command->add_option("--scale", arguments->scale, "Pictures this many times as wide and high [1]")
      ->type_name("N");
  command->callback([arguments, &run] { run = [=] { return run_hash(*arguments); }; });
}

}  // namespace tenebra::bench
