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
  return base::fail(ErrorKind::device, "shader {}.{} does not compile: {}", program,
                    stage == GL_VERTEX_SHADER ? "vert" : "frag", one_line(std::move(log)));
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
  Program program(glCreateProgram());
  glAttachShader(program.name(), vertex_shader->name());
  glAttachShader(program.name(), fragment_shader->name());
  glLinkProgram(program.name());
  glDetachShader(program.name(), vertex_shader->name());
  glDetachShader(program.name(), fragment_shader->name());
  GLint linked = 0, length = 0;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
  if (linked) return program;
  glGetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetProgramInfoLog(program.name(), length, nullptr, log.data());
  return base::fail(ErrorKind::device, "shaders of {} do not link: {}", name, one_line(std::move(log)));
}

}  // namespace tenebra::gl
