// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "artus/core/result.h"

namespace artus {

/// A linked shader program. Move-only, like all here: freed with its owner, while the context
/// lives.
class GlProgram {
 public:
  /// Errors: failed, with the driver's log.
  [[nodiscard]] static Result<GlProgram> make(const char* vertex, const char* fragment);
  ~GlProgram();
  GlProgram(GlProgram&& other) noexcept : id_(other.id_) { other.id_ = 0; }
  GlProgram& operator=(GlProgram&&) = delete;
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  void use() const;
  void set(const char* name, const Eigen::Matrix4f& value) const;
  void set(const char* name, const Eigen::Vector4f& value) const;
  void set(const char* name, int value) const;

 private:
  explicit GlProgram(unsigned id) : id_(id) {}
  unsigned id_;
};

/// Points and, optionally, triangles on the graphics side.
class GlMesh {
 public:
  GlMesh();
  ~GlMesh();
  GlMesh(GlMesh&& other) noexcept;
  GlMesh& operator=(GlMesh&&) = delete;
  GlMesh(const GlMesh&) = delete;
  GlMesh& operator=(const GlMesh&) = delete;

  void set_points(std::span<const Eigen::Vector3f> points);
  /// One a point, for shaders that ask for it.
  void set_normals(std::span<const Eigen::Vector3f> normals);
  /// Others in the place of some from `first` on. Requires: they are there.
  void move_points(std::size_t first, std::span<const Eigen::Vector3f> points);
  void set_triangles(std::span<const std::uint32_t> indices);
  void draw_triangles() const;
  [[nodiscard]] std::size_t n_triangles() const noexcept {
    return static_cast<std::size_t>(n_indices_) / 3;
  }
  void draw_line_strip() const;

 private:
  unsigned array_ = 0;
  unsigned points_ = 0;
  unsigned normals_ = 0;
  unsigned indices_ = 0;
  int n_points_ = 0;
  int n_indices_ = 0;
};

/// A two-dimensional texture, grey or coloured (8 bit), or the colour target of a frame buffer.
class GlTexture {
 public:
  GlTexture();
  ~GlTexture();
  GlTexture(const GlTexture&) = delete;
  GlTexture& operator=(const GlTexture&) = delete;
  void set_grey(int width, int height, std::span<const std::uint8_t> grey);
  /// (height, width, 3), red, green, blue.
  void set_colour(int width, int height, std::span<const std::uint8_t> rgb);
  void set_target(int width, int height);
  void bind() const;
  [[nodiscard]] unsigned id() const noexcept { return id_; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }

 private:
  unsigned id_ = 0;
  int width_ = 0;
  int height_ = 0;
};

/// A picture to draw into, shown in a panel afterwards.
class GlTarget {
 public:
  GlTarget();
  ~GlTarget();
  GlTarget(const GlTarget&) = delete;
  GlTarget& operator=(const GlTarget&) = delete;
  /// Makes the size fit and draws into it from now on.
  void begin(int width, int height);
  /// Draws into it again, upon what is there.
  void resume() const;
  /// Back to the window.
  void end() const;
  [[nodiscard]] unsigned texture() const noexcept { return colour_.id(); }

 private:
  GlTexture colour_;
  unsigned frame_ = 0;
  unsigned depth_ = 0;
};

}  // namespace artus
