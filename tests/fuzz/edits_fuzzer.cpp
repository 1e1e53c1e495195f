// Edits of lights, materials and nodes from text, one a line: what is understood, written as text, is
// understood as the same.
#include <sstream>

#include "fuzz/input_file.h"
#include "settings/edit_texts.h"

namespace {

using namespace tenebra;
using namespace tenebra::settings;

tenebra::Expected<void> parse(const std::string& option, const std::string& value, stage::SceneEdits& edits) {
  if (option == "--set-light") return parse_light_edit(value, edits.lights);
  if (option == "--add-light") return parse_added_light(value, edits);
  if (option == "--set-material") return parse_material_edit(value, edits);
  return parse_node_edit(value, edits);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  constexpr const char* options[] = {"--set-light", "--add-light", "--set-material", "--set-node"};
  std::istringstream lines(std::string(reinterpret_cast<const char*>(bytes), size));
  stage::SceneEdits edits;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) (void)parse(options[static_cast<unsigned char>(line[0]) % 4], line.substr(1), edits);
  if (edits.lights.size() > 1000) return 0;
  stage::SceneEdits again;
  for (const EditOption& edit : edit_options(edits))
    if (!parse(edit.name, edit.value, again)) {
      std::fprintf(stderr, "written, but not read: %s %s\n", edit.name, edit.value.c_str());
      std::abort();
    }
  const std::vector<EditOption> first = edit_options(edits), second = edit_options(again);
  bool same = first.size() == second.size();
  for (std::size_t i = 0; same && i < first.size(); ++i) same = first[i].value == second[i].value;
  if (!same) std::abort();
  return 0;
}
