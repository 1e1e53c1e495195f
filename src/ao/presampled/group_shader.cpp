#include "ao/presampled/group_shader.h"

#include <algorithm>

#include "base/sort_unique.h"

namespace tenebra::ao {

void GroupShader::shade(const ReceiverSet& set, AoPart part, int group, std::span<float> values,
                        GroupReport& report) {
  set.receivers(group, receivers_);
  if (receivers_.empty()) return;
  own_.assign(receivers_.size(), 0.0f);
  others_.assign(receivers_.size(), 0.0f);
  mixed_.clear();
  near_.clear();
  if (part != AoPart::others) find_own(report);
  if (part != AoPart::own) find_near(report);
  if (!report.complete()) return;
  for (const std::size_t i : mixed_) {
    const Receiver& receiver = receivers_[i];
    own_[i] = bodies_->body(bodies_->number(receiver.owner.object)).look(receiver.on_shape(), kernels_);
  }
  if (!near_.empty()) cast_others(report);
  for (std::size_t i = 0; i < receivers_.size(); ++i)
    values[receivers_[i].index] = (1 - own_[i]) * (1 - others_[i]);
  report.points = receivers_.size();
}

void GroupShader::find_own(GroupReport& report) {
  std::int32_t object = TriangleOwner::deforming;
  int number = -1;
  const SelfOcclusion* body = nullptr;
  for (std::size_t i = 0; i < receivers_.size(); ++i) {
    const Receiver& receiver = receivers_[i];
    if (receiver.owner.object != object) {
      object = receiver.owner.object;
      number = bodies_->number(object);
      body = number < 0 || !bodies_->body(number).ready() ? nullptr : &bodies_->body(number);
      if (body == nullptr && bodies_->exists(object)) report.bodies.push_back(object);
      if (body != nullptr) report.own.push_back(number);
    }
    if (body == nullptr) continue;
    const SelfOcclusion::Answer answer = body->find(receiver.on_shape(), missing_);
    own_[i] = answer.occlusion;
    if (answer.state == SelfOcclusion::State::mixed) mixed_.push_back(i);
    for (const std::uint64_t sample : missing_)
      report.samples.push_back({static_cast<std::uint32_t>(number), sample});
    missing_.clear();
  }
  base::sort_unique(report.samples);
}

/// Leaves those of near_ that some receiver is in reach of, with a row of reached_ each.
void GroupShader::find_near(GroupReport& report) {
  math::Box<double> box;
  for (const Receiver& receiver : receivers_) box.add(receiver.position);
  occluders_->casters().near(box, near_);
  const std::size_t count = receivers_.size();
  reached_.resize(near_.size() * count);
  std::size_t kept = 0;
  for (const int occluder : near_) {
    if (!occluders_->reaches(occluder, receivers_, &reached_[kept * count])) continue;
    near_[kept++] = occluder;
    if (!occluders_->ready(occluder)) report.occluders.push_back(occluder);
  }
  near_.resize(kept);
  report.reached = near_;
}

/// A few receivers at a time, so that their rays stay in the cache while each occluder is asked for all.
void GroupShader::cast_others(GroupReport& report) {
  constexpr std::size_t most_batches = 64;
  const std::size_t count = receivers_.size(), batches = rays_->batches();
  asked_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    bool any = false;
    for (std::size_t n = 0; n < near_.size(); ++n) any |= reached_[n * count + i] != 0;
    if (any) asked_.push_back(i);
  }
  const std::size_t at_once = std::max<std::size_t>(1, most_batches / batches);
  for (std::size_t first = 0; first < asked_.size(); first += at_once) {
    const auto asked = std::span(asked_).subspan(first, std::min(at_once, asked_.size() - first));
    batches_.resize(asked.size() * batches);
    distances_.assign(asked.size() * batches * trees::batch_size, rays_->reach());
    for (std::size_t k = 0; k < asked.size(); ++k)
      rays_->spread(receivers_[asked[k]], &batches_[k * batches]);
    meet_near(asked, report);
    for (std::size_t k = 0; k < asked.size(); ++k)
      others_[asked[k]] = rays_->hidden(&distances_[k * batches * trees::batch_size]);
  }
}

/// Occluder by occluder, for runs of receivers that it reaches.
void GroupShader::meet_near(std::span<const std::size_t> asked, GroupReport& report) {
  const std::size_t batches = rays_->batches();
  for (std::size_t n = 0; n < near_.size(); ++n) {
    const std::uint8_t* reached = &reached_[n * receivers_.size()];
    const auto owner = [&](std::size_t k) { return receivers_[asked[k]].owner.object; };
    for (std::size_t first = 0, last = 0; first < asked.size(); first = last) {
      last = first + 1;
      if (reached[asked[first]] == 0) continue;
      while (last < asked.size() && reached[asked[last]] != 0 && owner(last) == owner(first)) ++last;
      occluders_->meet(near_[n], owner(first),
                       std::span(batches_).subspan(first * batches, (last - first) * batches),
                       &distances_[first * batches * trees::batch_size], report.counts);
    }
  }
}

}  // namespace tenebra::ao
