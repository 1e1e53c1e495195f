// Rules of views, accessors, primitives, and of the accessors of skins and animations.
#include <algorithm>
#include <set>

#include "formats/gltf_check/rule_report.h"

namespace tenebra::formats::rules {
namespace {

enum class Use { none, vertices, indices, other };

const char* name_of(Use use) {
  return use == Use::vertices ? "vertices" : use == Use::indices ? "indices" : "other data";
}

int components_of(const std::string& type) {
  static const std::map<std::string, int> counts = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                    {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
  const auto found = counts.find(type);
  return found == counts.end() ? 0 : found->second;
}

std::size_t component_bytes(std::size_t type) {
  return type == 5120 || type == 5121 ? 1 : type == 5122 || type == 5123 ? 2 : 4;
}

/// The numbers that an accessor's component type can hold.
std::pair<double, double> range_of(std::size_t type) {
  switch (type) {
    case 5120:
      return {-128, 127};
    case 5121:
      return {0, 255};
    case 5122:
      return {-32768, 32767};
    case 5123:
      return {0, 65535};
    case 5125:
      return {0, 4294967295.0};
    default:
      return {-3.5e38, 3.5e38};
  }
}

class Geometry {
public:
  Geometry(const Json& root, Report& report) : root_(root), report_(report) {
    for_each(root, "extensionsUsed", "",
             [&](const Json& name, const std::string&) { quantized_ |= name == "KHR_mesh_quantization"; });
    view_use_.resize(get(root, "bufferViews").size(), Use::none);
    accessor_use_.resize(get(root, "accessors").size(), nullptr);
    users_of_view_.resize(view_use_.size());
  }

  void run() {
    check_views();
    check_accessors();
    for_each(root_, "meshes", "", [&](const Json& mesh, const std::string& place) {
      for_each(mesh, "primitives", place + ".",
               [&](const Json& primitive, const std::string& at) { check_primitive(primitive, at); });
    });
    for_each(root_, "skins", "", [&](const Json& skin, const std::string& place) {
      use_other(index_in(skin, "inverseBindMatrices"), "inverse bind matrices",
                place + ".inverseBindMatrices");
    });
    check_animations();
    for_each(root_, "images", "", [&](const Json& image, const std::string& place) {
      if (const auto view = index_in(image, "bufferView")) use_view(*view, Use::other, place + ".bufferView");
    });
    check_shared_views();
  }

private:
  const Json& accessor(std::size_t i) const { return at(get(root_, "accessors"), i); }
  const Json& view(std::size_t i) const { return at(get(root_, "bufferViews"), i); }

  void check_views() {
    for_each(root_, "bufferViews", "", [&](const Json& view, const std::string& place) {
      const auto stride = index_in(view, "byteStride"), length = index_in(view, "byteLength");
      if (stride && length && *stride > *length) report_.add("found a byteStride above byteLength", place);
      const auto target = index_in(view, "target");
      if (target == 34962) view_use_[index_of(view)] = Use::vertices;
      if (target == 34963) view_use_[index_of(view)] = Use::indices;
    });
  }

  std::size_t index_of(const Json& view) const {
    return static_cast<std::size_t>(&view - &get(root_, "bufferViews")[0]);
  }

  void check_accessors() {
    for_each(root_, "accessors", "", [&](const Json& accessor, const std::string& place) {
      const std::size_t type = index_in(accessor, "componentType").value_or(0);
      const bool normalized = get(accessor, "normalized") == true;
      if (normalized && (type == 5126 || type == 5125))
        report_.add("found it normalized, expected that of bytes and shorts alone", place);
      if (index_in(accessor, "byteOffset") && !index_in(accessor, "bufferView"))
        report_.add("found a byteOffset without a bufferView", place);
      check_stated_bounds(accessor, type, place);
      check_matrix(accessor, place);
      const Json& sparse = get(accessor, "sparse");
      const auto indices = index_in(get(sparse, "indices"), "componentType");
      if (indices && *indices != 5121 && *indices != 5123 && *indices != 5125)
        report_.add("expected 5121, 5123 or 5125", place + ".sparse.indices.componentType");
      for (const char* part : {"indices", "values"})
        if (const auto used = index_in(get(sparse, part), "bufferView"))
          use_view(*used, Use::other, place + ".sparse." + part);
    });
  }

  void check_stated_bounds(const Json& accessor, std::size_t type, const std::string& place) {
    const int components = components_of(text_in(accessor, "type"));
    const auto [least, most] = range_of(type);
    for (const char* name : {"min", "max"}) {
      const Json& bounds = get(accessor, name);
      if (!bounds.is_array() || components == 0) continue;
      if (bounds.size() != static_cast<std::size_t>(components))
        report_.add("expected a number for each component", place + "." + name);
      for (const Json& bound : bounds) {
        if (!bound.is_number()) continue;
        const double value = bound.get<double>();
        const bool whole =
            type == 5126 ||
            value == static_cast<double>(static_cast<std::int64_t>(std::clamp(value, -1e15, 1e15)));
        if (value < least || value > most || !whole)
          report_.add("found a number that its component type cannot hold", place + "." + name);
      }
    }
  }

  void check_matrix(const Json& accessor, const std::string& place) {
    if (!text_in(accessor, "type").starts_with("MAT")) return;
    const auto used = index_in(accessor, "bufferView");
    const std::size_t offset = index_in(accessor, "byteOffset").value_or(0);
    const std::size_t of_view = used ? index_in(view(*used), "byteOffset").value_or(0) : 0;
    if (offset % 4 != 0 || (offset + of_view) % 4 != 0)
      report_.add("found matrices at an offset that is no multiple of 4", place);
  }

  void use_view(std::size_t index, Use use, const std::string& place) {
    if (index >= view_use_.size()) return;
    Use& before = view_use_[index];
    if (before != Use::none && before != use)
      report_.add(fmt::format("found a bufferView of {} used for {}", name_of(before), name_of(use)), place);
    if (before == Use::none) before = use;
    if (use == Use::other && index_in(view(index), "byteStride"))
      report_.add("found a bufferView with byteStride, expected one without", place);
  }

  /// `what` is a literal: the meaning of the accessor's numbers.
  void use_accessor(std::size_t index, Use use, const char* what, const std::string& place) {
    if (index >= accessor_use_.size()) return;
    const char*& before = accessor_use_[index];
    if (before && std::string_view(before) != what)
      report_.add(fmt::format("found an accessor of {} used for {}", before, what), place);
    if (!before) before = what;
    const auto used = index_in(accessor(index), "bufferView");
    if (used) use_view(*used, use, place);
    if (used && use == Use::vertices && *used < users_of_view_.size()) users_of_view_[*used].insert(index);
  }

  void use_other(std::optional<std::size_t> index, const char* what, const std::string& place) {
    if (index) use_accessor(*index, Use::other, what, place);
  }

  void check_animations() {
    for_each(root_, "animations", "", [&](const Json& animation, const std::string& place) {
      for_each(animation, "samplers", place + ".", [&](const Json& sampler, const std::string& at) {
        use_other(index_in(sampler, "input"), "key times", at + ".input");
        use_other(index_in(sampler, "output"), "key values", at + ".output");
      });
    });
  }

  void check_shared_views() {
    for (std::size_t i = 0; i < users_of_view_.size(); ++i)
      if (users_of_view_[i].size() > 1 && !index_in(view(i), "byteStride") && !is_compressed(i))
        report_.add("found several accessors of vertices and no byteStride",
                    fmt::format("bufferViews[{}]", i));
  }

  bool is_compressed(std::size_t view_index) const {
    return get(get(view(view_index), "extensions"), "EXT_meshopt_compression").is_object();
  }

  /// Vertices start at multiples of four bytes, one after the other.
  void check_alignment(const Json& accessor, const std::string& place) {
    const auto used = index_in(accessor, "bufferView");
    if (!used) return;
    const std::size_t offset = index_in(accessor, "byteOffset").value_or(0);
    const std::size_t of_view = index_in(view(*used), "byteOffset").value_or(0);
    const std::size_t element = component_bytes(index_in(accessor, "componentType").value_or(5126)) *
                                static_cast<std::size_t>(components_of(text_in(accessor, "type")));
    const std::size_t stride = index_in(view(*used), "byteStride").value_or(element);
    if (offset % 4 != 0 || (offset + of_view) % 4 != 0 || stride % 4 != 0)
      report_.add("found vertices that do not start at multiples of four bytes", place);
  }

  /// Whether the format of `accessor` is one that the specification allows for `semantic`.
  bool format_fits(const std::string& semantic, const Json& accessor) const {
    const std::string type = text_in(accessor, "type");
    const std::size_t component = index_in(accessor, "componentType").value_or(0);
    const bool normalized = get(accessor, "normalized") == true;
    const bool floats = component == 5126, unsigned_small = component == 5121 || component == 5123;
    const bool share = floats || (unsigned_small && normalized);
    if (component == 5125) return false;
    if (semantic.starts_with("JOINTS_")) return type == "VEC4" && unsigned_small && !normalized;
    if (semantic.starts_with("WEIGHTS_")) return type == "VEC4" && share;
    if (semantic.starts_with("COLOR_")) return (type == "VEC3" || type == "VEC4") && share;
    if (semantic.starts_with("TEXCOORD_")) return type == "VEC2" && (share || quantized_);
    if (semantic == "TANGENT") return type == "VEC4" && (floats || quantized_);
    if (semantic == "POSITION" || semantic == "NORMAL") return type == "VEC3" && (floats || quantized_);
    return true;
  }

  void check_attributes(const Json& attributes, bool of_target, const std::string& place) {
    std::map<std::string, std::set<std::string>> numbered;
    for (const auto& [name, value] : attributes.items()) {
      const auto index = index_in(attributes, name.c_str());
      if (!index) continue;
      const std::string at = place + "." + name;
      use_accessor(*index, Use::vertices, "vertices", at);
      check_alignment(accessor(*index), at);
      if (!of_target && !format_fits(name, accessor(*index)))
        report_.add("found an accessor of another format than its meaning allows", at);
      if (name == "POSITION" &&
          (!get(accessor(*index), "min").is_array() || !get(accessor(*index), "max").is_array()))
        report_.add("found no min and max, which are not needed here", at);
      for (const char* group : {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"})
        if (name.starts_with(group)) numbered[group].insert(name);
    }
    for (const auto& [group, names] : numbered)
      for (std::size_t i = 0; i < names.size(); ++i)
        if (!names.contains(fmt::format("{}{}", group, i))) {
          report_.add("expected their numbers to run from 0 without a gap", place + "." + group + "n");
          break;
        }
  }

  void check_primitive(const Json& primitive, const std::string& place) {
    const Json& attributes = get(primitive, "attributes");
    if (attributes.is_object() && attributes.empty()) report_.add("found no attributes", place);
    if (attributes.is_object()) check_attributes(attributes, false, place + ".attributes");
    if (const auto indices = index_in(primitive, "indices"))
      use_accessor(*indices, Use::indices, "indices", place + ".indices");
    for_each(primitive, "targets", place + ".", [&](const Json& target, const std::string& at) {
      if (!target.is_object()) return;
      if (target.empty()) report_.add("found no attributes", at);
      check_attributes(target, true, at);
      for (const auto& [name, value] : target.items()) {
        if (name.starts_with("_")) continue;
        if (!attributes.is_object() || !attributes.contains(name))
          report_.add("found a displacement of what the primitive does not have", at + "." + name);
        if (name != "POSITION" && name != "NORMAL" && name != "TANGENT" && !name.starts_with("TEXCOORD_") &&
            !name.starts_with("COLOR_"))
          report_.add("found an attribute that has no displacements", at + "." + name);
        const auto index = index_in(target, name.c_str());
        const bool vector = name == "POSITION" || name == "NORMAL" || name == "TANGENT";
        if (index && vector && !quantized_ &&
            (text_in(accessor(*index), "type") != "VEC3" ||
             index_in(accessor(*index), "componentType") != 5126))
          report_.add("found an accessor of another format, expected VEC3 of floats", at + "." + name);
      }
    });
    if (const auto material = index_in(primitive, "material"))
      check_texture_sets(at(get(root_, "materials"), *material), attributes, place);
  }

  /// Each texture of the material needs the coordinates that it names.
  void check_texture_sets(const Json& value, const Json& attributes, const std::string& place) {
    if (!value.is_object()) return;
    for (const auto& [name, child] : value.items()) {
      if (!child.is_object() || name == "extras") continue;
      if (name.ends_with("Texture") && index_in(child, "index")) {
        std::size_t set = index_in(child, "texCoord").value_or(0);
        const Json& transform = get(get(child, "extensions"), "KHR_texture_transform");
        set = index_in(transform, "texCoord").value_or(set);
        if (!attributes.is_object() || !attributes.contains(fmt::format("TEXCOORD_{}", set)))
          report_.add(fmt::format("found no TEXCOORD_{}, which its material's {} needs", set, name), place);
      }
      check_texture_sets(child, attributes, place);
    }
  }

  const Json& root_;
  Report& report_;
  bool quantized_ = false;
  std::vector<Use> view_use_;
  std::vector<const char*> accessor_use_;             ///< null: none yet
  std::vector<std::set<std::size_t>> users_of_view_;  ///< accessors of vertices
};

}  // namespace

void check_geometry_rules(const Json& root, Report& report) {
  Geometry(root, report).run();
}

}  // namespace tenebra::formats::rules
