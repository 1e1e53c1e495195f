// tenebra convert: any scene file to a binary glTF file that other programs open.
#include <limits>
#include <memory>

#include "base/fail.h"
#include "commands/command.h"
#include "io/output_file.h"
#include "options/memory_option.h"
#include "options/scene_options.h"
#include "options/settings_names.h"
#include "shared/files_apart.h"
#include "shell/console.h"
#include "shell/memory_limit.h"
#include "shell/stop_signals.h"

namespace tenebra::viewer {
namespace {

constexpr const char* convert_examples =
    "Example:\n"
    "  tenebra convert bart/robots/Robot.aff robots.glb --fps 24\n"
    "\n"
    "BART's splines become --fps keys per second, or one key for each of the file's own frames where it "
    "numbers\n"
    "them; animated triangles become morph targets. Pictures are embedded as PNG; what glTF cannot express\n"
    "about surfaces is stored in extras, where tenebra finds it again. OUT is either whole or absent.";

struct ConvertOptions {
  SceneOptions scene;
  std::string output;
  double fps = 30.0;
  std::optional<int> memory_mb;
  bool quiet = false;
};

Expected<int> convert(const ConvertOptions& options) {
  if (!options.output.ends_with(".glb"))
    return base::fail("{}: expected a name that ends in .glb", options.output);
  const StopSignals stop(std::numeric_limits<double>::infinity(), StopSignals::Start::at_once);
  if (auto limited = limit_memory(options.memory_mb); !limited) return tl::unexpected(limited.error());
  std::vector<std::filesystem::path> inputs;
  formats::ImportOptions import = options.scene.import;
  import.files_read = &inputs;
  const auto scene = formats::import_scene(options.scene.file, import);
  if (!scene) return tl::unexpected(scene.error());
  if (auto apart = check_files_apart(inputs, OutputName{"OUT", options.output}); !apart)
    return tl::unexpected(apart.error());
  if (!options.quiet) print_warnings(scene->warnings);
  io::remove_stale_temporaries(std::filesystem::path(options.output).parent_path());
  const auto losses = formats::export_glb(*scene, options.output, options.fps);
  if (!losses) return tl::unexpected(losses.error());
  if (!options.quiet) print_warnings(*losses);
  return 0;
}

}  // namespace

void add_convert_command(CLI::App& program, Run& run) {
  CLI::App& command =
      add_command(program, "convert", "Write a scene, with its animation, as binary glTF 2.0");
  const auto options = std::make_shared<ConvertOptions>();
  set_examples(command, convert_examples);
  add_text(command, "IN", options->scene.file, "Scene file (tenebra info --formats)").required();
  add_text(command, "OUT", options->output, "File to write, .glb").required();
  add_value(command, "--fps", options->fps, parse_positive, "Keys per second for baked splines [30]")
      .type_name("F");
  add_import_options(command, options->scene);
  add_memory_option(command, options->memory_mb);
  add_flag(command, "--quiet", options->quiet, "No warnings");
  when_chosen(command, [options, &run] { run = [options] { return convert(*options); }; });
}

}  // namespace tenebra::viewer
