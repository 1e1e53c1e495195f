#include "formats/aff/reader.h"

#include "base/fail.h"

#include <fmt/core.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace tenebra::formats {
namespace {

constexpr std::size_t deepest_include = 64;
constexpr std::size_t deepest_block = 1024;
constexpr std::size_t most_includes = 1'000'000;

/// Includes may repeat a file: text read again is limited, so that no small file takes endless time...
constexpr std::uint64_t free_expanded_bytes = 128u << 20;
constexpr std::uint64_t expanded_per_byte = 4;
/// ... and so is what is made of it (import_scene.h promises 256 MiB and 20 times the files' size).
constexpr std::uint64_t free_scene_bytes = 160u << 20;
constexpr std::uint64_t scene_per_byte = 14;

glm::vec3 read_color(AffLexer& in) {
  return glm::vec3(in.look_vector("a value of a colour"));
}

}  // namespace

struct AffReader::Directive {
  std::string_view keyword;
  void (AffReader::*read)(AffLexer&);
};

const AffReader::Directive AffReader::directives[] = {
    {"m", &AffReader::read_mesh},
    {"p", &AffReader::read_polygon},
    {"pp", &AffReader::read_polygon_with_normals},
    {"tt", &AffReader::read_textured_triangle},
    {"ttp", &AffReader::read_textured_triangle_with_normals},
    {"tpa", &AffReader::read_animated_triangle},
    {"c", &AffReader::read_cone},
    {"s", &AffReader::read_sphere},
    {"fm", &AffReader::read_material},
    {"f", &AffReader::read_fill},
    {"xs", &AffReader::read_static_transform},
    {"x", &AffReader::read_animated_transform},
    {"k", &AffReader::read_keys},
    {"}", &AffReader::close_block},
    {"i", &AffReader::read_include},
    {"d", &AffReader::read_detail_level},
    {"v", &AffReader::read_view},
    {"l", &AffReader::read_light},
    {"la", &AffReader::read_animated_light},
    {"b", &AffReader::read_background},
    {"am", &AffReader::read_ambient},
    {"a", &AffReader::read_animation},
};

Scene AffReader::read(const std::filesystem::path& path) {
  scene_.ambient_light = glm::vec3(1.0f);  // until `am` says otherwise
  scene_.transfer = Transfer::display;     // the format and its scenes are of 1999 and before
  AffFile* top = nullptr;
  try {
    top = &files_.open_top(path);
  } catch (const AffFailure& failure) {
    throw AffFailure{fmt::format("{}: found {}, expected an AFF file.", path.string(), failure.message)};
  }
  scene_.name = top->name;
  images_.emplace(scene_, files_.root(), options_);
  read_file(*top);
  finish();
  if (options_.files_read != nullptr) files_.list(*options_.files_read);
  return std::move(scene_);
}

void AffReader::read_file(AffFile& file) {
  AffLexer in(file.text, file.name, faults_);
  file.open = true;
  open_files_.push_back(&file);
  const std::size_t outer_first_block = first_block_of_file_;
  first_block_of_file_ = blocks_.size();
  while (!in.peek().empty()) read_directive(in);
  if (blocks_.size() > first_block_of_file_) {
    in.fail("the end of the file", fmt::format("'}}' for the block opened at {}", blocks_.back().place));
  }
  first_block_of_file_ = outer_first_block;
  open_files_.pop_back();
  file.open = false;
  run_ = {};
}

void AffReader::read_directive(AffLexer& in) {
  const std::string_view keyword = in.word("a directive");
  for (const Directive& directive : directives) {
    if (directive.keyword != keyword) continue;
    if (run_.keyword != keyword) run_ = {directive.keyword};
    return (this->*directive.read)(in);
  }
  in.fail(quote_word(keyword),
          "a directive (a, am, b, c, d, f, fm, i, k, l, la, m, p, pp, s, tpa, tt, ttp, v, x, xs or '}')");
}

void AffReader::read_include(AffLexer& in) {
  const std::int64_t level = in.integer("the include's detail level");
  const std::string_view name = in.word("the name of the file to include");
  if (level > detail_level_) return;
  AffFile* file = nullptr;
  try {
    file = &files_.open_include(name, *open_files_.back());
  } catch (const AffFailure& failure) {
    in.fail(failure.message, "an AFF file beside this one");
  }
  if (file->open)
    in.fail(fmt::format("include of {}, which is being read", quote_word(name)), "no cycle of includes");
  if (open_files_.size() > deepest_include) {
    in.fail(fmt::format("includes {} deep", open_files_.size()), fmt::format("at most {}", deepest_include));
  }
  expanded_bytes_ += file->text.size();
  const std::uint64_t most = free_expanded_bytes + expanded_per_byte * files_.bytes_read();
  if (++includes_ > most_includes || expanded_bytes_ > most) {
    in.fail(fmt::format("{} includes of {} bytes in all", includes_, expanded_bytes_),
            fmt::format("at most {} of {} bytes", most_includes, most));
  }
  read_file(*file);
}

void AffReader::read_detail_level(AffLexer& in) {
  detail_level_ = in.integer("the detail level");
}
void AffReader::read_background(AffLexer& in) {
  scene_.background = read_color(in);
}
void AffReader::read_ambient(AffLexer& in) {
  scene_.ambient_light = read_color(in);
}

void AffReader::read_static_transform(AffLexer& in) {
  Node node;
  node.scale = in.vector("a scale");
  const glm::dvec3 axis = in.vector("a coordinate of the rotation's axis");
  const double angle = glm::radians(in.number("an angle in degrees"));
  node.translation = in.vector("a coordinate of the translation");
  const double length = glm::length(axis);
  if (length > 0.0 && std::isfinite(length)) node.rotation = glm::angleAxis(angle, axis / length);
  open_block(in, std::move(node));
}

void AffReader::read_animated_transform(AffLexer& in) {
  Node node;
  node.name = in.word("the name of the transform");
  const std::string name = node.name;
  open_block(in, std::move(node));
  animated_.push_back({.node = blocks_.back().node, .name = name});
}

void AffReader::read_keys(AffLexer& in) {
  const std::string name(in.word("the name of the key frames"));
  const std::string place = in.place();
  AffKeys keys = read_key_block(in);
  charge(in, memory_of(keys) + name.size());
  const auto [entry, is_new] = keys_.try_emplace(name);
  if (!is_new && !same_keys(entry->second, keys)) {
    scene_.warnings.push_back(
        fmt::format("{}: the key frames {} differ from those read before; the ones read last are used.",
                    place, quote_word(name)));
  }
  entry->second = std::move(keys);
}

void AffReader::open_block(AffLexer& in, Node node) {
  const std::string place = in.place();
  in.expect("{");
  if (blocks_.size() == deepest_block) {
    in.fail("a deeper block", fmt::format("transforms nested at most {} deep", deepest_block));
  }
  blocks_.push_back({add_node(in, std::move(node)), place});
}

void AffReader::close_block(AffLexer& in) {
  if (blocks_.size() == first_block_of_file_) in.fail("'}'", "a block of this file to close");
  blocks_.pop_back();
}

int AffReader::add_node(AffLexer& in, Node node) {
  charge(in, 2 * sizeof(Node) + node.name.size());
  node.parent = blocks_.empty() ? -1 : blocks_.back().node;
  scene_.nodes.push_back(std::move(node));
  return static_cast<int>(scene_.nodes.size()) - 1;
}

void AffReader::charge(AffLexer& in, std::size_t bytes) {
  scene_bytes_ += bytes;
  const std::uint64_t most = free_scene_bytes + scene_per_byte * files_.bytes_read();
  if (scene_bytes_ > most) {
    in.fail(fmt::format("a scene of more than {} MiB", most >> 20), "one in proportion to its files' size");
  }
}

}  // namespace tenebra::formats
