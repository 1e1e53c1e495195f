// The dialog that opens a scene: recent files, and the files of a folder.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "window/files/folder_list.h"

namespace tenebra::viewer {

/// Its state while it is open.
struct OpenDialog {
  FolderList list;
  std::string problem;            ///< why a folder is not listed
  std::array<char, 512> typed{};  ///< filters the names; with a slash it is a path
  int chosen = 0;                 ///< of the rows that are shown
  bool fresh = true;              ///< the first frame: takes the keyboard
  int turn = 0;                   ///< folders entered: each has a field of its own to type in
};

/// Opened at `folder`, or where that is none, at the working folder.
OpenDialog open_dialog_at(const std::string& folder);

}  // namespace tenebra::viewer
