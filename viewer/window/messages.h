// Sentences that the window shows, each for a while in a corner of the view.
#pragma once

#include <deque>
#include <string>

#include "window/panels/panels.h"

namespace tenebra::viewer {

class Messages {
public:
  using Wall = AnimationClock::Wall;

  void add(std::string text, bool failure, Wall now);
  /// True if one that was there is gone.
  bool forget_old(Wall now);
  bool empty() const { return messages_.empty(); }
  std::string newest() const { return empty() ? "" : messages_.back().text; }
  void draw(Area view, Marks& marks) const;

private:
  struct Message {
    std::string text;
    bool failure;
    Wall until;
  };
  std::deque<Message> messages_;
};

}  // namespace tenebra::viewer
