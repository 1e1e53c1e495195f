#include "window/messages.h"

#include <algorithm>

namespace tenebra::viewer {
namespace {

constexpr std::chrono::seconds stands_for{6};

}  // namespace

void Messages::add(std::string text, bool failure, Wall now) {
  messages_.push_back({std::move(text), failure, now + stands_for});
}

bool Messages::forget_old(Wall now) {
  const std::size_t before = messages_.size();
  while (!messages_.empty() && messages_.front().until < now) messages_.pop_front();
  return messages_.size() < before;
}

void Messages::draw(Area view, Marks& marks) const {
  float y = view.low.y + 10;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  for (const Message& message : messages_) {
    const float width = std::min(view.size.x - 20, 640.0f * ImGui::GetFontSize() / 15);
    const ImVec2 size = ImGui::CalcTextSize(message.text.c_str(), nullptr, false, width - 24);
    list.AddRectFilled({view.low.x + 10, y}, {view.low.x + 34 + size.x, y + size.y + 14}, palette::shade, 4);
    list.AddRectFilled({view.low.x + 10, y}, {view.low.x + 13, y + size.y + 14},
                       message.failure ? palette::warning : palette::accent);
    list.AddText(nullptr, 0, {view.low.x + 22, y + 7}, palette::text, message.text.c_str(), nullptr,
                 width - 24);
    y += size.y + 20;
    marks["message"] = {view.low.x + 10, view.low.y + 10, view.low.x + 34 + size.x, y};
  }
}

}  // namespace tenebra::viewer
