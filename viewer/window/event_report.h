// What happened in a session, one JSON object per line: for tests and scripts that drive the viewer.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include <tenebra/expected.h>
#include "window/panels/ui.h"

namespace tenebra::viewer {

/// Each line is out when the call returns. Without a file every call does nothing.
class EventReport {
public:
  static Expected<EventReport> create(const std::string& path);  ///< "": none

  bool is_on() const { return file_ != nullptr; }
  void opened(const std::string& file, const session::StagedScene& scene);
  void request(const FrameRequest& request);
  void picture(const Picture& picture, std::uint64_t number);
  void explained(const PictureAnswer& answer);
  void state(const ViewState& state);  ///< where it differs from the last
  void marks(const Marks& marks);      ///< the same
  void note(const char* event, const std::string& text);

private:
  struct Close {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
  };
  void line(const std::string& text);

  std::unique_ptr<std::FILE, Close> file_;
  std::string last_state_;
  std::string last_marks_;
};

}  // namespace tenebra::viewer
