// A renderer that is not Tenebra's: a window of GLFW's, its own shaders, its own matrices. It draws the
// objects of FOLDER/scene.bin one by one, writes gl_PrimitiveID plus the number of the object's first
// triangle and its own depth, hands both textures over and writes the masks of a point light to FOLDER. Of
// Tenebra it sees the public headers alone. usage: foreign_renderer FOLDER
#define GL_GLEXT_PROTOTYPES
#define GLFW_INCLUDE_GLCOREARB
#include <GLFW/glfw3.h>
#include <tenebra/host_frame.h>
#include <tenebra/queries.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <glm/gtc/type_ptr.hpp>
#include <string>
#include <vector>

namespace {

constexpr int no_window = 77;  // tests skip then

[[noreturn]] void stop(const std::string& why, int code = 1) {
  std::fprintf(stderr, "foreign_renderer: %s\n", why.c_str());
  std::exit(code);
}

template <class T>
T value_of(tenebra::Expected<T> result) {
  if (!result) stop(result.error().message);
  return std::move(*result);
}
void check(const tenebra::Expected<void>& result) {
  if (!result) stop(result.error().message);
}

struct Scene {
  std::uint32_t width = 0, height = 0;
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint8_t> casts_shadow;
  std::vector<std::uint32_t> objects;  // the first triangle of each
  tenebra::HostCamera camera;
  glm::vec3 light{0.0f};
};

template <class T>
void read_list(std::istream& in, std::vector<T>& list) {
  std::uint32_t count = 0;
  in.read(reinterpret_cast<char*>(&count), sizeof(count));
  list.resize(count);
  in.read(reinterpret_cast<char*>(list.data()), static_cast<std::streamsize>(count * sizeof(T)));
}

Scene read_scene(const std::string& name) {
  std::ifstream in(name, std::ios::binary);
  Scene scene;
  in.read(reinterpret_cast<char*>(&scene.width), sizeof(scene.width));
  in.read(reinterpret_cast<char*>(&scene.height), sizeof(scene.height));
  read_list(in, scene.positions);
  read_list(in, scene.triangles);
  read_list(in, scene.casts_shadow);
  read_list(in, scene.objects);
  in.read(reinterpret_cast<char*>(&scene.camera.view_from_world), sizeof(glm::dmat4));
  in.read(reinterpret_cast<char*>(&scene.camera.clip_from_view), sizeof(glm::dmat4));
  in.read(reinterpret_cast<char*>(&scene.light), sizeof(scene.light));
  if (!in) stop(name + ": found no whole scene");
  return scene;
}

template <class T>
void write_list(const std::string& name, const std::vector<T>& list) {
  std::ofstream(name, std::ios::binary)
      .write(reinterpret_cast<const char*>(list.data()),
             static_cast<std::streamsize>(list.size() * sizeof(T)));
}

constexpr const char* vertex_shader = R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 0) uniform mat4 clip_from_world;
void main() { gl_Position = clip_from_world * vec4(position, 1.0); })";

constexpr const char* fragment_shader = R"(#version 450 core
layout(location = 1) uniform uint first_triangle;
layout(location = 0) out uint id;
void main() { id = first_triangle + uint(gl_PrimitiveID) + 1u; })";

GLuint shader_of(GLenum kind, const char* text) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (!compiled) stop("a shader does not compile");
  return shader;
}

GLuint program_of() {
  const GLuint program = glCreateProgram();
  glAttachShader(program, shader_of(GL_VERTEX_SHADER, vertex_shader));
  glAttachShader(program, shader_of(GL_FRAGMENT_SHADER, fragment_shader));
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) stop("the shaders do not link");
  return program;
}

GLuint texture_of(GLenum format, const Scene& scene) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, format, static_cast<GLsizei>(scene.width),
                 static_cast<GLsizei>(scene.height));
  return texture;
}

void upload(const Scene& scene) {
  GLuint names[3];
  glGenVertexArrays(1, names);
  glGenBuffers(2, names + 1);
  glBindVertexArray(names[0]);
  glBindBuffer(GL_ARRAY_BUFFER, names[1]);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(scene.positions.size() * sizeof(glm::vec3)),
               scene.positions.data(), GL_STATIC_DRAW);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(0);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, names[2]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(scene.triangles.size() * sizeof(glm::uvec3)),
               scene.triangles.data(), GL_STATIC_DRAW);
}

/// One call for each object: gl_PrimitiveID counts from 0 in each.
tenebra::HostTextures draw(const Scene& scene) {
  const tenebra::HostTextures textures{texture_of(GL_R32UI, scene), texture_of(GL_DEPTH_COMPONENT24, scene)};
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, textures.ids, 0);
  glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, textures.depth, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    stop("the framebuffer is not whole");
  glViewport(0, 0, static_cast<GLsizei>(scene.width), static_cast<GLsizei>(scene.height));
  const GLuint background[4] = {0, 0, 0, 0};
  glClearBufferuiv(GL_COLOR, 0, background);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glUseProgram(program_of());
  const glm::mat4 clip_from_world(scene.camera.clip_from_view * scene.camera.view_from_world);
  glUniformMatrix4fv(0, 1, GL_FALSE, glm::value_ptr(clip_from_world));
  upload(scene);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const std::size_t first = scene.objects[i],
                      end = i + 1 < scene.objects.size() ? scene.objects[i + 1] : scene.triangles.size();
    glUniform1ui(1, static_cast<GLuint>(first));
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * (end - first)), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(first * sizeof(glm::uvec3)));
  }
  return textures;
}

/// What Tenebra says of the points that the ids name.
tenebra::ShadowMask mask_of_ids(const Scene& scene, const tenebra::HostFrame& frame) {
  const tenebra::ViewRays view = value_of(tenebra::host_view(scene.camera, frame.width, frame.height));
  const tenebra::TriangleView triangles{
      .positions = scene.positions, .triangles = scene.triangles, .casts_shadow = scene.casts_shadow};
  tenebra::VisiblePoints points;
  tenebra::compute_visible_points(frame.ids, frame.width, frame.height, view, triangles, points);
  tenebra::ShadowTracer tracer;
  tenebra::ShadowMask mask;
  tracer.trace_shadow_mask(points, triangles, {.position = scene.light}, {}, mask);
  return mask;
}

/// The same without ids: of the points that depths alone lead to, moved by `bias_m` towards the light.
tenebra::ShadowMask mask_of_depth(const Scene& scene, const tenebra::HostFrame& frame, double bias_m) {
  std::vector<glm::dvec3> positions, seen;
  check(tenebra::positions_from_depth(frame, scene.camera, 1.0, positions));
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (std::isnan(positions[i].x)) continue;
    pixels.push_back(i);
    seen.push_back(positions[i] + bias_m * glm::normalize(glm::dvec3(scene.light) - positions[i]));
  }
  const auto geometry =
      value_of(tenebra::Geometry::create(scene.positions, scene.triangles, scene.casts_shadow));
  tenebra::PointTracer tracer;
  tenebra::ShadowMask lit(seen.size()), mask(positions.size());
  check(tracer.hard_mask(geometry, {.positions = seen}, {.position = scene.light}, {}, lit));
  for (std::size_t i = 0; i < pixels.size(); ++i) mask[pixels[i]] = lit[i];
  return mask;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) stop("expected one folder");
  const std::string folder = arguments[1];
  const Scene scene = read_scene(folder + "/scene.bin");
  if (!glfwInit()) stop("GLFW finds no display", no_window);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  GLFWwindow* const window = glfwCreateWindow(64, 64, "foreign renderer", nullptr, nullptr);
  if (!window) stop("GLFW makes no window with OpenGL 4.5", no_window);
  glfwMakeContextCurrent(window);

  const tenebra::HostTextures textures = draw(scene);
  const auto host = value_of(tenebra::HostContext::adopt(glfwGetProcAddress));
  tenebra::HostFrame frame;
  check(host.read(textures, {.first_id = 1}, frame));
  write_list(folder + "/ids.bin", frame.ids);
  write_list(folder + "/mask.bin", mask_of_ids(scene, frame));
  for (const double bias_m : {0.0, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3})
    write_list(folder + "/depth_mask_" + std::to_string(std::lround(1000 * bias_m)) + ".bin",
               mask_of_depth(scene, frame, bias_m));
  if (glGetError() != GL_NO_ERROR) stop("OpenGL has an error");
  glfwTerminate();
}
