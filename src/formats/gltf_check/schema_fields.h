// The properties of glTF's JSON that Tenebra reads, as tables.
#pragma once

#include <cstddef>
#include <span>

namespace tenebra::formats::schema {

enum class Kind {
  string,
  boolean,
  number,
  integer,
  ref,
  refs,
  numbers,
  strings,
  object,
  objects,
  attributes,
  ids,  ///< an object of integers
  targets
};

struct Field {
  const char* name;
  Kind kind;
  bool required = false;
  const char* section = "";         ///< ref, refs: the root table referred to
  std::size_t length = 0;           ///< numbers: how many; 0: any, at least one
  std::span<const Field> fields{};  ///< object, objects
};

/// The fields of the file's root.
std::span<const Field> root_fields();

}  // namespace tenebra::formats::schema
