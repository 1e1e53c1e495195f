#include "commands/done_list.h"

#include <fmt/format.h>

#include "base/fail.h"
#include "commands/render_identity.h"

namespace tenebra::viewer {
namespace {

constexpr const char* header = "frame";
constexpr int tries = 100;

Expected<render::LogPast> past_of(const base::Journal& file) {
  const auto text = file.read();
  if (!text) return tl::unexpected(text.error());
  return render::parse_log(*text, header);
}

}  // namespace

std::optional<std::filesystem::path> DoneList::path_of(const RenderOptions& options) {
  std::optional<OutputPattern> first = options.pictures.files;
  for (const auto* patterns :
       {&options.masks, &options.mask_colours, &options.mask_means, &options.mask_samples})
    if (!first && !patterns->empty()) first = patterns->front();
  if (!first) return {};
  const std::filesystem::path pattern(first->text());
  return first->file(0).parent_path() / ("." + pattern.filename().string() + ".done");
}

Expected<void> check_same_identity(const std::filesystem::path& path, const render::LogPast& past,
                                   std::span<const render::LogSetting> identity) {
  const auto difference = first_difference(identity_of(past.settings), identity);
  if (!difference) return {};
  return base::fail("cannot go on with {}: expected {}", path.string(), *difference);
}

Expected<DoneList> DoneList::open(const std::filesystem::path& path,
                                  std::span<const render::LogSetting> identity, bool resume) {
  for (int i = 0; i < tries; ++i) {
    auto file = base::Journal::open(path, base::Journal::Writers::many);
    if (!file) return tl::unexpected(file.error());
    const auto past = past_of(*file);
    if (!past) return tl::unexpected(past.error());
    const auto same = check_same_identity(path, *past, identity);
    if (past->has_header && !same && (resume || !file->is_alone())) return tl::unexpected(same.error());
    const bool goes_on = past->has_header && same;
    if (!goes_on && file->is_alone())
      if (auto begun = file->begin(render::log_head(identity, header)); !begun)
        return tl::unexpected(begun.error());
    // Who comes in before it is shared may begin it in another way.
    const bool shared = file->share();
    const auto now = past_of(*file);
    if (!now) return tl::unexpected(now.error());
    if (shared && now->has_header && check_same_identity(path, *now, identity))
      return DoneList(std::move(*file), goes_on ? past->frames : std::vector<int>());
  }
  return base::fail("cannot write {}: other processes begin it again and again", path.string());
}

Expected<void> DoneList::add(int frame) {
  return file_.append(fmt::format("{:010}\n", frame));
}

}  // namespace tenebra::viewer
