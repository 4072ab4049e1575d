// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/joint3d/gl_objects.h"

#include <array>

#include <epoxy/gl.h>

namespace artus {
namespace {

Result<unsigned> compile(unsigned kind, const char* source) {
  const unsigned shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  int ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok != 0) return shader;
  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader, static_cast<int>(log.size()), nullptr, log.data());
  glDeleteShader(shader);
  return fail(ErrorCode::failed, std::string("a shader does not compile: ") + log.data());
}

}  // namespace

Result<GlProgram> GlProgram::make(const char* vertex, const char* fragment) {
  const auto v = compile(GL_VERTEX_SHADER, vertex);
  ARTUS_TRY(v);
  const auto f = compile(GL_FRAGMENT_SHADER, fragment);
  ARTUS_TRY(f);
  const unsigned id = glCreateProgram();
  glAttachShader(id, *v);
  glAttachShader(id, *f);
  glLinkProgram(id);
  glDeleteShader(*v);
  glDeleteShader(*f);
  int ok = 0;
  glGetProgramiv(id, GL_LINK_STATUS, &ok);
  if (ok == 0) return fail(ErrorCode::failed, "the shaders do not link");
  return GlProgram(id);
}

GlProgram::~GlProgram() {
  if (id_ != 0) glDeleteProgram(id_);
}

void GlProgram::use() const {
  glUseProgram(id_);
}

void GlProgram::set(const char* name, const Eigen::Matrix4f& value) const {
  glUniformMatrix4fv(glGetUniformLocation(id_, name), 1, GL_FALSE, value.data());
}

void GlProgram::set(const char* name, const Eigen::Vector4f& value) const {
  glUniform4fv(glGetUniformLocation(id_, name), 1, value.data());
}

void GlProgram::set(const char* name, int value) const {
  glUniform1i(glGetUniformLocation(id_, name), value);
}

GlMesh::GlMesh() {
  glGenVertexArrays(1, &array_);
  glGenBuffers(1, &points_);
  glGenBuffers(1, &indices_);
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, points_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
}

GlMesh::~GlMesh() {
  if (array_ == 0) return;
  glDeleteVertexArrays(1, &array_);
  glDeleteBuffers(1, &points_);
  if (normals_ != 0) glDeleteBuffers(1, &normals_);
  glDeleteBuffers(1, &indices_);
}

GlMesh::GlMesh(GlMesh&& other) noexcept
    : array_(other.array_),
      points_(other.points_),
      normals_(other.normals_),
      indices_(other.indices_),
      n_points_(other.n_points_),
      n_indices_(other.n_indices_) {
  other.array_ = 0;
}

void GlMesh::set_points(std::span<const Eigen::Vector3f> points) {
  glBindBuffer(GL_ARRAY_BUFFER, points_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(points.size_bytes()), points.data(),
               GL_DYNAMIC_DRAW);
  n_points_ = static_cast<int>(points.size());
}

void GlMesh::set_normals(std::span<const Eigen::Vector3f> normals) {
  glBindVertexArray(array_);
  if (normals_ == 0) glGenBuffers(1, &normals_);
  glBindBuffer(GL_ARRAY_BUFFER, normals_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(normals.size_bytes()), normals.data(),
               GL_STATIC_DRAW);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void GlMesh::move_points(std::size_t first, std::span<const Eigen::Vector3f> points) {
  glBindBuffer(GL_ARRAY_BUFFER, points_);
  glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(first * sizeof(Eigen::Vector3f)),
                  static_cast<GLsizeiptr>(points.size_bytes()), points.data());
}

void GlMesh::set_triangles(std::span<const std::uint32_t> indices) {
  glBindVertexArray(array_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size_bytes()),
               indices.data(), GL_STATIC_DRAW);
  n_indices_ = static_cast<int>(indices.size());
}

void GlMesh::draw_triangles() const {
  glBindVertexArray(array_);
  glDrawElements(GL_TRIANGLES, n_indices_, GL_UNSIGNED_INT, nullptr);
}

void GlMesh::draw_line_strip() const {
  glBindVertexArray(array_);
  glDrawArrays(GL_LINE_STRIP, 0, n_points_);
}

GlTexture::GlTexture() {
  glGenTextures(1, &id_);
}
GlTexture::~GlTexture() {
  glDeleteTextures(1, &id_);
}

void GlTexture::bind() const {
  glBindTexture(GL_TEXTURE_2D, id_);
}

namespace {
void set_sampling() {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}
}  // namespace

void GlTexture::set_colour(int width, int height, std::span<const std::uint8_t> rgb) {
  bind();
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
  const std::array<int, 4> swizzle{GL_RED, GL_GREEN, GL_BLUE, GL_ONE};
  glTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, swizzle.data());
  set_sampling();
  width_ = width;
  height_ = height;
}

void GlTexture::set_grey(int width, int height, std::span<const std::uint8_t> grey) {
  bind();
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, grey.data());
  const std::array<int, 4> swizzle{GL_RED, GL_RED, GL_RED, GL_ONE};
  glTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, swizzle.data());
  set_sampling();
  width_ = width;
  height_ = height;
}

void GlTexture::set_target(int width, int height) {
  bind();
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE, nullptr);
  set_sampling();
  width_ = width;
  height_ = height;
}

GlTarget::GlTarget() {
  glGenFramebuffers(1, &frame_);
  glGenRenderbuffers(1, &depth_);
}

GlTarget::~GlTarget() {
  glDeleteFramebuffers(1, &frame_);
  glDeleteRenderbuffers(1, &depth_);
}

void GlTarget::begin(int width, int height) {
  if (width != colour_.width() || height != colour_.height()) {
    colour_.set_target(width, height);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.id(), 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  }
  resume();
}

void GlTarget::resume() const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, colour_.width(), colour_.height());
}

void GlTarget::end() const {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace artus
