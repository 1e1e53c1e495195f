// import_converted: runs the converter and says in one sentence how it failed.
#include <algorithm>
#include <csignal>
#include <string_view>

#include "formats/assimp/child.h"
#include "formats/converted.h"
#include "formats/format_list.h"
#include "formats/import_guard.h"
#include "formats/scene_file.h"

namespace tenebra::formats {
namespace {

namespace fs = std::filesystem;

/// The line at the front of `text`, which it takes away.
std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return line;
}

/// Without what would break a sentence: control characters and the stop at its end.
std::string quoted(std::string_view line) {
  constexpr std::size_t most = 200;
  std::string shown(line.substr(0, most));
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  while (shown.ends_with('.') || shown.ends_with(' ')) shown.pop_back();
  return shown.empty() ? "it does not say which" : shown;
}

void check_end(const ChildResult& result, const ChildLimits& limits, std::string_view way) {
  using End = ChildResult::End;
  constexpr int out_of_memory = 2;
  const bool stopped = result.end == End::signal && (result.number == SIGKILL || result.number == SIGXCPU);
  if (result.end == End::too_long)
    refuse("the converter (Assimp) took more than {} s, expected less: {}", limits.time.count() / 1000, way);
  if (result.end == End::too_much)
    refuse("the converter (Assimp) wrote more than {} MiB, expected a smaller scene: {}",
           limits.output_bytes >> 20, way);
  if (stopped)
    refuse("the converter (Assimp) was stopped for its time or memory, expected a smaller scene: {}", way);
  if (result.end == End::signal)
    refuse("the converter (Assimp) crashed (signal {}), expected a scene: copy the file again, or {}",
           result.number, way);
  if (result.number == out_of_memory)
    refuse("the converter (Assimp) ran out of the memory that it may use, expected a smaller scene: {}", way);
  std::string_view errors = result.errors;
  if (result.number != 0)
    refuse("Assimp found a fault ({}), expected a whole scene with triangles: copy it again, or {}",
           quoted(take_line(errors)), way);
  if (!result.output.starts_with("glTF"))
    refuse("the converter (Assimp) wrote something else than glTF, expected a scene: {}", way);
}

/// What the converter wrote beside the scene: sentences on what it left out, and the files that it read. What
/// was cut off ends without a line feed and is passed over.
void take_notes(std::string_view errors, const fs::path& file, const ImportOptions& options, Scene& scene) {
  constexpr std::string_view reads = "reads ";
  while (errors.find('\n') != std::string_view::npos) {
    const std::string_view line = take_line(errors);
    if (!line.starts_with(reads))
      scene.warnings.emplace_back(line);
    else if (options.files_read != nullptr && line.substr(reads.size()) != file.string())
      options.files_read->emplace_back(line.substr(reads.size()));
  }
}

Expected<Scene> convert(const fs::path& path, const ImportOptions& options, const Converter& converter) {
  const std::uintmax_t size = scene_file_size(path);
  const std::string_view way = way_to_gltf(path);
  if (converter.program.empty())
    refuse(
        "found no converter for '{}' (tenebra-assimp), expected it with the program: install libassimp-dev "
        "and build Tenebra again, or {}",
        path.extension().string(), way);
  // Links of folders are followed, one of the file is not: what it names lies beside the link.
  const fs::path file = fs::canonical(fs::absolute(path).parent_path()) / path.filename();
  const fs::path folder = options.root.empty() ? file.parent_path() : fs::canonical(options.root);
  const ChildLimits limits{std::min<std::uintmax_t>(converter.least_output + 32 * size, max_scene_file_bytes),
                           converter.least_time + std::chrono::milliseconds(size >> 9)};
  const ChildResult result = run_child(converter.program, {file.string(), folder.string()}, limits);
  check_end(result, limits, way);
  if (options.files_read != nullptr) options.files_read->push_back(path);
  auto scene = import_gltf_bytes(path, result.output, options);
  if (scene)
    take_notes(result.errors, file, options, *scene);
  else  // behind our sentence, which ends in a stop
    scene.error().message.replace(scene.error().message.size() - 1, 1, fmt::format(": {}.", way));
  return scene;
}

}  // namespace

Expected<Scene> import_converted(const fs::path& path, const ImportOptions& options,
                                 const Converter& converter) {
  return guarded_import(path, "a scene", [&] { return convert(path, options, converter); });
}

}  // namespace tenebra::formats
