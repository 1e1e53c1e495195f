// Rules of nodes, scenes and skins that need the tree.
#include <algorithm>
#include <set>

#include "formats/gltf_check/rule_report.h"

namespace tenebra::formats::rules {
namespace {

constexpr std::size_t most_steps = 20'000'000;  // a file that needs more is not judged

struct Tree {
  std::vector<int> parents, roots;
  bool whole = true;  ///< no loop, each node with one parent

  explicit Tree(const Json& root) : parents(get(root, "nodes").size(), -1), roots(parents.size(), -1) {
    for (std::size_t i = 0; i < parents.size(); ++i)
      for (const Json& child : get(at(get(root, "nodes"), i), "children")) {
        if (!child.is_number_unsigned() || child.get<std::size_t>() >= parents.size()) continue;
        int& parent = parents[child.get<std::size_t>()];
        whole &= parent < 0;
        parent = static_cast<int>(i);
      }
    std::vector<std::size_t> path;
    for (std::size_t i = 0; whole && i < parents.size(); ++i) {
      path.clear();
      std::size_t node = i;
      while (roots[node] < 0 && parents[node] >= 0 && whole) {
        path.push_back(node);
        node = static_cast<std::size_t>(parents[node]);
        whole = path.size() <= parents.size();
      }
      const int top = roots[node] < 0 ? static_cast<int>(node) : roots[node];
      roots[node] = top;
      for (const std::size_t passed : path) roots[passed] = top;
    }
  }

  bool is_above(std::size_t above, std::size_t node, std::size_t& steps) const {
    for (int n = static_cast<int>(node); n >= 0 && steps < most_steps; ++steps) {
      if (static_cast<std::size_t>(n) == above) return true;
      n = parents[static_cast<std::size_t>(n)];
    }
    return steps >= most_steps;
  }
};

void check_skins(const Json& root, const Tree& tree, Report& report) {
  std::size_t steps = 0;
  for_each(root, "skins", "", [&](const Json& skin, const std::string& place) {
    const auto skeleton = index_in(skin, "skeleton");
    if (!skeleton || *skeleton >= tree.parents.size()) return;
    for (const Json& joint : get(skin, "joints")) {
      if (!joint.is_number_unsigned() || joint.get<std::size_t>() >= tree.parents.size()) continue;
      if (tree.is_above(*skeleton, joint.get<std::size_t>(), steps)) continue;
      report.add("found a node that is not above all joints", place + ".skeleton");
      return;
    }
  });
}

/// A node with a skin is in the scenes of the skin's joints.
void check_scenes_of_skins(const Json& root, const Tree& tree, Report& report) {
  std::set<std::pair<int, int>> wanted;  // root of the node, root of the joints
  for_each(root, "nodes", "", [&](const Json& node, const std::string& place) {
    const auto skin = index_in(node, "skin");
    if (get(node, "weights").is_array() && !index_in(node, "mesh"))
      report.add("found weights without a mesh", place);
    if (!get(node, "matrix").is_null())
      for (const char* part : {"translation", "rotation", "scale"})
        if (!get(node, part).is_null())
          report.add("found a matrix beside translation, rotation or scale, which are not read", place);
    if (!skin) return;
    const Json& joint = at(get(at(get(root, "skins"), *skin), "joints"), 0);
    if (!joint.is_number_unsigned() || joint.get<std::size_t>() >= tree.roots.size()) return;
    const auto self = static_cast<std::size_t>(&node - &get(root, "nodes")[0]);
    wanted.insert({tree.roots[self], tree.roots[joint.get<std::size_t>()]});
  });
  std::size_t steps = 0;
  for_each(root, "scenes", "", [&](const Json& scene, const std::string& place) {
    if (wanted.empty() || (steps += wanted.size()) > most_steps) return;
    std::set<int> roots;
    for (const Json& node : get(scene, "nodes"))
      if (node.is_number_unsigned() && node.get<std::size_t>() < tree.roots.size())
        roots.insert(node.get<int>());
    for (const auto& [node, joints] : wanted)
      if (roots.contains(node) && !roots.contains(joints))
        report.add("found a node with a skin whose joints are in another scene", place);
  });
}

}  // namespace

void check_tree_rules(const Json& root, Report& report) {
  if (!get(root, "nodes").is_array()) return;
  const Tree tree(root);
  if (!tree.whole) return;  // refused by build_nodes
  check_skins(root, tree, report);
  check_scenes_of_skins(root, tree, report);
}

}  // namespace tenebra::formats::rules
