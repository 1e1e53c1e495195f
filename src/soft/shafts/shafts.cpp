#include "soft/shafts/shafts.h"

#include <algorithm>
#include <deque>
#include <vector>

#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "soft/groups/receivers.h"
#include "soft/memory/memory_bound.h"
#include "soft/shafts/shaft_kernels.h"

namespace tenebra::soft {

namespace {

// Nodes of fewer groups pass on their list unchanged: culling pays from here on (measured).
constexpr std::uint32_t fewest_groups = 3;

// So do nodes with more than this part of the groups that the last cull was for: a cull at each level
// of the tree would drop only a third of the triangles, one at every second level drops half.
constexpr double most_groups = 0.4;

// Points times triangles up to which a subtree is not worth sharing out among threads.
constexpr std::uint64_t serial_work = 1 << 16;

// Candidates of a group from which on they are counted from its middle, too: worth_sampling asks for no
// fewer.
constexpr std::size_t worth_counting = 64;

// A thread that keeps more candidates than these, 16 MB, hands its families over before all are decided.
// Where the memory is bounded, all threads together keep their share of it (vectors that grow hold up to
// three times what is used).
std::size_t most_ids(const SoftShadowConfig& config) {
  constexpr std::size_t most = std::size_t{1} << 22;
  if (!config.memory_bytes) return most;
  const std::size_t threads = static_cast<std::size_t>(thread_count());
  return std::min(most, *config.memory_bytes / share_of_lists / (3 * sizeof(std::uint32_t) * threads));
}

// A GroupDecision whose candidates may still move, as long as others are added behind them.
struct Decided {
  const PointGroup* group;
  GroupClass kind;
  std::size_t ids_begin, ids_end;  ///< of its candidates, among those of the thread
  std::uint32_t from_middle;
};

struct Family {
  int thread;
  std::size_t begin, end;  ///< of its groups, among those that the thread decided
  std::uint64_t work;      ///< points times candidates
};

// What one thread uses. A thread that waits for a subtree may begin another on top of it: lists are a stack.
struct alignas(64) ThreadScratch {
  std::deque<BlockList> lists;
  std::size_t lists_used = 0;
  std::vector<std::uint32_t> ids;  ///< candidates of the groups decided so far
  std::vector<Decided> decided;
  std::vector<Family> families;
  std::vector<GroupDecision> family;  ///< the one at hand
  ShaftStats stats;

  void forget() { ids.clear(), decided.clear(), families.clear(); }
};

// A list from the thread's stack, given back with its end.
class ListLease {
public:
  explicit ListLease(ThreadScratch& scratch) : scratch_(scratch) {
    if (scratch.lists_used == scratch.lists.size()) scratch.lists.emplace_back();
    list_ = &scratch.lists[scratch.lists_used++];
  }
  ~ListLease() { --scratch_.lists_used; }
  ListLease(const ListLease&) = delete;
  ListLease& operator=(const ListLease&) = delete;
  BlockList& operator*() const { return *list_; }
  BlockList* operator->() const { return list_; }

private:
  ThreadScratch& scratch_;
  BlockList* list_;
};

void count(const GroupDecision& decision, ShaftStats& s) {
  const std::size_t points = decision.group->count, candidates = decision.candidates.size();
  switch (decision.kind) {
    case GroupClass::lit:
      ++s.groups_lit, s.points_lit += points;
      break;
    case GroupClass::dark:
      ++s.groups_dark, s.points_dark += points;
      break;
    case GroupClass::mixed:
      ++s.groups_mixed, s.points_mixed += points;
      s.candidates += candidates;
      s.most_candidates = std::max<std::uint64_t>(s.most_candidates, candidates);
      break;
  }
}

void add(ShaftStats& to, const ShaftStats& from) {
  to.groups_lit += from.groups_lit, to.points_lit += from.points_lit;
  to.groups_dark += from.groups_dark, to.points_dark += from.points_dark;
  to.groups_mixed += from.groups_mixed, to.points_mixed += from.points_mixed;
  to.candidates += from.candidates;
  to.most_candidates = std::max(to.most_candidates, from.most_candidates);
  to.seconds += from.seconds;
}

// One call of for_each_family: decide() on all, then hand_over().
class Descent {
public:
  Descent(const PointGroups& groups, const LightShape& light, const ShaftKernels& kernels,
          ShaftMaker make_shaft, bool counts_from_middle, const StopFlag* stop, const FamilyBody& body,
          std::optional<std::span<const std::uint32_t>> chosen, std::size_t most_kept,
          std::vector<ThreadScratch>& scratch)
      : groups_(groups),
        light_(light),
        kernels_(kernels),
        make_shaft_(make_shaft),
        counts_from_middle_(counts_from_middle),
        stop_(stop),
        body_(body),
        chosen_(chosen),
        most_kept_(most_kept),
        scratch_(scratch) {}

  /// `from`: what may matter to the node, found for a node of `groups` groups.
  void decide(const GroupNode& node, const BlockList& from, std::uint32_t groups);

  /// The decided groups, those with most work first; `families`: room for them.
  void hand_over(std::vector<Family>& families);

private:
  bool any_chosen(std::uint32_t first, std::uint32_t count) const;
  const BlockList& narrowed(const GroupNode& node, const BlockList& from, std::uint32_t& groups,
                            BlockList& list) const;
  void decide_family(const GroupNode& node, const BlockList& from, std::uint32_t groups,
                     ThreadScratch& scratch);
  void decide_all(const GroupNode& node, const BlockList& from, std::uint32_t groups, ThreadScratch& scratch);
  void decide_group(const PointGroup& group, const BlockList& from, ThreadScratch& scratch);
  std::uint32_t cull(const PointGroup& group, const BlockList& from, BlockList& list) const;
  std::uint32_t count_from_middle(const PointGroup& group, const BlockList& list,
                                  ThreadScratch& scratch) const;
  void hand_over_kept(ThreadScratch& scratch);
  void hand_over(const Family& family);

  const PointGroups& groups_;
  const LightShape& light_;
  const ShaftKernels& kernels_;
  ShaftMaker make_shaft_;
  bool counts_from_middle_;
  const StopFlag* stop_;
  const FamilyBody& body_;
  std::optional<std::span<const std::uint32_t>> chosen_;  ///< groups, ascending
  std::size_t most_kept_;                                 ///< candidates, by one thread
  std::vector<ThreadScratch>& scratch_;
};

void filter(BlockList& list, const BlockList& from, auto&& kernel) {
  list.refs.resize(from.refs.size());
  list.blocks = from.blocks;
  list.refs.resize(kernel(list.blocks, std::span<const BlockRef>(from.refs), list.refs.data()));
}

bool worth_sharing(const GroupNode& node, const BlockList& list) {
  return node.points * (block_size * list.refs.size() + 1) > serial_work;
}

bool Descent::any_chosen(std::uint32_t first, std::uint32_t count) const {
  if (!chosen_) return true;
  const auto next = std::lower_bound(chosen_->begin(), chosen_->end(), first);
  return next != chosen_->end() && *next - first < count;
}

// The part of `from` that matters to this node: `from` itself, which was found for a node of `groups` groups,
// or `list`; then `groups` becomes the number of groups of this node.
const BlockList& Descent::narrowed(const GroupNode& node, const BlockList& from, std::uint32_t& groups,
                                   BlockList& list) const {
  if (from.refs.empty() || node.count < fewest_groups || node.count > most_groups * groups) return from;
  const Shaft shaft = make_shaft_(box_cell(node.low, node.high, light_), light_);
  filter(list, from, [&](auto... rest) { return kernels_.cull(shaft, rest...); });
  list.compact();
  groups = node.count;
  return list;
}

void Descent::decide(const GroupNode& node, const BlockList& from, std::uint32_t groups) {
  if (stop_requested(stop_) || !any_chosen(node.first, node.count)) return;
  ThreadScratch& scratch = scratch_[static_cast<std::size_t>(parallel::thread_index())];
  base::Stopwatch watch;
  if (node.count <= largest_family || (from.refs.empty() && !worth_sharing(node, from))) {
    decide_family(node, from, groups, scratch);
    scratch.stats.seconds += watch.lap_ms() * 1e-3;
    if (scratch.ids.size() > most_kept_) hand_over_kept(scratch);
    return;
  }
  const ListLease own(scratch);
  const BlockList& list = narrowed(node, from, groups, *own);
  scratch.stats.seconds += watch.lap_ms() * 1e-3;
  const GroupNode* children = &groups_.nodes[node.children];
  if (worth_sharing(node, list)) {
    parallel::parallel_tasks(2, [&](int k) { decide(children[k], list, groups); });
  } else {
    decide(children[0], list, groups);
    decide(children[1], list, groups);
  }
}

void Descent::decide_family(const GroupNode& node, const BlockList& from, std::uint32_t groups,
                            ThreadScratch& scratch) {
  Family family{parallel::thread_index(), scratch.decided.size(), 0, 0};
  decide_all(node, from, groups, scratch);
  family.end = scratch.decided.size();
  for (std::size_t i = family.begin; i < family.end; ++i) {
    const Decided& d = scratch.decided[i];
    family.work += d.group->count * static_cast<std::uint64_t>(d.ids_end - d.ids_begin);
  }
  scratch.families.push_back(family);
}

void Descent::decide_all(const GroupNode& node, const BlockList& from, std::uint32_t groups,
                         ThreadScratch& scratch) {
  if (!any_chosen(node.first, node.count)) return;
  if (from.refs.empty() || node.count < fewest_groups) {
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (any_chosen(i, 1)) decide_group(groups_.groups[i], from, scratch);
    return;
  }
  const ListLease own(scratch);
  const BlockList& list = narrowed(node, from, groups, *own);
  decide_all(groups_.nodes[node.children], list, groups, scratch);
  decide_all(groups_.nodes[node.children + 1], list, groups, scratch);
}

void Descent::decide_group(const PointGroup& group, const BlockList& from, ThreadScratch& scratch) {
  if (stop_requested(stop_)) return;
  const std::size_t before = scratch.ids.size();
  GroupClass kind = GroupClass::lit;
  std::uint32_t from_middle = 0;
  if (!from.refs.empty()) {
    const ListLease list(scratch);
    const std::uint32_t dark = cull(group, from, *list);
    if (dark != no_triangle) {
      kind = GroupClass::dark;
      scratch.ids.push_back(dark);
    } else {
      list->append_ids(scratch.ids);
      if (scratch.ids.size() > before) kind = GroupClass::mixed;
      if (counts_from_middle_ && scratch.ids.size() - before >= worth_counting)
        from_middle = count_from_middle(group, *list, scratch);
    }
  }
  scratch.decided.push_back({&group, kind, before, scratch.ids.size(), from_middle});
}

std::uint32_t Descent::count_from_middle(const PointGroup& group, const BlockList& list,
                                         ThreadScratch& scratch) const {
  const ListLease left(scratch);
  const Cell middle{group.cell.centre, {}, group.cell.slack, group.cell.reach};
  const Shaft shaft = make_shaft_(middle, light_);
  filter(*left, list, [&](auto... rest) { return kernels_.cull(shaft, rest...); });
  return static_cast<std::uint32_t>(left->triangle_count());
}

// Leaves in `list` what may block a line from the group; returns the triangle that blocks all, if one does.
std::uint32_t Descent::cull(const PointGroup& group, const BlockList& from, BlockList& list) const {
  const Shaft shaft = make_shaft_(group.cell, light_);
  filter(list, from, [&](auto... rest) { return kernels_.cull(shaft, rest...); });
  if (list.refs.empty()) return no_triangle;
  const auto receivers = groups_.receivers_of(group);
  filter(list, list, [&](auto... rest) { return kernels_.drop_behind(receivers, light_, rest...); });
  const ContactRange contact = contact_range(receivers);
  std::uint32_t dark = no_triangle;
  filter(list, list, [&](auto... rest) { return kernels_.drop_beside(shaft, contact, rest..., dark); });
  for (const Receiver& receiver : receivers)
    if (receiver.triangle == dark) return no_triangle;
  return dark;
}

void Descent::hand_over(std::vector<Family>& families) {
  families.clear();
  for (const ThreadScratch& scratch : scratch_)
    families.insert(families.end(), scratch.families.begin(), scratch.families.end());
  std::sort(families.begin(), families.end(), [](const Family& a, const Family& b) {
    if (a.work != b.work) return a.work > b.work;
    return a.thread != b.thread ? a.thread < b.thread : a.begin < b.begin;
  });
  parallel::parallel_in_order(static_cast<int>(families.size()),
                              [&](int i) { hand_over(families[static_cast<std::size_t>(i)]); });
}

void Descent::hand_over_kept(ThreadScratch& scratch) {
  for (const Family& family : scratch.families) hand_over(family);
  scratch.forget();
}

void Descent::hand_over(const Family& family) {
  if (stop_requested(stop_)) return;
  const ThreadScratch& from = scratch_[static_cast<std::size_t>(family.thread)];
  ThreadScratch& own = scratch_[static_cast<std::size_t>(parallel::thread_index())];
  own.family.clear();
  for (std::size_t i = family.begin; i < family.end; ++i) {
    const Decided& d = from.decided[i];
    const std::span<const std::uint32_t> ids(from.ids.data() + d.ids_begin, d.ids_end - d.ids_begin);
    own.family.push_back({d.group, d.kind, ids, d.from_middle});
    count(own.family.back(), own.stats);
  }
  body_(own.family, parallel::thread_index());
}

}  // namespace

struct ShaftCuller::State {
  BlockList casters;
  std::vector<ThreadScratch> scratch;
  std::vector<Family> families;
  ShaftStats stats;
};

ShaftCuller::ShaftCuller() : state_(std::make_unique<State>()) {}
ShaftCuller::ShaftCuller(ShaftCuller&&) noexcept = default;
ShaftCuller& ShaftCuller::operator=(ShaftCuller&&) noexcept = default;
ShaftCuller::~ShaftCuller() = default;
const ShaftStats& ShaftCuller::stats() const {
  return state_->stats;
}

bool ShaftCuller::for_each_family(const PointGroups& groups, const TriangleView& triangles,
                                  const AreaLight& area_light, const SoftShadowConfig& config,
                                  const StopFlag* stop, const FamilyBody& body,
                                  std::optional<std::span<const std::uint32_t>> chosen) {
  State& s = *state_;
  s.stats = {};
  const parallel::FloatEnvironment ieee;
  base::Stopwatch watch;
  const LightShape light(area_light);
  gather_casters(triangles, s.casters);
  s.scratch.resize(std::max(s.scratch.size(), static_cast<std::size_t>(thread_count())));
  for (ThreadScratch& scratch : s.scratch) scratch.stats = {}, scratch.forget();
  s.stats.seconds = watch.lap_ms() * 1e-3;
  const ShaftKernels kernels = shaft_kernels(config.simd);
  if (!groups.nodes.empty()) {
    Descent descent(groups, light, kernels, shaft_maker(config.simd), config.error_255 > 0, stop, body,
                    chosen, most_ids(config), s.scratch);
    descent.decide(groups.nodes[0], s.casters, groups.nodes[0].count);
    descent.hand_over(s.families);
  }
  for (const ThreadScratch& scratch : s.scratch) add(s.stats, scratch.stats);
  return !stop_requested(stop);
}

}  // namespace tenebra::soft
