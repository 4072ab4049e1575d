// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

namespace artus {

// Surfaces: one colour a side, cut off beyond a plane; pictures: a grey or coloured texture.
inline constexpr const char* kSolidVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 view; uniform mat4 model; uniform vec4 plane;
out vec3 place; out float ahead;
void main() {
  vec4 p = model * vec4(position, 1.0);
  place = p.xyz;
  ahead = dot(plane.xyz, p.xyz) - plane.w;
  gl_Position = view * p;
})";
inline constexpr const char* kSolidFragment = R"(#version 330 core
in vec3 place; in float ahead;
uniform vec4 colour; uniform vec4 behind; uniform vec4 eye; uniform int lit; uniform int lit_behind;
out vec4 result;
void main() {
  vec4 own = gl_FrontFacing ? colour : behind;
  if (ahead > 0.0 || own.a == 0.0) discard;
  float shade = 0.85;
  if ((gl_FrontFacing ? lit : lit_behind) == 1) {
    vec3 n = normalize(cross(dFdx(place), dFdy(place)));
    shade = 0.3 + 0.7 * abs(dot(n, normalize(eye.xyz - place)));
  }
  result = vec4(shade * own.rgb, own.a);
})";
inline constexpr const char* kPictureVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 view; uniform mat4 model;
out vec2 uv;
void main() { uv = position.xy; gl_Position = view * model * vec4(position, 1.0); })";
inline constexpr const char* kPictureFragment = R"(#version 330 core
in vec2 uv; uniform sampler2D image; out vec4 result;
void main() { result = vec4(texture(image, uv).rgb, 1.0); })";

// The person around the joint: smooth, open where the joint's own skin is and where something else
// of it stands before that, with its own limb when the joint is cut `opened`; `marked`: closed,
// with that place in another colour.
inline constexpr const char* kPersonVertex = R"(#version 330 core
layout(location = 0) in vec3 position; layout(location = 1) in vec3 normal;
uniform mat4 view;
out vec3 place; out vec3 out_of_skin;
void main() { place = position; out_of_skin = normal; gl_Position = view * vec4(position, 1.0); })";
inline constexpr const char* kPersonFragment = R"(#version 330 core
in vec3 place; in vec3 out_of_skin;
uniform vec4 colour; uniform vec4 eye; uniform vec4 hole; uniform vec4 half_extent; uniform int marked; uniform int opened;
out vec4 result;
void main() {
  vec3 local = place - hole.xyz;
  bool own = hole.w > 0.0 && (half_extent.w > 0.0 ? all(lessThan(abs(local), half_extent.xyz))
                                                  : length(local) < hole.w);
  vec3 way = place - eye.xyz;
  vec3 ray = normalize(way);
  float along = dot(hole.xyz - eye.xyz, ray);
  bool before = length(way) < along && length(hole.xyz - eye.xyz - along * ray) < hole.w &&
                length(local) > (opened == 1 ? 0.0 : 2.0) * hole.w;
  if (marked == 0 && (own || before)) discard;
  vec3 base = own ? vec3(1.0, 0.55, 0.1) : colour.rgb;
  float facing = abs(dot(normalize(out_of_skin), ray));
  float shade = gl_FrontFacing ? 0.3 + 0.7 * facing : 0.25;
  result = vec4(shade * base, 1.0);
})";

}  // namespace artus
