// Shaders from source, and what their compilers say.
#include <glad/gl.h>

#include <algorithm>

#include "gl/objects.h"

#include "base/fail.h"

namespace tenebra::gl {
namespace {

void delete_shader(unsigned name) {
  glDeleteShader(name);
}
using Shader = Object<delete_shader>;

/// The first line of a log without its end: messages are one sentence.
std::string one_line(std::string log) {
  while (!log.empty() && (log.back() == '\n' || log.back() == '\0')) log.pop_back();
  std::replace(log.begin(), log.end(), '\n', ' ');
  return log;
}

const char* suffix_of(GLenum stage) {
  return stage == GL_VERTEX_SHADER ? "vert" : stage == GL_FRAGMENT_SHADER ? "frag" : "comp";
}

Expected<Shader> compile(std::string_view program, GLenum stage, std::vector<std::string_view> pieces) {
  pieces.insert(pieces.begin(), "#version 450 core\n");
  std::vector<const GLchar*> texts;
  std::vector<GLint> lengths;
  for (std::string_view piece : pieces) {
    texts.push_back(piece.data());
    lengths.push_back(static_cast<GLint>(piece.size()));
  }
  Shader shader(glCreateShader(stage));
  glShaderSource(shader.name(), static_cast<GLsizei>(texts.size()), texts.data(), lengths.data());
  glCompileShader(shader.name());
  GLint compiled = 0, length = 0;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
  if (compiled) return shader;
  glGetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetShaderInfoLog(shader.name(), length, nullptr, log.data());
  return base::fail(ErrorKind::device, "shader {}.{} does not compile: {}", program, suffix_of(stage),
                    one_line(std::move(log)));
}

/// What is attached to `program` is let go of.
Expected<Program> link(std::string_view name, Program program, std::initializer_list<const Shader*> shaders) {
  for (const Shader* shader : shaders) glAttachShader(program.name(), shader->name());
  glLinkProgram(program.name());
  for (const Shader* shader : shaders) glDetachShader(program.name(), shader->name());
  GLint linked = 0, length = 0;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
  if (linked) return program;
  glGetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetProgramInfoLog(program.name(), length, nullptr, log.data());
  return base::fail(ErrorKind::device, "shaders of {} do not link: {}", name, one_line(std::move(log)));
}

}  // namespace

void delete_program(unsigned name) {
  glDeleteProgram(name);
}

Expected<Program> Program::build(std::string_view name, std::vector<std::string_view> vertex,
                                 std::vector<std::string_view> fragment) {
  auto vertex_shader = compile(name, GL_VERTEX_SHADER, std::move(vertex));
  if (!vertex_shader) return tl::unexpected(std::move(vertex_shader.error()));
  auto fragment_shader = compile(name, GL_FRAGMENT_SHADER, std::move(fragment));
  if (!fragment_shader) return tl::unexpected(std::move(fragment_shader.error()));
  return link(name, Program(glCreateProgram()), {&*vertex_shader, &*fragment_shader});
}

Expected<Program> Program::build_compute(std::string_view name, std::vector<std::string_view> pieces) {
  auto shader = compile(name, GL_COMPUTE_SHADER, std::move(pieces));
  if (!shader) return tl::unexpected(std::move(shader.error()));
  return link(name, Program(glCreateProgram()), {&*shader});
}

}  // namespace tenebra::gl
