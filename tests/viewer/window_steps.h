// What tests of the window do again and again: save pictures and look at them, paste what was copied, leave.
#pragma once

#include "io/image.h"
#include "window_driver.h"

namespace tenebra::testing {

inline io::Image8 picture_of(const std::filesystem::path& file) {
  auto image = io::read_png(file);
  EXPECT_TRUE(image) << image.error().message;
  return image ? std::move(*image) : io::Image8{};
}

/// The screenshot that the keys ask for: "p" of the picture, "shift+p" of the window.
inline io::Image8 shot(const ViewSession& session, const std::string& keys = "p") {
  const std::size_t from = session.count();
  session.key(keys);
  return picture_of(session.wait_for_event(from, "shot").value("text", ""));
}

/// The arguments for `tenebra render` that the window copies.
inline std::string copied_arguments(const ViewSession& session) {
  const std::size_t from = session.count();
  session.key("ctrl+c");
  return session.wait_for_event(from, "copied").value("text", "");
}

/// What `tenebra render` makes of `scene` with arguments that were pasted into a shell.
inline io::Image8 pasted(const TemporaryFolder& folder, const std::string& scene,
                         const std::string& arguments) {
  const std::string file = folder / "pasted.png";
  const std::string command =
      fmt::format("exec '{}' render '{}' {} -o '{}' --quiet", TENEBRA_PROGRAM, scene, arguments, file);
  EXPECT_EQ(run_program({"/bin/sh", "-c", command}).errors, "") << arguments;
  return picture_of(file);
}

/// Ends the session as a user does. Nothing is on standard error.
inline void quit(const ViewSession& session) {
  session.key("ctrl+q");
  const auto result = session.wait();
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  session.expect_no_gl_errors();
}

}  // namespace tenebra::testing
