#include "commands/done_list.h"

#include <fmt/format.h>

#include <charconv>

#include "base/fail.h"
#include "commands/render_identity.h"

namespace tenebra::viewer {
namespace {

constexpr const char* header = "frame,files";
constexpr int tries = 100;

/// What a list holds.
struct DonePast {
  render::LogPast log;
  DoneList::Frames frames;
};

/// A line that a kill cut short, with what another process wrote behind it, is no frame, or its hash is that
/// of no files.
DoneList::Frames frames_of(std::string_view text) {
  DoneList::Frames frames;
  for (std::size_t end = 0; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1)) {
    const std::string_view line = text.substr(0, end);
    const std::size_t comma = line.find(',');
    int frame = 0;
    if (comma == std::string_view::npos) continue;
    const auto read = std::from_chars(line.data(), line.data() + comma, frame);
    if (read.ec == std::errc() && read.ptr == line.data() + comma) frames[frame] = line.substr(comma + 1);
  }
  return frames;
}

Expected<DonePast> past_of(const io::Journal& file) {
  const auto text = file.read();
  if (!text) return tl::unexpected(text.error());
  return DonePast{render::parse_log(*text, header), frames_of(*text)};
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
    auto file = io::Journal::open(path, io::Journal::Writers::many);
    if (!file) return tl::unexpected(file.error());
    const auto past = past_of(*file);
    if (!past) return tl::unexpected(past.error());
    const auto same = check_same_identity(path, past->log, identity);
    if (past->log.has_header && !same && (resume || !file->is_alone())) return tl::unexpected(same.error());
    const bool goes_on = past->log.has_header && same;
    if (!goes_on && file->is_alone())
      if (auto begun = file->begin(render::log_head(identity, header)); !begun)
        return tl::unexpected(begun.error());
    // Another process that opens it before it is shared may begin it in another way.
    const bool shared = file->share();
    const auto now = past_of(*file);
    if (!now) return tl::unexpected(now.error());
    if (shared && now->log.has_header && check_same_identity(path, now->log, identity))
      return DoneList(std::move(*file), goes_on ? past->frames : Frames());
  }
  return base::fail("cannot write {}: other processes begin it again and again", path.string());
}

Expected<void> DoneList::add(int frame, const std::string& files_hash) {
  return file_.append(fmt::format("{:010},{}\n", frame, files_hash));
}

}  // namespace tenebra::viewer
