// The frames of a render whose files are there, kept beside them: what --resume goes by.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "io/journal.h"
#include "options/render_options.h"
#include "render/log/frame_log.h"

namespace tenebra::viewer {

/// A file of comments "# name: value", which say how the frames were made, a header line "frame,files", and a
/// line for each frame with the hash of what its files hold. Any number of processes may add to it; all of
/// them must make frames in the same way.
class DoneList {
public:
  using Frames = std::map<int, std::string>;  ///< the hash of a frame's files, as it was last added

  /// ".%04d.png.done" beside the pictures, else beside the first masks; none without either.
  static std::optional<std::filesystem::path> path_of(const RenderOptions& options);

  /// The list for frames made in that way. A list of frames made in another way is begun anew, unless it is
  /// to be resumed or another process adds to it: then it fails with the setting that differs.
  static Expected<DoneList> open(const std::filesystem::path& path,
                                 std::span<const render::LogSetting> identity, bool resume);

  const Frames& frames() const { return frames_; }  ///< as it was found
  Expected<void> add(int frame, const std::string& files_hash);
  Expected<void> finish() { return file_.finish(); }

private:
  DoneList(io::Journal file, Frames frames) : file_(std::move(file)), frames_(std::move(frames)) {}

  io::Journal file_;
  Frames frames_;
};

/// Fails, with the setting that differs, if what `past` holds was made in another way.
Expected<void> check_same_identity(const std::filesystem::path& path, const render::LogPast& past,
                                   std::span<const render::LogSetting> identity);

}  // namespace tenebra::viewer
